"""How a lidar goes about a scan: all beams at once, or one after the other while its vehicle moves on."""

from itertools import pairwise
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import LaserScan
from uvf.runtime.messages.convert import seconds

SPACING = 0.02  # s, at most, within which the beams of a part are measured


class Part(NamedTuple):
    """Neighbouring beams of a message, ``ranges[beams]``, and the middle of the time in which they were measured [s]."""

    at: float
    beams: slice


class Sweeping(NamedTuple):
    """duration: s from the first beam to the last, evenly; clockwise: the last of the message is measured first.

    The stamp of a message is that of the beam that is measured first.
    """

    duration: float = 0.0
    clockwise: bool = False

    def ranges(self, scan: LaserScan) -> NDArray[np.float64]:
        """(n,) m, in the order in which they are measured."""
        ranges = np.array(scan.ranges)
        return ranges[::-1].copy() if self.clockwise else ranges

    def end(self, scan: LaserScan) -> float:
        """s, when the last beam was measured."""
        return seconds(scan.timestamp) + self.duration

    def parts(self, scan: LaserScan) -> list[Part]:
        """All beams in the order of the message; a single part where all are taken at once."""
        n, first = max(len(scan.ranges), 1), seconds(scan.timestamp)
        count = min(n, max(ceil(self.duration / SPACING - 1e-9), 1))
        edges = [round(n * k / count) for k in range(count + 1)]
        found = []
        for begin, end in pairwise(edges):
            share = (begin + end - 1) / 2 / max(n - 1, 1)
            found.append(Part(first + self.duration * (1.0 - share if self.clockwise else share), slice(begin, end)))
        return found


AT_ONCE = Sweeping()
