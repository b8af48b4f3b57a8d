"""Where a body has been lately, for a sensor that takes its time."""

from collections import deque
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class PosedBody(Protocol):
    """A body's pose in the world."""

    @property
    def position(self) -> Floats:
        """Position (3,) [m] in the world."""
        ...

    @property
    def world_from_body(self) -> Floats:
        """Attitude as a unit quaternion wxyz (4,)."""
        ...


class BodyTrack:
    """The poses of a body by time, interpolated between them; before the first one and after the last the body stands still."""

    def __init__(self, span: float) -> None:
        """span: s that are looked back over."""
        self._span = span
        self._poses: deque[tuple[float, Floats, Floats]] = deque()

    def add(self, t: float, body: PosedBody) -> None:
        """Adds the pose of a step at ``t`` [s]; times must rise."""
        self._poses.append((t, body.position, body.world_from_body))
        while len(self._poses) > 1 and self._poses[1][0] <= t - self._span:
            self._poses.popleft()

    def at(self, times: Floats) -> tuple[Floats, Floats]:
        """Positions (n, 3) [m] and attitudes world_from_body (n, 4) at ``times`` [s]."""
        known, positions, attitudes = (np.array(column) for column in zip(*self._poses, strict=True))
        turned_over = np.cumprod(np.where((attitudes[1:] * attitudes[:-1]).sum(axis=1) < 0.0, -1.0, 1.0))
        attitudes[1:] *= turned_over[:, None]  # q and -q are one attitude, but not between them
        found = np.column_stack([np.interp(times, known, column) for column in np.hstack((positions, attitudes)).T])
        return found[:, :3], found[:, 3:] / np.linalg.norm(found[:, 3:], axis=1)[:, None]
