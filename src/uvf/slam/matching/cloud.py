"""A sweep as points with the direction of the surface they lie on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

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
SPACING = 0.25
"""m between points of a surface that sweeps are matched to, at most: farther away beams are wider apart, and would only meet themselves."""
ALIKE, LEVEL = 0.95, 0.1
"""Least cosine between normals of points on one surface, and m by which what lies between them may be off the line."""


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
    goes_on: Mask | None = None
    """(n,) whether the surface goes on to the next point, seen by all beams between them; None where that is not known of any."""

    @property
    def is_scant(self) -> bool:
        """Whether so little of the sweep came back that it may all be things that move."""
        return self.returned < SCANT

    @property
    def is_thin(self) -> bool:
        """Whether less of it came back than tells the heading well."""
        return self.returned < THIN

    @property
    def flat(self) -> Mask:
        """Mask (n,) of the points whose normal is known."""
        known: Mask = (self.normals != 0.0).any(axis=1)
        return known

    def moved(self, a_from_b: Pose2) -> "Cloud":
        """The cloud in frame a."""
        return Cloud(*placed(self.points, self.normals, np.array(a_from_b)), self.weights, goes_on=self.goes_on)

    def chosen(self, mask: Mask) -> "Cloud":
        """Some of the points, by a mask (n,)."""
        goes_on = None if self.goes_on is None else (self.goes_on & np.append(mask[1:], False))[mask]
        return Cloud(self.points[mask], self.normals[mask], self.weights[mask], goes_on=goes_on)

    def filled(self) -> "Cloud":
        """With more points between those that are far apart on one surface."""
        if self.goes_on is None:
            return self
        return Cloud(*_filled(self.points, self.normals, self.weights, self.goes_on))


def joined(clouds: Sequence[Cloud]) -> Cloud:
    """All points of clouds in one frame; ``returned`` is that of the last one."""
    if not clouds:
        return Cloud(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))
    points, normals, weights = (np.concatenate([getattr(c, part) for c in clouds]) for part in ("points", "normals", "weights"))
    goes_on = np.concatenate([np.zeros(len(c.points), dtype=np.bool_) if c.goes_on is None else c.goes_on for c in clouds])
    return Cloud(points, normals, weights, clouds[-1].returned, goes_on)


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
def _normal(points: Floats, returned: Mask, i: int, reach: tuple[int, float]) -> tuple[float, float]:
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
def _gap(points: Floats, returned: Mask, i: int) -> float:
    """m, from point i to the nearer one of the beams beside it; 0 where there is none."""
    gap = np.inf
    for j in (i - 1, i + 1):
        if 0 <= j < points.shape[0] and returned[j]:
            gap = min(gap, np.sqrt((points[j, 0] - points[i, 0]) ** 2 + (points[j, 1] - points[i, 1]) ** 2))
    return gap if gap < np.inf else 0.0


@compiled
def _normals(points: Floats, returned: Mask, view: tuple[tuple[float, float], int], kept: NDArray[np.int64]) -> Floats:
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


@compiled
def _goes_on(points: Floats, returned: Mask, kept: NDArray[np.int64], normals: Floats) -> Mask:
    """(k,) whether the surface of a point that is kept goes on to the next one, by all the beams between them."""
    found = np.zeros(kept.shape[0], dtype=np.bool_)
    for k in range(kept.shape[0] - 1):
        i, j = kept[k], kept[k + 1]
        nx, ny = normals[k]
        dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        if nx * normals[k + 1, 0] + ny * normals[k + 1, 1] < ALIKE or dx * dx + dy * dy > FAR * FAR:
            continue
        found[k] = True
        for m in range(i, j + 1):
            away = (points[m, 0] - points[i, 0]) * nx + (points[m, 1] - points[i, 1]) * ny
            found[k] &= returned[m] and abs(away) < LEVEL
    return found


@compiled
def _filled(points: Floats, normals: Floats, weights: Floats, goes_on: Mask) -> tuple[Floats, Floats, Floats]:
    """The points, and between two on one surface as many more as ``SPACING`` asks for."""
    more = np.zeros(points.shape[0], dtype=np.int64)
    for i in range(points.shape[0] - 1):
        if goes_on[i]:
            dx, dy = points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1]
            more[i] = int(np.sqrt(dx * dx + dy * dy) / SPACING)
    n = points.shape[0] + int(more.sum())
    dense, facing, heavy = np.empty((n, 2)), np.empty((n, 2)), np.empty(n)
    at = 0
    for i in range(points.shape[0]):
        dense[at], facing[at], heavy[at] = points[i], normals[i], weights[i]
        at += 1
        for m in range(more[i]):
            share = (m + 1.0) / (more[i] + 1.0)
            nx, ny = (1.0 - share) * normals[i] + share * normals[i + 1]
            length = np.sqrt(nx * nx + ny * ny)
            dense[at] = (1.0 - share) * points[i] + share * points[i + 1]
            facing[at, 0], facing[at, 1] = nx / length, ny / length
            heavy[at] = min(weights[i], weights[i + 1])
            at += 1
    return dense, facing, heavy


def cloud_of(reading: Reading) -> Cloud:
    """Cloud of what the vehicle's lidars have seen, in the base frame of the first one's reading."""
    own, here = _of_lidar(reading), reading.odom_from_base
    besides = [r for r in reading.others if np.isfinite((*here, *r.odom_from_base)).all()]
    if not besides:
        return own
    clouds = [_of_lidar(r).moved(compose(inverse(here), r.odom_from_base)) for r in besides]
    returned = np.concatenate([r.returned for r in (reading, *besides)])
    return replace(joined([*clouds, own]), returned=float(returned.mean()) if len(returned) else 0.0)


def _of_lidar(reading: Reading) -> Cloud:
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
    share = float(returned.mean()) if len(returned) else 0.0
    return Cloud(points[kept], normals, weights, share, _goes_on(points, returned, kept, normals))


def window_of(bearings: Floats) -> int:
    """Number of beams within ``WINDOW`` to one side of a beam, at least 3, by bearings (n,) [rad]."""
    if len(bearings) < 2:
        return 3
    return max(3, round(WINDOW / max(float(np.median(np.abs(np.diff(bearings)))), 1e-4)))
