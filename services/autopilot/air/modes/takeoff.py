"""Take-off: from the wheels along the strip, or thrown by hand or catapult; then straight ahead up to a height."""

import math
from enum import Enum, auto

from services.autopilot.air.setpoints import FlightContext, FlightPhase, PathSetpoint, Setpoint
from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.control.cycle import clip
from uvf.control.ground_roll import Gyros, held, rolling, rudder_along
from uvf.control.total_energy import climb_at
from uvf.estimation.state import Estimate
from uvf.guidance.vector_field import Point, from_line, line_reference
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

ROTATION = 0.9  # of min_airspeed
OPENING = {"nose_wheel": 1.0, "tail_wheel": 2.5, "belly": 1.0}  # s, in which the throttle opens; slowly while only a tail wheel steers
LIFTED = 1.5  # m
STRAIGHT = 8.0  # m; below it the wings stay nearly level
LOW_BANK, BACK_PER_M, MOST_BACK = 0.15, 0.03, 0.3  # rad; rad of course per m aside, rad
BANKED = 0.4  # rad, most bank above that
LONGEST = 30.0  # s, of the roll
SLUGGISH = 4.0, 3.0  # s, m/s over ground: slower than that after so long it is not going to fly
OFF_LINE, OFF_COURSE = 8.0, 0.6  # m, rad
BRAKE = 0.6
STOPPED = 0.7  # m/s
THROWN = 0.1  # s, that a push lasts at least
READY = Surfaces(0.0, 0.0, 0.0, 0.0)


class TakeoffStage(Enum):
    """Stages of a take-off, in the order in which they are flown."""

    READY = auto()
    ROLL = auto()
    CLIMB = auto()
    REJECTED = auto()


class TakeoffMode(FlightPhase):
    """In the direction in which the aircraft stands. ``room`` [m]: how far it may roll, half of it before it has the speed to fly."""

    def __init__(self, now: Estimate, height: float, context: FlightContext, room: float = math.inf) -> None:
        """height: m, world, at which it is done."""
        self.height = height
        self._senses, self._room = context, room
        self._ground = now.height
        self._course = now.yaw if not context.airborne else now.course
        self._origin: Point = (now.north, now.east)
        self._gyros = Gyros(now)
        self._stage = TakeoffStage.CLIMB if context.airborne else TakeoffStage.READY
        self._since = 0.0
        self._pushed = 0.0
        self._why = ""

    def is_low(self, now: Estimate) -> bool:
        """On its wheels, or so low that the wings have to stay level: no other mode can follow."""
        return self._stage is not TakeoffStage.CLIMB or self._rise(now) < STRAIGHT

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: roll or throw, rotation, climb straight ahead."""
        self._since += dt
        level = self._gyros.step(now, dt)
        if self._stage is TakeoffStage.READY:
            return self._ready(now, params, dt)
        if self._stage is TakeoffStage.ROLL:
            return self._roll(now, level, params)
        return self._reject(now, level, params) if self._stage is TakeoffStage.REJECTED else self._climb(now, level, params)

    def _to(self, stage: TakeoffStage) -> None:
        self._stage, self._since = stage, 0.0

    def _ready(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Armed: it rolls, or waits with the motor off for the push of a catapult or an arm."""
        self._course, self._origin = now.yaw, (now.north, now.east)
        self._ground, self._gyros = now.height, Gyros(now)
        if params.launch_push == 0:
            self._to(TakeoffStage.ROLL)
            return Setpoint(READY)
        self._pushed = self._pushed + dt if self._senses.specific_force_x > params.launch_push else 0.0
        if self._pushed >= THROWN:
            self._to(TakeoffStage.CLIMB)
        return Setpoint(READY)

    def _roll(self, now: Estimate, level: Estimate, params: AirParams) -> Setpoint:
        right = self._right(now)
        self._why = self._fault(level, params, right)
        if self._why:
            self._to(TakeoffStage.REJECTED)
        if self._rise(now) > LIFTED:
            self._to(TakeoffStage.CLIMB)
            return self._climb(now, level, params)
        rudder, throttle = rudder_along(level, self._course, right), params.takeoff_throttle * min(self._since / OPENING[params.gear], 1.0)
        if now.airspeed > ROTATION * params.min_airspeed:
            return Setpoint(held(now, level, AttitudeSetpoint(0.0, params.takeoff_pitch, throttle, rudder)))
        return Setpoint(rolling(level, params, rudder, throttle))

    def _fault(self, now: Estimate, params: AirParams, right: float) -> str:
        """Why this is no take-off; empty while it is one. Once it could fly, it does."""
        if now.airspeed > params.min_airspeed:
            return ""
        run = math.hypot(now.north - self._origin[0], now.east - self._origin[1])
        if (self._since > SLUGGISH[0] and now.ground_speed < SLUGGISH[1]) or self._since > LONGEST:
            return "it does not accelerate"
        if abs(right) > OFF_LINE or abs(math.remainder(now.yaw - self._course, math.tau)) > OFF_COURSE:
            return "it left the line of the strip"
        return "too slow after half of the strip" if run > self._room / 2 else ""

    def _reject(self, now: Estimate, level: Estimate, params: AirParams) -> Setpoint:
        if now.ground_speed < STOPPED:
            self.ended, self.disarms = f"take-off rejected: {self._why}", True
        right = self._right(now)
        return Setpoint(rolling(level, params, rudder_along(level, self._course, right), 0.0, BRAKE))

    def _climb(self, now: Estimate, level: Estimate, params: AirParams) -> Setpoint:
        if now.height >= self.height:
            self.ended = "take-off complete"
        if self._rise(now) < STRAIGHT or now.airspeed < ROTATION * params.min_airspeed:
            spare = (now.airspeed - params.min_airspeed) / params.min_airspeed
            pitch = params.takeoff_pitch * min(max(0.75 + 2.5 * spare, 0.3), 1.0)
            return Setpoint(held(now, level, AttitudeSetpoint(self._straight(now, params), pitch, params.takeoff_throttle)))
        aim = line_reference(self._along, self._origin, (now.north, now.east), params)
        climb, throttle = climb_at(now, params), params.takeoff_throttle
        return Setpoint(PathSetpoint(aim, None, climb, params.trim_airspeed, bank_limit=BANKED, throttle=throttle))

    def _straight(self, now: Estimate, params: AirParams) -> float:
        """Bank [rad], a small one, that keeps it over the line of the take-off."""
        back = clip(BACK_PER_M * self._right(now), MOST_BACK)
        off = math.remainder(self._course - back - now.course, math.tau)
        return clip(params.course_p * now.ground_speed / GRAVITY * off, LOW_BANK)

    @property
    def _along(self) -> Point:
        """Unit vector, north and east."""
        return math.cos(self._course), math.sin(self._course)

    def _right(self, now: Estimate) -> float:
        """m to the right of the line of the take-off."""
        return from_line(self._along, self._origin, (now.north, now.east))[1]

    def _rise(self, now: Estimate) -> float:
        """m above where it stood."""
        return now.height - self._ground if self._senses.clearance is None else self._senses.clearance
