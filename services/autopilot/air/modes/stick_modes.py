"""Modes flown by hand: the stick as surfaces, as an attitude, as bank and climb, or those with a line over ground."""

import math
from collections.abc import Mapping

from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.setpoints import STICK_RELEASED, FlightContext, FlightPhase, PathSetpoint, Setpoint, StickDeflections
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle
from uvf.estimation.state import Estimate
from uvf.guidance.vector_field import Point, line_reference
from uvf.models.vehicle.flight_params import AirParams

CENTRED = 0.05  # of a stick's way
STEEPEST = 0.35  # rad, pitch beside that of level flight with the stick at its stop
WINGS_LEVEL = 0.1  # rad: from here on a line is held over ground


class StickMode(FlightPhase):
    """``step`` is called while a hand is on the stick."""

    def __init__(self, context: FlightContext) -> None:
        self._senses = context

    @property
    def _surfaces(self) -> Surfaces:
        return self._senses.hand.surfaces if self._senses.hand is not None else STICK_RELEASED

    @property
    def _sticks(self) -> StickDeflections:
        hand = self._senses.hand
        return hand.sticks(self._senses.servos) if hand is not None else StickDeflections(0.0, 0.0, 0.0, 0.0)


class ManualMode(StickMode):
    """The surfaces as the hand asks."""

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """The sticks' surfaces [rad; throttle 0 to 1] as they are, in this cycle of ``dt`` [s]."""
        return Setpoint(self._surfaces)


class StabilizedMode(StickMode):
    """Stick to bank and pitch; throttle, rudder, flap and brake as the hand asks. The pedals centred, the side slip is taken out."""

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Roll and pitch [rad] by the sticks, in this cycle of ``dt`` [s]."""
        sticks, surfaces = self._sticks, self._surfaces
        level = Cycle(now, params, dt).alpha
        rudder = surfaces.rudder if abs(sticks.yaw) > CENTRED or not self._senses.airborne else None
        asked = AttitudeSetpoint(sticks.roll * params.turn_bank, level + sticks.pitch * STEEPEST, sticks.throttle, rudder)
        return Setpoint(asked, surfaces.flap, surfaces.brake)


class AltitudeMode(StickMode):
    """Stick to bank and climb rate, centred to the height of then; throttle from the lowest airspeed to the highest."""

    def __init__(self, context: FlightContext) -> None:
        super().__init__(context)
        self._height: float | None = None

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Roll [rad] and climb [m/s] by the sticks; without climb the height is held, in this cycle of ``dt`` [s]."""
        height, climb = self._vertical(now, params)
        return Setpoint(
            AltitudeAirspeedSetpoint(self._sticks.roll * params.turn_bank, height, climb, self._airspeed(params)), self._surfaces.flap
        )

    def _vertical(self, now: Estimate, params: AirParams) -> tuple[float | None, float]:
        pitch = self._sticks.pitch
        if abs(pitch) > CENTRED:
            self._height = None
            return None, pitch * (params.climb_max if pitch > 0 else params.sink_max)
        if self._height is None:
            self._height = now.height
        return self._height, 0.0

    def _airspeed(self, params: AirParams) -> float:
        return params.min_airspeed + self._sticks.throttle * (params.max_airspeed - params.min_airspeed)


class PositionMode(AltitudeMode):
    """As Altitude; with the stick centred it holds the line over ground that it flies along once its wings are level."""

    def __init__(self, context: FlightContext) -> None:
        super().__init__(context)
        self._line: tuple[Point, Point] | None = None

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """As in Altitude; with the stick in the middle a straight line over ground is held, in this cycle of ``dt`` [s]."""
        if abs(self._sticks.roll) > CENTRED:
            self._line = None
        elif self._line is None and abs(now.roll) < WINGS_LEVEL:
            self._line = ((math.cos(now.course), math.sin(now.course)), (now.north, now.east))
        if self._line is None:
            return super().step(now, params, dt)
        height, climb = self._vertical(now, params)
        aim = line_reference(*self._line, (now.north, now.east), params)
        return Setpoint(PathSetpoint(aim, height, climb, self._airspeed(params)), self._surfaces.flap)


STICK_MODES: Mapping[FlightMode, type[StickMode]] = {
    FlightMode.MANUAL: ManualMode,
    FlightMode.STABILIZED: StabilizedMode,
    FlightMode.ALTITUDE: AltitudeMode,
    FlightMode.POSITION: PositionMode,
}
