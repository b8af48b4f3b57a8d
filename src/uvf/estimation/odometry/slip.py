"""Wheels that slip: they disagree with gyroscope and accelerometer, or with the motion that the scans see."""

from collections import deque
from math import hypot, sqrt
from typing import NamedTuple

from uvf.maths.se2 import Pose2, compose, inverse

ONE_GATE, MEAN_GATE = 16.0, 25.0  # normalised innovation squared of a step, and of the running mean
LEAST = 0.02  # m/s, a smaller difference is none
MEMORY = 0.3  # s, of the running mean
BEGINS, ENDS = 0.1, 1.0  # s of doubt after which an episode begins, and without it after which it ends
WINDOW, LEAST_WAY = 2.0, 0.15  # s and m: what the odometry went and the scans did not see


class WheelWatch:
    """Tests a wheel against the inertial unit: in each step, and on the mean of the last ones."""

    def __init__(self) -> None:
        self.mean = 0.0
        """m/s, running mean of wheel less inertial unit."""
        self.ratio = 0.0
        """Of the worse test to its gate: above 1 the wheel is not believed."""

    def believes(self, innovation: float, variance: float, dt: float) -> bool:
        """Whether the wheel is believed in a step of ``dt`` [s]; innovation: [m/s], and its variance [(m/s)^2]."""
        share = min(dt / MEMORY, 1.0)
        self.mean += share * (innovation - self.mean)
        of_step = innovation**2 / (ONE_GATE * variance)
        of_mean = self.mean**2 / (MEAN_GATE * variance * share / (2.0 - share))
        self.ratio = max(of_step, of_mean) * (max(abs(innovation), abs(self.mean)) > LEAST)
        return self.ratio < 1.0


class Slipping(NamedTuple):
    """What is reported of an episode of slipping."""

    cause: str


class Episodes:
    """Reports each episode of slipping once."""

    def __init__(self) -> None:
        self.active = False
        self._doubt_for = 0.0
        self._calm_for = 0.0

    def step(self, cause: str | None, dt: float) -> Slipping | None:
        """The episode that begins in this step of ``dt`` [s], if one does.

        cause: what disagrees now, None if nothing does.
        """
        self._doubt_for = self._doubt_for + dt if cause else 0.0
        self._calm_for = 0.0 if cause else self._calm_for + dt
        if self.active:
            self.active = self._calm_for < ENDS
            return None
        self.active = cause is not None and self._doubt_for >= BEGINS
        return Slipping(cause) if self.active and cause else None


class Unseen(NamedTuple):
    """Motion by odometry that the scans do not see."""

    cause: str
    speed: float
    """m/s forward that they see."""


class MatchedMotion:
    """Compares the motion by odometry with that on the map over the last ``WINDOW``.

    A map that is corrected by a loop looks the same when it moves the vehicle back by ``LEAST_WAY`` in that time: the odometry is then
    believed less for a moment, which does no harm.
    """

    def __init__(self) -> None:
        self._track: deque[tuple[float, Pose2, Pose2]] = deque()

    def compare(self, t: float, odom_from_base: Pose2, map_from_odom: Pose2) -> Unseen | None:
        """Motion that the scans do not see, None if they agree; called at each new correction, stamped ``t`` [s]."""
        if self._track and t <= self._track[-1][0]:
            self._track.clear()
        self._track.append((t, odom_from_base, compose(map_from_odom, odom_from_base)))
        while t - self._track[0][0] > WINDOW + 1e-6:
            self._track.popleft()
        begin, odom, in_map = self._track[0]
        if t - begin < 0.9 * WINDOW:
            return None
        way, seen = (compose(inverse(a), b) for a, b in ((odom, odom_from_base), (in_map, self._track[-1][2])))
        length = hypot(way.x, way.y)
        along = (way.x * seen.x + way.y * seen.y) / max(length, 1e-9)
        if length - along < LEAST_WAY:
            return None
        forward = along if way.x > 0.0 else -along
        return Unseen(f"odometry went {length:.2f} m in {t - begin:.1f} s, the scans saw {along:.2f} m", forward / (t - begin))


def wheel_cause(name: str, told: float, expected: float) -> str:
    """Text of the disagreement: ``told`` [m/s] by the wheel, ``expected`` [m/s] by the inertial unit."""
    return f"the {name} wheel rolls {told:.2f} m/s, gyroscope and accelerometer say {expected:.2f} m/s"


def sigma(variance: float) -> float:
    """Square root of a variance, e.g. [m] of [m^2], which rounding may have made negative."""
    return sqrt(max(variance, 0.0))
