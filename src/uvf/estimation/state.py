"""What the estimator hands to guidance and control. NED and FRD."""

from dataclasses import dataclass, field

from uvf.maths.geodesy import GRAVITY


@dataclass(frozen=True, slots=True)
class Ratios:
    """Test ratio [-] of the newest measurement of each kind, as ECL's ``estimator_innovations`` has them.

    The normalised innovation squared over the square of its gate: below 1 it was used, above it was refused; 0 until there is one.
    """

    position: float = 0.0  # satellites, horizontal
    velocity: float = 0.0  # satellites
    height: float = 0.0  # satellites or barometer, the worse
    airspeed: float = 0.0
    slip: float = 0.0  # sideslip, which is supposed to be nil
    field: float = 0.0  # magnetometer


@dataclass(frozen=True, slots=True)
class Estimate:
    """State of the aircraft for guidance, control and failsafes.

    A failsafe looks at ``position_known``, ``height_known`` and ``airspeed_known`` (what is told of each is measured, not supposed),
    at the sigmas (how far it may be off: they grow by themselves without measurements) and at ``ratios`` (a sensor that contradicts
    the others is above 1 for long). An aircraft that reckons on has ``position_known`` False and a growing ``position_sigma``.
    """

    north: float  # m from the world's origin
    east: float  # m
    height: float  # m above the world's origin
    ground_speed: float  # m/s
    course: float  # rad from north, clockwise
    climb: float  # m/s
    roll: float  # rad
    pitch: float  # rad
    yaw: float  # rad from north, clockwise
    p: float  # rad/s, about body x (forward)
    q: float  # rad/s, about body y (right)
    r: float  # rad/s, about body z (down)
    airspeed: float  # m/s, true
    density: float  # kg/m^3
    side_force: float  # m/s^2, specific force along body y
    wind_north: float  # m/s, the way it blows to
    wind_east: float  # m/s
    position_sigma: float  # m, horizontal, of the worse axis
    height_known: bool  # False: neither barometer nor fixes, ``height`` is the last one known
    height_sigma: float = 0.0  # m
    lift: float = GRAVITY  # m/s^2, specific force up along body z
    airspeed_known: bool = True  # False: neither pressures nor fixes, it is taken to be that of trim
    position_known: bool = True  # False: no fix for a second, reckoned on with airspeed, heading and wind
    tilt_sigma: float = 0.0  # rad, of roll and pitch, the worse
    yaw_sigma: float = 0.0  # rad
    wind_sigma: float = 0.0  # m/s, of the worse axis
    ratios: Ratios = field(default_factory=Ratios)
