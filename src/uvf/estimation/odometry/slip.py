"""Wheels that slip: they disagree with gyroscope and accelerometer, or with the motion that the scans see."""

from collections import deque
from math import copysign, cos, inf, sin, sqrt
from typing import NamedTuple

import numpy as np

from uvf.maths.se2 import Pose2, compose, inverse

ONE_GATE, MEAN_GATE = 16.0, 25.0  # normalised innovation squared of a step, and of the running mean
LEAST = 0.02  # m/s, a smaller difference is none
MEMORY = 0.3  # s, of the running mean
BEGINS, ENDS = 0.1, 1.0  # s of doubt after which an episode begins, and without it after which it ends
WINDOW, LEAST_WAY = 2.0, 0.15  # s and m: what the wheels rolled and the scans did not see
LEAST_PARTS = 3  # between matches: one may be a loop that closes, and one alone says little
BLUR, STANDS = 0.03, 1e-3  # m: by which matches of scans vary; of wheels that do not turn


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
    """Motion by the wheels that the scans do not see."""

    cause: str
    speed: float
    """m/s forward that they see."""


class _Part(NamedTuple):
    """Between two matches: s, how long; m, the signed way by the wheels, and what the scans miss of it."""

    duration: float
    way: float
    missing: float


class MatchedMotion:
    """Compares the way of the wheels with the motion between the poses that scans were matched at, over the last ``WINDOW``.

    Between two matches, slip takes back no more than what the wheels have rolled, and the part that misses most does not count: what a
    closed loop moves the vehicle by at once is no slip.
    """

    def __init__(self) -> None:
        self._rolled: deque[tuple[float, float]] = deque([(-inf, 0.0)])  # s, and signed way since the start [m]
        self._last: tuple[float, float, Pose2] | None = None
        self._parts: deque[_Part] = deque()

    def roll(self, t: float, way: float) -> None:
        """Adds what both wheels have rolled on average until ``t`` [s] since the last call; way: m, negative backwards."""
        if t <= self._rolled[-1][0]:
            self._rolled, self._last = deque([(-inf, 0.0)]), None
            self._parts.clear()
        self._rolled.append((t, self._rolled[-1][1] + way))
        while t - self._rolled[0][0] > WINDOW:
            self._rolled.popleft()

    def reaches(self, t: float) -> bool:
        """Whether the wheels have told of ``t`` [s]; before, there is nothing to compare a match with."""
        return t <= self._rolled[-1][0]

    def compare(self, t: float, map_from_base: Pose2) -> Unseen | None:
        """Motion that the scans do not see, None if they agree; called at each match, of a scan of ``t`` [s]."""
        times, ways = zip(*self._rolled, strict=True)
        if not times[0] <= t <= times[-1]:
            return None
        rolled = float(np.interp(t, times, ways))
        last, self._last = self._last, (t, rolled, map_from_base)
        if last is None or not 0.0 < t - last[0] <= WINDOW:
            self._parts.clear()
            return None
        way, seen = rolled - last[1], compose(inverse(last[2]), map_from_base)
        ahead = seen.x * cos(seen.yaw / 2) + seen.y * sin(seen.yaw / 2)  # along the chord of an arc
        most = abs(way) + BLUR
        missing = min(max(copysign(1.0, way) * (way - ahead), -most), most) if abs(way) > STANDS else 0.0
        self._parts.append(_Part(t - last[0], way, missing))
        while len(self._parts) > LEAST_PARTS and self._duration - self._parts[0].duration >= WINDOW - 1e-6:
            self._parts.popleft()
        return self._unseen()

    @property
    def _duration(self) -> float:
        return sum(part.duration for part in self._parts)

    def _unseen(self) -> Unseen | None:
        duration = self._duration
        if len(self._parts) < LEAST_PARTS or duration < 0.8 * WINDOW:
            return None
        length, missing = sum(abs(part.way) for part in self._parts), sum(part.missing for part in self._parts)
        if missing - max(part.missing for part in self._parts) < LEAST_WAY:
            return None
        seen, ahead = length - missing, copysign(1.0, sum(part.way for part in self._parts))
        cause = f"the wheels rolled {length:.2f} m in {duration:.1f} s, the scans saw {seen:.2f} m"
        return Unseen(cause, ahead * seen / duration)


def wheel_cause(name: str, told: float, expected: float) -> str:
    """Text of the disagreement: ``told`` [m/s] by the wheel, ``expected`` [m/s] by the inertial unit."""
    return f"the {name} wheel rolls {told:.2f} m/s, gyroscope and accelerometer say {expected:.2f} m/s"


def sigma(variance: float) -> float:
    """Square root of a variance, e.g. [m] of [m^2], which rounding may have made negative."""
    return sqrt(max(variance, 0.0))
