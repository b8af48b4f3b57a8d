"""Areas of the plane with signed distances to their edges, and regions made of areas to stay within and to keep out of."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Point = tuple[float, float]

STEP = 0.5  # m, by which a way goes on where it runs along an edge


class Area(Protocol):
    """An area of the plane."""

    def inside(self, points: Floats) -> Floats:
        """Signed distances (n,) [m] from points (n, 2) [m] to the edge, positive inside."""

    @property
    def box(self) -> tuple[Point, Point]:
        """Lower and upper corner (x, y) [m] of the bounding box."""


@dataclass(frozen=True)
class Disc:
    """The inside of a circle."""

    centre: Point  # m
    radius: float  # m

    def inside(self, points: Floats) -> Floats:
        """Signed distances (n,) [m] from points (n, 2) [m] to the circle, positive inside."""
        distance: Floats = self.radius - np.hypot(points[:, 0] - self.centre[0], points[:, 1] - self.centre[1])
        return distance

    @property
    def box(self) -> tuple[Point, Point]:
        """Lower and upper corner (x, y) [m] of the bounding box."""
        (x, y), r = self.centre, self.radius
        return (x - r, y - r), (x + r, y + r)


class Polygon:
    """The inside of a simple polygon, whose edges must not cross (``crossing`` tells)."""

    def __init__(self, vertices: Sequence[Point]) -> None:
        """vertices: at least three, m, either way round; the last one is joined to the first."""
        self.vertices = tuple(vertices)
        self._start = np.array(vertices, dtype=np.float64)
        self._along = np.roll(self._start, -1, axis=0) - self._start
        self._squared = np.maximum((self._along**2).sum(axis=1), 1e-12)

    def inside(self, points: Floats) -> Floats:
        """Signed distances (n,) [m] from points (n, 2) [m] to the nearest edge, positive inside by the even-odd rule."""
        away = points[:, None, :] - self._start
        part = np.clip((away * self._along).sum(axis=2) / self._squared, 0.0, 1.0)
        distance = np.sqrt(((away - part[..., None] * self._along) ** 2).sum(axis=2)).min(axis=1)
        y0, y1 = self._start[:, 1], self._start[:, 1] + self._along[:, 1]
        straddles = (y0 > points[:, 1, None]) != (y1 > points[:, 1, None])
        rise = np.where(self._along[:, 1] == 0.0, 1.0, self._along[:, 1])
        crosses = self._start[:, 0] + self._along[:, 0] * (points[:, 1, None] - y0) / rise > points[:, 0, None]
        is_in = (straddles & crosses).sum(axis=1) % 2 == 1
        signed: Floats = np.where(is_in, distance, -distance)
        return signed

    @property
    def box(self) -> tuple[Point, Point]:
        """Lower and upper corner (x, y) [m] of the bounding box."""
        low, high = self._start.min(axis=0).tolist(), self._start.max(axis=0).tolist()
        return (low[0], low[1]), (high[0], high[1])

    @property
    def crossing(self) -> tuple[int, int] | None:
        """The first two edges, numbered by their first vertex, that cross each other; None where none do."""
        corners = [*self.vertices, self.vertices[0]]
        edges = list(itertools.pairwise(corners))
        for i, one in enumerate(edges):
            for j in range(i + 2, len(edges) - (i == 0)):
                if _cross(one, edges[j]):
                    return i, j
        return None


@dataclass(frozen=True)
class Overlap:
    """What lies within all of some areas, at least one."""

    areas: tuple[Area, ...]

    def inside(self, points: Floats) -> Floats:
        """Signed distances (n,) [m] from points (n, 2) [m], positive inside: the least over all areas."""
        least: Floats = np.min([area.inside(points) for area in self.areas], axis=0)
        return least

    @property
    def box(self) -> tuple[Point, Point]:
        """Lower and upper corner (x, y) [m] of where the areas may overlap; a point, or a segment, where they do not."""
        lows, highs = zip(*(area.box for area in self.areas), strict=True)
        low = max(x for x, _ in lows), max(y for _, y in lows)
        return low, (max(low[0], min(x for x, _ in highs)), max(low[1], min(y for _, y in highs)))


def _cross(one: tuple[Point, Point], other: tuple[Point, Point]) -> bool:
    def side(a: Point, b: Point, p: Point) -> float:
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    return side(*one, other[0]) * side(*one, other[1]) < 0 and side(*other, one[0]) * side(*other, one[1]) < 0


@dataclass(frozen=True)
class Region:
    """Within one of ``include`` (anywhere, without any), and outside of all of ``exclude``."""

    include: tuple[Area, ...] = ()
    exclude: tuple[Area, ...] = ()

    def clearance(self, points: Floats) -> Floats:
        """Signed distances (n,) [m] from points (n, 2) [m]: no edge is nearer; negative outside, by how far at least one has to go back."""
        least = np.full(len(points), np.inf)
        if self.include:
            least = np.max([area.inside(points) for area in self.include], axis=0)
        for area in self.exclude:
            least = np.minimum(least, -area.inside(points))
        return least

    def at(self, point: Point) -> float:
        """Clearance [m] at a point (x, y) [m]; negative outside."""
        return float(self.clearance(np.array((point,)))[0])

    def leaves(self, start: Point, end: Point, keep: float = 0.0) -> Point | None:
        """First point (x, y) [m] of the line from ``start`` to ``end`` that is nearer than ``keep`` [m] to an edge; None where none is.

        Sphere tracing, in steps of the clearance (nothing can be met within it) but at least ``STEP``.
        """
        length = math.dist(start, end)
        done = 0.0
        while True:
            part = done / length if length > 0 else 0.0
            here = (start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1]))
            room = self.at(here) - keep
            if room < 0:
                return here
            if done >= length:
                return None
            done = min(done + max(room, STEP), length)

    def roomiest(self, near: Point, radius: float, cells: int = 41) -> tuple[Point, float]:
        """(point (x, y), its clearance) [m] of a grid: the nearest to ``near`` with a clearance of ``radius`` [m], else the roomiest."""
        low, high = self._box(near, 4 * radius)
        x, y = np.meshgrid(np.linspace(low[0], high[0], cells), np.linspace(low[1], high[1], cells))
        points = np.column_stack((x.ravel(), y.ravel()))
        points = np.vstack((near, points))
        room = self.clearance(points)
        enough = room >= radius
        distance = np.hypot(*(points - near).T)
        best = int(np.argmin(np.where(enough, distance, np.inf))) if enough.any() else int(np.argmax(room))
        return (float(points[best, 0]), float(points[best, 1])), float(room[best])

    def _box(self, near: Point, about: float) -> tuple[Point, Point]:
        boxes = [area.box for area in self.include] or [((near[0] - about, near[1] - about), (near[0] + about, near[1] + about))]
        lows, highs = np.array([b[0] for b in boxes]).min(axis=0), np.array([b[1] for b in boxes]).max(axis=0)
        return (float(lows[0]), float(lows[1])), (float(highs[0]), float(highs[1]))
