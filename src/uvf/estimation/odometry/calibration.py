"""Wheel radii and track from matched motions: how far the wheels turned, and where the scans say that this led.

Over a segment the wheels' ways add up along the headings that the odometry had (its gyroscope knows these better than the wheels):
displacement and turn are then linear in the radii, and the turn in the inverse of the track (Antonelli, Chiaverini & Fusco, IEEE T-RO 21,
2005). Recursive least squares about the present estimate; a segment in which the wheels slipped does not fit and is left out.
"""

from dataclasses import dataclass, field
from math import cos, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.kalman import Ekf, Measured, misfit
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse

Floats = NDArray[np.float64]

PRIOR = 0.05  # 1 sigma of each scale before anything is known
GATE = 16.3  # chi-square of three degrees of freedom, 99.9 %
PLACE, TURN = 0.01, 0.005  # m and rad, 1 sigma of a matched motion's ends
WHEEL = 0.005  # m per square root of m that a wheel rolls, 1 sigma
LEAST_SEGMENTS = 12
CERTAIN = (0.006, 0.006, 0.012)  # 1 sigma of radii and track
FADING = 0.95  # of the mean misfit, per segment
LONG, WIDE = 1.5, 2.5  # m and rad after which a segment is closed


class Scales(NamedTuple):
    """True left and right wheel radius and true track [-], over those that the odometry reckons with."""

    left: float = 1.0
    right: float = 1.0
    track: float = 1.0


@dataclass
class Segment:
    """Wheel motion from one matched pose to another.

    rolled: (2,) [m], distance rolled by each wheel; along: (2 axes, 2 wheels) [m], halves of them along the headings, in the frame of
    the begin; length [m], turned [rad], wheels [m]: sums of all distances forth and back, of turns, and of both wheels' distances.
    """

    begin: Pose2
    rolled: Floats = field(default_factory=lambda: np.zeros(2))
    along: Floats = field(default_factory=lambda: np.zeros((2, 2)))
    length: float = 0.0
    turned: float = 0.0
    wheels: float = 0.0

    def roll(self, left: float, right: float, heading: float, turn: float) -> None:
        """Adds a step: distances [m] of the left and right wheel.

        heading: [rad], of the odometry since the begin, at the middle of the step; turn: [rad], of the step.
        """
        ways = np.array((left, right))
        self.rolled += ways
        self.along += np.outer((cos(heading), sin(heading)), ways / 2)
        self.length += abs(left + right) / 2
        self.turned += abs(turn)
        self.wheels += abs(left) + abs(right)


class WheelCalibration:
    """Wheel radii and track as ``Scales``, with their covariance."""

    def __init__(self, track: float) -> None:
        """track: m, nominal."""
        self._track = track
        self._kalman = Ekf(np.ones(3), np.eye(3) * PRIOR**2)
        self._misfit = 1.0
        self.used = 0
        self.refused = 0

    @property
    def scales(self) -> Scales:
        """The scales as they are known now."""
        return Scales(*self._kalman.x.tolist())

    @property
    def covariance(self) -> Floats:
        """Covariance (3, 3) of the scales, larger where segments fit worse than they should.

        What was not moved stays as uncertain as it was.
        """
        limit: Floats = np.minimum(1.0, PRIOR / np.sqrt(np.diag(self._kalman.P) * self._worse))
        return self._kalman.P * self._worse * np.outer(limit, limit)

    @property
    def sigmas(self) -> Floats:
        """1 sigma (3,) [-] of left radius, right radius and track."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def is_certain(self) -> bool:
        """Whether enough segments were used and all sigmas are small enough."""
        return self.used >= LEAST_SEGMENTS and bool(np.all(self.sigmas < CERTAIN))

    @property
    def differs(self) -> bool:
        """Whether any scale differs from one by more than two sigma."""
        return bool(np.any(np.abs(self._kalman.x - 1.0) > 2.0 * self.sigmas))

    @property
    def _worse(self) -> float:
        return max(self._misfit, 1.0)

    def add(self, segment: Segment, end: Pose2) -> bool:
        """Takes a segment whose end the scans see at ``end``, in the same frame as ``segment.begin``; whether it was used."""
        matched = compose(inverse(segment.begin), end)
        left, right, track = self._kalman.x
        turn = (segment.rolled[1] * right - segment.rolled[0] * left) / (self._track * track)
        y = np.array((*(np.array(matched[:2]) - segment.along @ self._kalman.x[:2]), wrap(matched.yaw - turn)))
        h = np.zeros((3, 3))
        h[:2, :2] = segment.along
        h[2] = np.array((-segment.rolled[0], segment.rolled[1], -turn * self._track)) / (self._track * track)
        wheels = WHEEL**2 * segment.wheels  # m^2
        r = np.diag((2 * PLACE**2 + wheels / 4, 2 * PLACE**2 + wheels / 4, 2 * TURN**2 + wheels / self._track**2))
        measured = Measured(y, lambda x: np.zeros(3), h, r)
        squared = misfit(self._kalman, measured)
        if squared > GATE * self._worse:
            self.refused += 1
            return False
        self._kalman.take(measured)
        self._misfit = FADING * self._misfit + (1 - FADING) * squared / 3
        self.used += 1
        return True


class SegmentMaker:
    """Cuts a drive into segments for the calibration."""

    def __init__(self, calibration: WheelCalibration) -> None:
        self._calibration = calibration
        self._segment: Segment | None = None
        self._heading = 0.0
        self._last = 0.0

    def roll(self, left: float, right: float, heading: float, slipping: bool) -> None:
        """Adds a step: distances [m] of the left and right wheel by their nominal radii; a segment with slip is discarded.

        heading: [rad], of the odometry after the step.
        """
        turn = wrap(heading - self._last)
        self._last = heading
        if slipping:
            self._segment = None
        elif self._segment is not None:
            self._segment.roll(left, right, self._heading + turn / 2, turn)
            self._heading += turn

    def match(self, map_from_base: Pose2) -> None:
        """Takes a matched pose at the end of the last step; a segment that is long enough ends there."""
        segment = self._segment
        if segment is not None and segment.length < LONG and segment.turned < WIDE:
            return
        if segment is not None:
            self._calibration.add(segment, map_from_base)
        self._segment, self._heading = Segment(map_from_base), 0.0
