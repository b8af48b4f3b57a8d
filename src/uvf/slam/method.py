"""What every SLAM method offers; the live service and ``uvf slam`` know nothing else of it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SlamEstimate:
    """Estimate of where the vehicle is.

    covariance: (3, 3) of (x, y, yaw) in the map frame [m, rad]; quality: 0 (the sweep fits nothing) to 1 (all of it fits).
    """

    map_from_base: Pose2
    covariance: Floats
    quality: float


@dataclass(frozen=True)
class Keyframe:
    """A reading that the map is drawn from, and where it was taken."""

    map_from_base: Pose2
    reading: Reading


class SlamMethod(Protocol):
    """Interface of a SLAM method, fed with readings in the order in which they were taken. The map frame is the first pose of the base.

    Nothing in a reading may end it: what cannot be used is left out, and the odometry carries on.
    """

    def add(self, reading: Reading) -> SlamEstimate:
        """Takes in one reading; returns where the vehicle is."""

    def trajectory(self) -> Floats:
        """Poses map_from_base (readings, 3) [m, m, rad] of every reading so far, by what is known now."""

    def keyframes(self) -> Iterator[Keyframe]:
        """The keyframes that the map is to be drawn from, by what is known now."""

    def keyframe_count(self) -> int:
        """Number of ``keyframes``; as long as readings come these are the same, at the same poses, until there is one more."""

    def finish(self) -> None:
        """Does the work that had been put off; called after the last reading."""
