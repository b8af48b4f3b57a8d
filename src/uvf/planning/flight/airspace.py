"""Where an aircraft may fly: prisms to keep clear of, a fence to stay within, lowest and largest heights.

Places are x, y [m] and a height [m]; courses count from x towards y, so that (east, north) has them counter-clockwise and (north, east)
clockwise. Areas are those of ``uvf.maths.zones``, in the same plane.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isnan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.zones import Area, Disc, Overlap, Point, Polygon, Region

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


ANYWHERE = Region()


@dataclass(frozen=True)
class Prism:
    """A polygon or disc between two heights [m]; from below any ground and without an end upwards unless they are given."""

    area: Polygon | Disc
    floor: float = -inf
    ceiling: float = inf


@dataclass(frozen=True)
class Airspace:
    """``obstacles``, the ``fence`` (anywhere, if it has no zones), and heights from ``floor`` to ``ceiling`` [m].

    Raises ValueError for a floor that is not below its ceiling.
    """

    obstacles: tuple[Prism, ...] = ()
    fence: Region = ANYWHERE
    floor: float = -inf
    ceiling: float = inf

    def __post_init__(self) -> None:
        for what, low, high in (("airspace", self.floor, self.ceiling), *(("obstacle", p.floor, p.ceiling) for p in self.obstacles)):
            if isnan(low) or isnan(high) or low >= high:
                raise ValueError(f"{what}: its floor, {low:g} m, is not below its ceiling, {high:g} m")


def box(low: Point, high: Point, floor: float, ceiling: float) -> Prism:
    """A box with sides along x and y, from corner ``low`` to ``high`` and from ``floor`` to ``ceiling`` [m]."""
    return Prism(Polygon([low, (high[0], low[1]), high, (low[0], high[1])]), floor, ceiling)


def cylinder(centre: Point, radius: float, floor: float, ceiling: float) -> Prism:
    """An upright cylinder about ``centre`` [m], from ``floor`` to ``ceiling`` [m]."""
    return Prism(Disc(centre, radius), floor, ceiling)


class Areas(NamedTuple):
    """Areas for kernels: ``discs`` (n, 3) x, y, radius, bounding circles for polygons; ``spans`` (n, 2) first corner and number of them
    in ``corners`` (m, 2), 0 for a disc; ``heights`` (n, 2) floor and ceiling; ``groups`` (n,): those of one group overlap."""

    discs: Floats
    spans: Ints
    corners: Floats
    heights: Floats
    groups: Ints


class Space(NamedTuple):
    """For kernels: areas to keep clear of, those to stay within (none: anywhere), and floor and ceiling [m]."""

    obstacles: Areas
    fence: Areas
    heights: tuple[float, float]


def space_of(airspace: Airspace) -> Space:
    """The airspace for kernels. Raises ValueError for an area that is neither a disc, a polygon nor an overlap of such."""
    solids = [(p.area, p.floor, p.ceiling, 0) for p in airspace.obstacles]
    for area in airspace.fence.exclude:
        solids += [(part, -inf, inf, 0) for part in _parts(area, is_alone=True)]
    fence = [(part, -inf, inf, i) for i, area in enumerate(airspace.fence.include) for part in _parts(area, is_alone=False)]
    return Space(_areas(solids), _areas(fence), (float(airspace.floor), float(airspace.ceiling)))


def _parts(area: Area, is_alone: bool) -> list[Polygon | Disc]:
    if isinstance(area, Polygon | Disc):
        return [area]
    if isinstance(area, Overlap) and not is_alone:
        return [part for inner in area.areas for part in _parts(inner, is_alone)]
    raise ValueError(f"a zone of {type(area).__name__}: it takes polygons and discs, and overlaps of them to stay within")


def _areas(parts: Sequence[tuple[Polygon | Disc, float, float, int]]) -> Areas:
    discs, spans, corners = np.zeros((len(parts), 3)), np.zeros((len(parts), 2), dtype=np.int64), list[Point]()
    for i, (area, _, _, _) in enumerate(parts):
        if isinstance(area, Disc):
            discs[i] = (*area.centre, area.radius)
        else:
            vertices = np.array(area.vertices)
            middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
            discs[i] = (*middle, np.linalg.norm(vertices - middle, axis=1).max())
            spans[i] = len(corners), len(vertices)
            corners += area.vertices
    heights = np.array([(low, high) for _, low, high, _ in parts], dtype=np.float64).reshape(-1, 2)
    groups = np.array([group for _, _, _, group in parts], dtype=np.int64)
    return Areas(discs, spans, np.array(corners, dtype=np.float64).reshape(-1, 2), heights, groups)
