"""Down without a position: what mode Land is when it is ordered and nobody knows where the aircraft is.

As PX4's Descend: it comes down where it is. Round the circle where it reckons to be; from ``TURNS_BELOW`` over the ground into the wind
with the wings level, slow; by the range finder a flare. Without one it sinks gently at last, until it sinks no more although it should.
"""

import math
from enum import Enum, auto

from services.autopilot.air.setpoints import FlightContext, FlightPhase, PathSetpoint, Setpoint
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.cycle import clip
from uvf.control.ground_roll import Gyros, rolling, rudder_along
from uvf.estimation.state import Estimate
from uvf.guidance.route import Circle
from uvf.models.vehicle.flight_params import AirParams

SINK, SLOWER, GENTLY = 2.0, 1.5, 0.7  # m/s: round the circle, into the wind, feeling for the ground
TURNS_BELOW, FEELS_BELOW, FLARES_BELOW = 35.0, 12.0, 6.0  # m over the ground
TURN, LEVEL, LEVEL_BELOW = 0.4, 0.1, 10.0  # rad of bank; m
NO_WIND = 2.0  # m/s: it goes on in the direction it has
TOUCHED, TOUCH_TIME = 0.12, 0.1  # m by the range finder, s
STUCK, STUCK_TIME = 0.4, 0.8  # m/s less sink than asked for, s
BRAKES_AFTER, BRAKE = 0.8, 0.6  # s
STANDS, LONGEST = 1.5, 20.0  # s at rest, s of rolling


class DescendStage(Enum):
    """Stages of coming down without a position."""

    CIRCLE = auto()
    UPWIND = auto()
    ROLL = auto()


class DescendMode(FlightPhase):
    """By attitude, airspeed, pressure and compass; the place counts only as far as it is reckoned."""

    def __init__(self, circle: Circle, ground: float, context: FlightContext) -> None:
        """ground: m, world, supposed while no range finder sees it."""
        self.circle = circle
        self._ground, self._senses = ground, context
        self._stage = DescendStage.CIRCLE
        self._heading = 0.0
        self._gyros: Gyros | None = None
        self._felt = self._since = 0.0  # s

    @property
    def rolls(self) -> bool:
        """The wheels carry it: nothing but the end can follow."""
        return self._stage is DescendStage.ROLL

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: down on a circle, the last part into the wind, then rolling out."""
        self._since += dt
        if self._stage is DescendStage.ROLL:
            return self._roll(now, params, dt)
        height = self._height(now, params)
        if self._stage is DescendStage.CIRCLE and height < TURNS_BELOW:
            self._stage, self._heading = DescendStage.UPWIND, upwind(now)
        if self._stage is DescendStage.CIRCLE:
            return Setpoint(PathSetpoint(self.circle.aim(now, params), None, -SINK, params.trim_airspeed))
        return self._upwind(now, params, height, dt)

    def _height(self, now: Estimate, params: AirParams) -> float:
        """m, of the wheels over the ground."""
        seen = self._senses.clearance
        return seen if seen is not None else now.height - params.gear_height - self._ground

    def _upwind(self, now: Estimate, params: AirParams, height: float, dt: float) -> Setpoint:
        sink = self._sink(height)
        if self._has_touched(now, height, sink, dt):
            self._stage, self._since, self._felt, self._gyros = DescendStage.ROLL, 0.0, 0.0, Gyros(now)
        off = math.remainder(self._heading - now.yaw, math.tau)
        bank = clip(off, LEVEL if height < LEVEL_BELOW else TURN)
        throttle = 0.0 if self._senses.clearance is not None and height < 0.5 else None
        return Setpoint(AltitudeAirspeedSetpoint(bank, None, -sink, params.min_airspeed, throttle), params.land_flap, firm=True)

    def _sink(self, height: float) -> float:
        """m/s."""
        if self._senses.clearance is None:
            return GENTLY if height < FEELS_BELOW else SLOWER
        return SLOWER if height > FLARES_BELOW else 0.3 + (SLOWER - 0.3) * max(height, 0.0) / FLARES_BELOW

    def _has_touched(self, now: Estimate, height: float, sink: float, dt: float) -> bool:
        seen = self._senses.clearance is not None
        near, limit = (height < TOUCHED, TOUCH_TIME) if seen else (height < FEELS_BELOW and now.climb > STUCK - sink, STUCK_TIME)
        self._felt = self._felt + dt if near else 0.0
        return self._felt > limit

    def _roll(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Straight on with brakes; the speed over ground is only reckoned, so at last it is taken to stand."""
        assert self._gyros is not None
        level = self._gyros.step(now, dt)
        self._felt = self._felt + dt if not self._senses.airborne else 0.0
        if self._felt > STANDS or self._since > LONGEST:
            self.ended, self.disarms = "down", True
        return Setpoint(rolling(level, params, rudder_along(level, self._heading, 0.0), 0.0, BRAKE if self._since > BRAKES_AFTER else 0.0))


def upwind(now: Estimate) -> float:
    """rad from north: where the wind comes from; in next to none, the heading of now."""
    if math.hypot(now.wind_north, now.wind_east) < NO_WIND:
        return now.yaw
    return math.atan2(-now.wind_east, -now.wind_north)
