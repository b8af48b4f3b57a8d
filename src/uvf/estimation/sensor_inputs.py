"""What the estimators are given each cycle. NED and FRD."""

from dataclasses import dataclass

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class InertialSample:
    """One IMU sample in FRD: angular rates [rad/s], specific force [m/s^2], magnetic field [T]."""

    rates: Triple
    force: Triple
    field: Triple
    age: float = 0.0  # s, since it was taken


@dataclass(frozen=True, slots=True)
class GnssFix:
    """A satellite fix in the world frame, valid ``age`` [s] ago."""

    north: float  # m
    east: float  # m
    height: float  # m
    v_north: float  # m/s
    v_east: float  # m/s
    v_up: float  # m/s
    age: float  # s
    position_sigma: float  # m
    height_sigma: float  # m
    speed_sigma: float  # m/s


@dataclass(frozen=True, slots=True)
class Pressures:
    """Air data: static and differential pressure, and the temperature of the air."""

    static: float  # Pa
    differential: float  # Pa
    temperature: float  # K
    age: float = 0.0  # s, since they were taken


@dataclass(frozen=True, slots=True)
class Sensed:
    """Sensor inputs of one cycle: IMU samples since the last, the newest pressures, and a new fix, if any."""

    samples: list[InertialSample]
    pressures: Pressures | None
    fix: GnssFix | None
