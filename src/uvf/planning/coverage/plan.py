"""What a coverage planner returns: swaths in order, the whole path, and figures of it that are worked out apart from the planning."""

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from uvf.planning.coverage.cells import Cell
from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.transits import moved

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

TRANSIT, SWATH, HEADLAND = 0, 1, 2
"""Kinds of segments."""
TURNED = 0.01  # rad: a transit that turns less is flown straight on


@dataclass(frozen=True)
class CoveragePlan:
    """A planned coverage. Frame: east, north [m]; courses from east to north [rad].

    swaths: (n, 4) x, y of the beginning and of the end of each, in order, as they are gone along. segments: (k, 5) x, y, course,
    curvature [1/m], length [m] of the path, one after the other; kinds: (k,) TRANSIT, SWATH or HEADLAND. direction: [rad] of all swaths,
    modulo half a turn. time: [s]. cells: of the decomposition along the direction.
    """

    field: CoverageField
    width: float
    direction: float
    swaths: Floats
    segments: Floats
    kinds: Ints
    time: float
    cells: tuple[Cell, ...]

    @property
    def swath_length(self) -> float:
        """Length [m] of all swaths and headland passes together."""
        return float(self.segments[self.kinds != TRANSIT, 4].sum())

    @property
    def length(self) -> float:
        """Length [m] of the whole path, over ground."""
        return float(self.segments[:, 4].sum())

    @property
    def bound(self) -> float:
        """Least length [m] of swaths that cover the field: area over width.

        Each metre of a tool ``width`` wide sweeps no more than width square metres (Arkin, Fekete & Mitchell, "Approximation algorithms
        for lawn mowing and milling", Computational Geometry 17 (2000)).
        """
        return self.field.area / self.width

    @property
    def swath_ratio(self) -> float:
        """Length of the swaths over ``bound`` [-]."""
        return self.swath_length / self.bound

    @property
    def length_ratio(self) -> float:
        """Length of the whole path over ``bound`` [-]."""
        return self.length / self.bound

    @property
    def turns(self) -> int:
        """Number of transits between swaths that are not straight on."""
        passes = np.flatnonzero(self.kinds != TRANSIT)
        return sum(self._is_turn(int(a), int(b)) for a, b in itertools.pairwise(passes))

    def _is_turn(self, one: int, other: int) -> bool:
        way = self.segments[one + 1 : other]
        end = self.segments[other, 2] - self.segments[one, 2]
        return bool(np.abs(way[:, 3] * way[:, 4]).sum() > TURNED or abs(np.sin(end / 2)) > TURNED)

    @cached_property
    def covered(self) -> float:
        """Share [0..1] of the field that the swaths, ``width`` wide with square ends, and the headland passes sweep: an exact union."""
        return covered_share(self.field, self._swept)

    @property
    def _swept(self) -> shapely.Geometry:
        lines = shapely.linestrings(self.swaths.reshape(-1, 2, 2))
        swept = [shapely.buffer(lines, self.width / 2, cap_style="flat")]
        along = swept_along(self.segments[self.kinds == HEADLAND], self.width)
        return shapely.union_all([*swept[0], along])

    def path(self, step: float = 1.0) -> Floats:
        """Poses (k, 3) x, y [m], course [rad] along the whole path, at most ``step`` [m] apart within each segment, with all their ends."""
        found = []
        for row in self.segments:
            count = max(int(np.ceil(row[4] / step)), 1)
            found += [moved(row[:3], row[3], s) for s in np.linspace(0.0, row[4], count + 1)]
        return np.array(found).reshape(-1, 3)

    @property
    def outside(self) -> float:
        """Length [m] of the path that runs outside of the field or over its holes."""
        way = shapely.LineString(self.path()[:, :2]) if len(self.segments) else shapely.LineString()
        return float(way.difference(self.field.shape.buffer(1e-3)).length)


def swept_along(straights: Floats, width: float) -> shapely.Geometry:
    """What a tool ``width`` [m] wide sweeps along straight segments (k, 5), and when it turns on the spot at their ends."""
    ends = np.array([moved(row[:3], row[3], row[4])[:2] for row in straights]).reshape(-1, 2)
    lines = shapely.linestrings(np.stack((straights[:, :2], ends), axis=1))
    return shapely.union_all(shapely.buffer(lines, width / 2, cap_style="round"))


def covered_share(field: CoverageField, swept: shapely.Geometry) -> float:
    """Share [0..1] of the field's area within ``swept``."""
    return float(field.shape.intersection(swept).area / field.area)
