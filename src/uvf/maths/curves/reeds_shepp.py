"""Reeds-Shepp paths: the shortest way between two configurations of a car that turns no tighter than a radius and drives both ways."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvf.maths.curves.reeds_shepp_words import reeds_shepp_segments, reeds_shepp_word
from uvf.maths.curves.segments import MOST, Triple, checked_configuration, checked_radius, end_of, sampled

Floats = NDArray[np.float64]

NONE = 1e-12
"""Of the radius: shorter segments are left out."""
WORDS = 44
"""Solutions to look at; the paper counts 48, telling C|C|C from C|CC by the sign of the last turn."""


@dataclass(frozen=True)
class ReedsSheppPath:
    """A path of at most five segments from ``start`` (x, y, heading) [m, m, rad].

    ``turns`` are the segments' curvatures times ``radius`` [m]: 1 left, 0 straight, -1 right; ``lengths`` [m] are signed, negative =
    backwards.
    """

    start: Triple
    radius: float
    turns: tuple[int, ...]
    lengths: tuple[float, ...]

    @property
    def length(self) -> float:
        """Distance driven [m]."""
        return sum(abs(length) for length in self.lengths)

    @property
    def word(self) -> str:
        """Kind and direction of each segment, such as ``L+R-S-L-``; empty for a path of no length."""
        return "".join("SLR"[turn] + "-+"[length > 0] for turn, length in zip(self.turns, self.lengths, strict=True))

    @cached_property
    def segments(self) -> Floats:
        """(k, 2): signed length [m] and curvature [1/m] of each segment."""
        return np.array([(length, turn / self.radius) for turn, length in zip(self.turns, self.lengths, strict=True)]).reshape(-1, 2)

    @property
    def end(self) -> Triple:
        """Configuration (x [m], y [m], heading [rad], not wrapped) at the end."""
        return end_of(self.start, self.segments)

    def at(self, s: Floats) -> Floats:
        """Configurations (n, 4): x, y [m], heading [rad], not wrapped, direction of travel (1 or -1), after ``s`` (n,) [m] of driving.

        Before the start and beyond the end the ends are repeated. Raises ValueError for ``s`` that is not finite or not ascending.
        """
        s = np.ascontiguousarray(s, dtype=np.float64)
        if s.ndim != 1 or not np.isfinite(s).all() or (np.diff(s) < 0).any():
            raise ValueError("s: it takes finite, ascending distances [m] along the path, of shape (n,)")
        return sampled(self.start, self.segments, s)


def reeds_shepp_path(start: Triple, end: Triple, radius: float) -> ReedsSheppPath:
    """Shortest Reeds-Shepp path between the configurations ``start`` and ``end`` (x, y, heading) [m, m, rad], turns of ``radius`` [m].

    Raises ValueError for a radius that is not positive and for configurations that are not finite.
    """
    start, end = checked_configuration("start", start), checked_configuration("end", end)
    out = np.zeros((MOST, 2))
    reeds_shepp_segments(start, end, checked_radius(radius), out)
    return _path(start, float(radius), out)


def reeds_shepp_paths(start: Triple, end: Triple, radius: float) -> list[ReedsSheppPath]:
    """Paths of every word that leads from ``start`` to ``end``, as in ``reeds_shepp_path``, in no order."""
    start, end = checked_configuration("start", start), checked_configuration("end", end)
    radius, found = checked_radius(radius), []
    for number in range(WORDS):
        out = np.zeros((MOST, 2))
        if np.isfinite(reeds_shepp_word(number, start, end, radius, out)):
            found.append(_path(start, radius, out))
    return found


def _path(start: Triple, radius: float, segments: Floats) -> ReedsSheppPath:
    kept = segments[np.abs(segments[:, 0]) > NONE * radius]
    return ReedsSheppPath(start, radius, tuple(round(c * radius) for c in kept[:, 1].tolist()), tuple(kept[:, 0].tolist()))
