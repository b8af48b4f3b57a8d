"""Wheel and inertial messages -> steps for the filter; what cannot be true makes none."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Gnss, Imu, WheelTicks
from uvf.estimation.odometry.inclination import Inclination
from uvf.estimation.odometry.satellites import SatelliteFix
from uvf.estimation.odometry.states import Step
from uvf.maths.kinematics import WheelTravel
from uvf.maths.rotations import from_euler, matrix
from uvf.models.vehicle.file import GroundBody
from uvf.models.vehicle.sensors import Mount
from uvf.runtime.messages.convert import array, seconds
from uvf.runtime.messages.wheels import counts_of

Floats = NDArray[np.float64]

MAX_GAP = 0.1  # s between two wheel messages above which the inertial samples do not cover the interval
JUMP = 10.0  # times the vehicle's greatest speed: what the wheels never turn
MAX_RATE, MAX_FORCE = 100.0, 1000.0  # rad/s, m/s^2: what no vehicle survives


class Readings:
    """Collects messages until a wheel message closes a step."""

    def __init__(self, body: GroundBody, imu: Mount | None) -> None:
        mount = imu or Mount()
        self._drive, self._fastest = body.drive.kinematics, body.max_linear
        self._body_from_imu: Floats = matrix(from_euler(*mount.rpy))
        self._arm = mount.xyz
        self._waiting: list[Imu] = []
        self._turning = self._force = 0.0
        self._inclination = Inclination()
        self.height = 0.0
        """m, climbed since the start."""
        self.last: WheelTicks | None = None

    @property
    def resolution(self) -> float:
        """Distance [m] that a wheel rolls from one tick to the next."""
        return self.last.radians_per_tick * self._drive.wheel_radius if self.last else 0.0

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch [rad] of the ground under the vehicle."""
        return self._inclination.tilt

    def take(self, wheels: WheelTicks, imu: list[Imu]) -> Step | None:
        """The step that ends with a new wheel message; None where counters jump, because they were reset or are broken."""
        self._waiting += imu
        last, self.last = self.last, wheels
        now = seconds(wheels.timestamp)
        dt = now - seconds(last.timestamp) if last else 0.0
        if last is None or now > seconds(last.timestamp):
            rates, forces = self._until(now)
        if last is None or dt <= 0.0 or not 0.0 < wheels.radians_per_tick <= 2 * np.pi:
            return None
        now_counts, counts = counts_of(wheels), counts_of(last)
        if not len(now_counts) == len(counts) == self._drive.channels:
            return None
        ways = self._drive.travel([(b - a) * wheels.radians_per_tick for a, b in zip(counts, now_counts, strict=True)])
        if max(map(abs, ways)) > JUMP * self._fastest * dt + self.resolution:
            return None
        if dt > MAX_GAP or not len(rates):
            return Step(dt, ways)
        return self._step(dt, ways, rates.mean(axis=0), forces.mean(axis=0))

    def _step(self, dt: float, ways: WheelTravel, rate: Floats, force: Floats) -> Step:
        """rate, force: (3,) means of the inertial unit, in its axes; what is no number or no vehicle survives is left out.

        The accelerometer feels the turning, too, where it sits off the axle, or the vehicle drives sideways.
        """
        if not np.abs(rate).max() <= MAX_RATE:
            return Step(dt, ways)
        rate = self._body_from_imu @ rate
        turning = float(rate[2])
        angular, self._turning = (turning - self._turning) / dt, turning
        if not (np.any(force) and np.abs(force).max() < MAX_FORCE):
            return Step(dt, ways, turning)
        x, y, _ = self._arm
        on_axle = self._body_from_imu @ force + (turning**2 * x + angular * y, turning**2 * y - angular * x, 0.0)
        tilting = self._inclination.step(dt, rate, on_axle, ways)
        self.height += self._inclination.climbed(ways)
        ways, turning = self._inclination.seen_from_above(ways, rate)
        ahead = float(on_axle[0]) + turning * ways.aside / dt
        jolt, self._force = ahead - self._force, ahead
        return Step(dt, ways, turning, ahead, *tilting, jolt)

    def _until(self, now: float) -> tuple[Floats, Floats]:
        """(n, 3) rates and forces of the samples of the interval that the wheels tell of."""
        due = [m for m in self._waiting if seconds(m.timestamp) <= now]
        self._waiting = [m for m in self._waiting if seconds(m.timestamp) > now]
        return np.array([array(m.angular_velocity) for m in due]), np.array([array(m.specific_force) for m in due])


def satellite_fix(m: Gnss) -> SatelliteFix:
    """The fix of a GNSS message: latitude and longitude [rad], altitude [m], velocity (2,) east and north [m/s]."""
    velocity = (m.velocity_enu.x, m.velocity_enu.y)
    known = m.fix == Gnss.FIX_3D
    return SatelliteFix(seconds(m.timestamp), known, m.latitude, m.longitude, m.altitude, velocity, m.horizontal_accuracy, m.speed_accuracy)
