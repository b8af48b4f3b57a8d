"""What the levels of control ask of each other, from guidance down to the servos."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AltitudeAirspeedSetpoint:
    """What guidance asks of the outer loops: bank, height or climb rate, and airspeed."""

    bank: float  # rad
    height: float | None  # m; None: the climb rate is held instead
    climb: float  # m/s, of the path
    airspeed: float  # m/s
    throttle: float | None = None  # 0..1; None: by the airspeed
    rudder: float | None = None  # rad, beside the yaw damper; None: the side slip is taken out
    lowest_pitch: float = -math.inf  # rad; the nose goes no lower, whatever the climb rate


@dataclass(frozen=True, slots=True)
class AttitudeSetpoint:
    """What the attitude loops are asked for; the throttle is passed on."""

    bank: float  # rad
    pitch: float  # rad
    throttle: float  # 0..1
    rudder: float | None = None  # rad, beside the yaw damper; None: the side slip is taken out
    lacking: float = 0.0  # m/s of climb; the bank leaves lift to win it back


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Surface deflections and flap [rad] with the signs of SurfaceCommand; throttle and brake 0..1, brake_difference -1..1."""

    aileron: float
    elevator: float
    rudder: float
    throttle: float
    flap: float = 0.0
    brake: float = 0.0
    brake_difference: float = 0.0
