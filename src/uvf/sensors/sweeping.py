"""How a lidar goes about a scan: all beams at once, or one after the other while its vehicle moves on."""

from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

SPACING = 0.02  # s, at most, within which the beams of a part are measured


class SweepSegment(NamedTuple):
    """Neighbouring beams of a message, ``ranges[beams]``, and the middle of the time in which they were measured, ``at`` [s]."""

    at: float
    beams: slice


class Sweeping(NamedTuple):
    """Timing of a sweep: ``duration`` [s] from the first beam to the last; clockwise: the message's last beam is measured first.

    The stamp of a message is that of the beam that is measured first.
    """

    duration: float = 0.0
    clockwise: bool = False

    def in_order(self, ranges: NDArray[np.float64]) -> NDArray[np.float64]:
        """Ranges (n,) [m] of a message in the order in which they were measured."""
        return ranges[::-1].copy() if self.clockwise else ranges

    def end(self, stamp: float) -> float:
        """Time [s] at which the last beam of the scan stamped ``stamp`` [s] was measured."""
        return stamp + self.duration

    def parts(self, beams: int, stamp: float) -> list[SweepSegment]:
        """Segments of a scan of ``beams`` beams stamped ``stamp`` [s], in the message's order; one segment where all are taken at once."""
        n, first = max(beams, 1), stamp
        count = min(n, max(ceil(self.duration / SPACING - 1e-9), 1))
        edges = [round(n * k / count) for k in range(count + 1)]
        found = []
        for begin, end in pairwise(edges):
            share = (begin + end - 1) / 2 / max(n - 1, 1)
            found.append(SweepSegment(first + self.duration * (1.0 - share if self.clockwise else share), slice(begin, end)))
        return found


AT_ONCE = Sweeping()
