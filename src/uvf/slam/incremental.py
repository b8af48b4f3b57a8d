"""What methods have in common that never revise what they have told."""

from collections.abc import Iterator
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.slam.method import Keyframe

Floats = NDArray[np.float64]


class IncrementalMethod:
    """All of a ``SlamMethod`` but ``add``, which appends to ``_poses`` (map_from_base) and ``_keyframes``."""

    def __init__(self) -> None:
        self._poses: list[Pose2] = []
        self._keyframes: list[Keyframe] = []

    def trajectory(self) -> Floats:
        """Poses map_from_base (readings, 3) [m, m, rad] as they were told."""
        return np.array(self._poses, dtype=np.float64).reshape(-1, 3)

    def keyframes(self) -> Iterator[Keyframe]:
        """The keyframes at the poses at which they were taken."""
        return iter(self._keyframes)

    def keyframe_count(self) -> int:
        """Number of keyframes."""
        return len(self._keyframes)

    def finish(self) -> None:
        """Does nothing: no work has been put off."""

    def _has_moved(self, distance: float, turn: float) -> bool:
        """Whether the last pose is farther [m, rad] from the last keyframe's, or there is none yet."""
        if not self._keyframes:
            return True
        now, last = self._poses[-1], self._keyframes[-1].map_from_base
        return hypot(now.x - last.x, now.y - last.y) > distance or abs(wrap(now.yaw - last.yaw)) > turn
