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
    """Where the vehicle is by what is known now.

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
    """Fed with readings in the order in which they were taken; the map frame is the first pose of the base.

    Nothing in a reading may end it: what cannot be used is left out, and the odometry carries on.
    """

    def add(self, reading: Reading) -> SlamEstimate:
        """Takes in one reading and says where the vehicle is."""

    def trajectory(self) -> Floats:
        """(readings, 3): map_from_base of every reading so far, by what is known now."""

    def keyframes(self) -> Iterator[Keyframe]:
        """What the map is to be drawn from, by what is known now."""

    def keyframe_count(self) -> int:
        """Of ``keyframes``; as long as readings come these are the same, at the same poses, until there is one more."""

    def finish(self) -> None:
        """After the last reading: work that had been put off."""
