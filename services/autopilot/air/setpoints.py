"""What a mode asks for in a cycle, at one of three levels of control, and what it knows beside the estimate."""

import math
from dataclasses import dataclass

from schemas.messages import FlightSetpoint
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.servos import SERVOS, Servos
from uvf.estimation.state import Estimate
from uvf.guidance.route import AltitudeProfile
from uvf.guidance.vector_field import PathReference
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

STICK_RELEASED = Surfaces(0.0, 0.0, 0.0, 0.0, brake=1.0)
"""On the ground, when nobody holds the stick: motor off, brakes on."""


@dataclass(frozen=True, slots=True)
class StickDeflections:
    """-1..1: right, nose up, right; throttle 0..1."""

    roll: float
    pitch: float
    yaw: float
    throttle: float


@dataclass(frozen=True, slots=True)
class ManualCommand:
    """What a source asks for."""

    source: str
    surfaces: Surfaces

    def sticks(self, servos: Servos) -> StickDeflections:
        """Where the sticks are that ask for these surfaces."""
        s = self.surfaces
        roll, pitch, yaw = servos.aileron.share(s.aileron), servos.elevator.share(s.elevator), servos.rudder.share(s.rudder)
        return StickDeflections(roll, -pitch, -yaw, s.throttle)


@dataclass(frozen=True, slots=True)
class PathSetpoint:
    """To follow a path over ground."""

    aim: PathReference
    height: float | None  # m; None: the climb rate is held instead
    climb: float  # m/s, of the path
    airspeed: float  # m/s
    bank_limit: float | None = None  # rad; None: the vehicle's
    throttle: float | None = None  # 0..1; None: by the airspeed
    rudder: float | None = None  # rad, beside the yaw damper; None: the side slip is taken out
    lowest_pitch: float = -math.inf  # rad


@dataclass(frozen=True, slots=True)
class Setpoint:
    """``asked``: a path, a bank with height and airspeed, an attitude, or the surfaces themselves."""

    asked: PathSetpoint | AltitudeAirspeedSetpoint | AttitudeSetpoint | Surfaces
    flap: float = 0.0  # rad
    brake: float = 0.0  # 0..1
    lift: float = 0.0  # m/s^2, made at once by the flaps, beside what pitch makes
    firm: bool = False
    """Climb and pitch are held more firmly than is good for comfort: near the ground."""


@dataclass(frozen=True, slots=True)
class ControlOutput:
    """What a cycle came to."""

    surfaces: Surfaces
    aim: PathReference
    level: AltitudeProfile
    attitude: AttitudeSetpoint | None = None
    """That is held; None while the surfaces are moved by hand."""
    airspeed: float | None = None
    """m/s, that is held."""


@dataclass(slots=True)
class FlightContext:
    """What modes know beside the estimate, renewed before each step."""

    airborne: bool = True
    armed: bool = True
    hand: ManualCommand | None = None
    """What is asked by hand; None = nothing fresh."""
    servos: Servos = SERVOS
    clearance: float | None = None
    """m, of the wheels over the ground, seen by a range finder."""
    specific_force_x: float = 0.0
    """m/s^2, specific force forwards."""
    specific_force_up: float = GRAVITY
    """m/s^2, specific force upwards."""
    must_land: bool = False
    """A failsafe has ordered it down, whatever the wind."""
    setpoint: FlightSetpoint | None = None
    """What mode Offboard is asked for; None = nothing fresh."""
    setpoint_from: str = ""
    """Whose setpoint that is."""
    setpoints_wait: tuple[str, ...] = ()
    """Who else sends some, which are not followed."""

    def update(self, other: "FlightContext") -> None:
        """Whoever holds this one sees what is known now."""
        for name in self.__slots__:
            setattr(self, name, getattr(other, name))


class FlightPhase:
    """One mode, or one part of it."""

    ended = ""
    """Why it has come to its end; empty while it goes on."""
    disarms = False
    """At its end the motor has nothing more to do."""

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """One cycle of ``dt`` [s]."""
        raise NotImplementedError
