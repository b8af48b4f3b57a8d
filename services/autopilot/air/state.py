"""What the estimator hands to guidance and control. NED and FRD."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Estimate:
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
    position_sigma: float  # m
    height_known: bool  # False: neither barometer nor fixes, ``height`` is the last one known
