"""A sweep as points with the direction of the surface they lie on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.se2 import Pose2
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

ENOUGH = 200
"""Beams of a sweep beyond which more of them cost time and tell nothing more."""
WINDOW = 0.1
"""rad to either side of a beam in which its neighbours on the surface are looked for."""
LEAST_NEIGHBOURS = 4
GAPS = 3.5
NEAR, FAR, SPREAD = 0.12, 2.0, 0.06
"""A neighbour lies within ``SPREAD`` times the range, at least ``NEAR`` and at most ``FAR`` [m]: past that it is another surface."""
ROUGH, CURVED = 0.004, 0.03
"""m^2 and share of the length's variance that a straight surface may have across it."""

SCANT, THIN = 0.12, 0.5
"""Shares of the beams below which little has come back, and below which it is not enough to tell the heading better than an odometry
that has proved itself: a post here and there."""
UNSURE = 0.3  # weight of a point whose normal is not known


@dataclass(frozen=True)
class Cloud:
    """A sweep as points (n, 2) [m] with unit normals (n, 2) towards the lidar, 0 where the surface is not straight; in one frame.

    weights: (n,) 0..1, how far a point tells where its surface is.
    """

    points: Floats
    normals: Floats
    weights: Floats
    returned: float = 1.0
    """Share of the beams that came back."""

    @property
    def is_scant(self) -> bool:
        """Whether so little of the sweep came back that it may all be things that move."""
        return self.returned < SCANT

    @property
    def is_thin(self) -> bool:
        """Whether less of it came back than tells the heading well."""
        return self.returned < THIN

    @property
    def flat(self) -> NDArray[np.bool_]:
        """Mask (n,) of the points whose normal is known."""
        known: NDArray[np.bool_] = (self.normals != 0.0).any(axis=1)
        return known

    def moved(self, a_from_b: Pose2) -> "Cloud":
        """The cloud in frame a."""
        return Cloud(*placed(self.points, self.normals, np.array(a_from_b)), self.weights)


def joined(clouds: Sequence[Cloud]) -> Cloud:
    """All points of clouds in one frame; ``returned`` is that of the last one."""
    if not clouds:
        return Cloud(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))
    points, normals, weights = (np.concatenate([getattr(c, part) for c in clouds]) for part in ("points", "normals", "weights"))
    return Cloud(points, normals, weights, clouds[-1].returned)


@compiled
def placed(points: Floats, normals: Floats, pose: Floats) -> tuple[Floats, Floats]:
    """Points and normals, (n, 2) each, of frame b in frame a; pose: a_from_b (3,) [m, m, rad]."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    moved, turned = np.empty_like(points), np.empty_like(normals)
    for i in range(points.shape[0]):
        moved[i, 0] = c * points[i, 0] - s * points[i, 1] + pose[0]
        moved[i, 1] = s * points[i, 0] + c * points[i, 1] + pose[1]
        turned[i, 0] = c * normals[i, 0] - s * normals[i, 1]
        turned[i, 1] = s * normals[i, 0] + c * normals[i, 1]
    return moved, turned


@compiled
def _normal(points: Floats, returned: NDArray[np.bool_], i: int, reach: tuple[int, float]) -> tuple[float, float]:
    """Unit normal of the line through the neighbours of point i, (0, 0) where they make none."""
    window, limit = reach
    n = sx = sy = sxx = sxy = syy = 0.0
    for j in range(max(0, i - window), min(points.shape[0], i + window + 1)):
        dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        if returned[j] and dx * dx + dy * dy < limit * limit:
            n += 1.0
            sx += dx
            sy += dy
            sxx += dx * dx
            sxy += dx * dy
            syy += dy * dy
    if n < LEAST_NEIGHBOURS:
        return 0.0, 0.0
    xx, xy, yy = sxx / n - (sx / n) ** 2, sxy / n - sx * sy / (n * n), syy / n - (sy / n) ** 2
    mean, half = (xx + yy) / 2.0, np.sqrt(((xx - yy) / 2.0) ** 2 + xy * xy)
    if mean - half > ROUGH + CURVED * (mean + half):
        return 0.0, 0.0
    along = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    return -np.sin(along), np.cos(along)


@compiled
def _gap(points: Floats, returned: NDArray[np.bool_], i: int) -> float:
    """m, from point i to the nearer one of the beams beside it; 0 where there is none."""
    gap = np.inf
    for j in (i - 1, i + 1):
        if 0 <= j < points.shape[0] and returned[j]:
            gap = min(gap, np.sqrt((points[j, 0] - points[i, 0]) ** 2 + (points[j, 1] - points[i, 1]) ** 2))
    return gap if gap < np.inf else 0.0


@compiled
def _normals(points: Floats, returned: NDArray[np.bool_], view: tuple[tuple[float, float], int], kept: NDArray[np.int64]) -> Floats:
    """(k, 2) of the points kept, towards the lidar; view: where that is, and the beams of the window to either side."""
    origin, window = view
    normals = np.zeros((kept.shape[0], 2))
    for k in range(kept.shape[0]):
        i = kept[k]
        vx, vy = points[i, 0] - origin[0], points[i, 1] - origin[1]
        limit = min(max(NEAR, SPREAD * np.sqrt(vx * vx + vy * vy), GAPS * _gap(points, returned, i)), FAR)
        nx, ny = _normal(points, returned, i, (window, limit))
        side = -1.0 if nx * vx + ny * vy > 0.0 else 1.0
        normals[k, 0], normals[k, 1] = side * nx, side * ny
    return normals


def cloud_of(reading: Reading) -> Cloud:
    """Cloud of the beams that came back, base frame; of dense sweeps every second, third ... one.

    Normals: principal axis of the neighbours in the order of the beams, of which none is left out.
    """
    beams, returned = reading.beams, reading.returned
    ranges = np.where(returned, reading.ranges, 0.0)
    points = beams.directions * ranges[:, None] + np.array(beams.origin)
    stride = max(1, -(-len(returned) // ENOUGH))
    kept = np.flatnonzero(returned[::stride]) * stride
    normals = _normals(points, returned, (beams.origin, window_of(beams.bearings)), kept)
    weights = np.where((normals != 0.0).any(axis=1), 1.0, UNSURE)
    return Cloud(points[kept], normals, weights, float(returned.mean()) if len(returned) else 0.0)


def window_of(bearings: Floats) -> int:
    """Number of beams within ``WINDOW`` to one side of a beam, at least 3, by bearings (n,) [rad]."""
    if len(bearings) < 2:
        return 3
    return max(3, round(WINDOW / max(float(np.median(np.abs(np.diff(bearings)))), 1e-4)))
