"""The outline of a ground vehicle on the ground."""

from dataclasses import dataclass
from functools import cached_property
from math import cos, hypot, isfinite, pi, sin

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

Floats = NDArray[np.float64]
Point = tuple[float, float]

SIDES = 32
"""Of the outline of a circle."""
THIN = 1e-3  # m, the least width of an outline


@dataclass(frozen=True)
class RobotFootprint:
    """A convex outline (x, y) [m, base frame], anticlockwise, with the vehicle's centre of rotation (the base frame's origin) inside."""

    outline: tuple[Point, ...]
    round: bool = False
    """Whether the outline stands for the circle within it."""

    @staticmethod
    def circle(radius: float) -> "RobotFootprint":
        """A circle about the origin; radius [m]."""
        if not (isfinite(radius) and radius > THIN):
            raise ValueError(f"radius: {radius} m; a positive number of metres is needed")
        outer = radius / cos(pi / SIDES)
        return RobotFootprint(tuple((outer * cos(a), outer * sin(a)) for a in np.arange(SIDES) * (2 * pi / SIDES)), True)

    @staticmethod
    def polygon(points: Floats) -> "RobotFootprint":
        """The convex hull of points (n, 2) [m, base frame]. Raises ValueError for fewer than three, in a line, or not about the origin."""
        points = np.asarray(points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3 or not np.isfinite(points).all():
            raise ValueError("footprint: three or more points (x, y) of finite metres are needed")
        try:
            hull = points[ConvexHull(points).vertices]
        except QhullError as error:
            raise ValueError("footprint: its points lie in a line") from error
        made = RobotFootprint(tuple((float(x), float(y)) for x, y in hull))
        if made._side_distances().min() <= THIN:
            raise ValueError("footprint: the origin of the base frame, about which the vehicle turns, must lie inside of it")
        return made

    @cached_property
    def inscribed_radius(self) -> float:
        """Distance [m] from the origin to the nearest side: an obstacle nearer than that is touched in any heading."""
        return float(self._side_distances().min())

    @cached_property
    def circumscribed_radius(self) -> float:
        """Distance [m] from the origin to the farthest point: an obstacle farther away is touched in no heading."""
        return self.inscribed_radius if self.round else max(hypot(x, y) for x, y in self.outline)

    def padded(self, margin: float) -> "RobotFootprint":
        """The outline moved outwards by ``margin`` [m], 0 or more, with its corners kept sharp."""
        if not (isfinite(margin) and margin >= 0.0):
            raise ValueError(f"margin: {margin} m; 0 or more is needed")
        if self.round:
            return RobotFootprint.circle(self.inscribed_radius + margin)
        corners = np.array(self.outline)
        normals, distances = self._normals(), self._side_distances() + margin
        before = np.roll(np.arange(len(corners)), 1)
        moved = [np.linalg.solve(np.stack((normals[b], normals[k])), (distances[b], distances[k])) for k, b in enumerate(before)]
        return RobotFootprint(tuple((float(x), float(y)) for x, y in moved))

    def sides(self) -> Floats:
        """(n, 3) outward normal (x, y) and distance from the origin [m] of each side: inside, normal . point <= distance."""
        return np.column_stack((self._normals(), self._side_distances()))

    def _normals(self) -> Floats:
        corners = np.array(self.outline)
        along = np.roll(corners, -1, axis=0) - corners
        out: Floats = np.column_stack((along[:, 1], -along[:, 0])) / np.hypot(along[:, 0], along[:, 1])[:, None]
        return out

    def _side_distances(self) -> Floats:
        out: Floats = (self._normals() * np.array(self.outline)).sum(axis=1)
        return out
