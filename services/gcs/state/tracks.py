"""The way a vehicle has gone, in closed chunks and one growing tail, so that a page never resends old points."""

from collections import deque

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CHUNK = 250  # points
MAX_CHUNKS = 200


class VehicleTrack:
    """Points at least ``spacing`` [m] apart; a step longer than ``jump`` [m] (a reset, a relocation) breaks the line."""

    def __init__(self, spacing: float, jump: float) -> None:
        self.spacing = spacing
        self.jump = jump
        self.closed: deque[tuple[int, Floats]] = deque(maxlen=MAX_CHUNKS)
        """(running number, (n, 3) m) of the chunks that no longer change."""
        self._tail: list[Floats] = []
        self._count = 0

    def add(self, position: Floats) -> None:
        """Appends a position (3,) [m, world]."""
        if not self._tail:
            self._tail.append(position)
            return
        step = float(np.linalg.norm(position - self._tail[-1]))
        if step > self.jump:
            self._close()
            self._tail = [position]
        elif step >= self.spacing:
            self._tail.append(position)
            if len(self._tail) >= CHUNK:
                self._close()
                self._tail = [position]

    def _close(self) -> None:
        if len(self._tail) > 1:
            self.closed.append((self._count, np.array(self._tail)))
            self._count += 1

    def clear(self) -> None:
        """Drops all points."""
        self.closed.clear()
        self._tail = []

    @property
    def tail(self) -> Floats:
        """Points (n, 3) [m, world] of the growing tail."""
        return np.array(self._tail).reshape(-1, 3)

    @property
    def tail_length(self) -> int:
        """Number of points of the growing tail."""
        return len(self._tail)

    @property
    def count(self) -> int:
        """Number of the next chunk to be closed."""
        return self._count
