"""Whether long straight walls are straight in a map, and long distances as long as they are.

What distances to the nearest wall cannot tell: a corridor that bends by a degree looks sharp, and fits everywhere nearly.
0.3 degrees over 50 m are less than a cell in the middle, so it is measured on the points that the beams have hit.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose, transform
from uvf.models.world.geometry import FloorPlan
from uvf.slam.maps.placing import values_at
from uvf.slam.maps.quality import as_grid
from uvf.slam.maps.walls import WallPoints
from uvf.slam.method import Keyframe

Floats = NDArray[np.float64]

LONG = 10.0  # m, least length of a wall, and of a span, that is judged
BENDABLE = 20.0  # m, shorter ones tell no bend: a millimetre in the middle of 10 m would be 0.2 degrees over 50 m
OPENING = 3.0  # m, doors and the like that do not end a wall
SAME_LINE = 0.02  # m
SAME_DIRECTION = 0.003  # rad
REACH = 0.5  # m from a true wall, within which points are taken for it
SAME_SIDE = 0.1  # least cosine between the direction in which the true wall is free and the one it was seen from
SEEN = 0.5
"""Part of the metres between the first point and the last that have to have some: what runs across a wall that nobody saw is none of it."""
BASE = 50.0  # m, over which bends are given
ROUNDS = 10


@dataclass(frozen=True)
class StraightWall:
    """start (2,), along (2,), towards_free (2,) unit vectors; length [m]."""

    start: Floats
    along: Floats
    towards_free: Floats
    length: float


@dataclass(frozen=True)
class Straightness:
    """bend: largest turn of a wall's direction over BASE metres [rad]; scale: how much too long the spans are, in all and worst.

    walls, spans: how many of each could be judged; bend and scale are nan where none was long enough for them.
    """

    bend: float
    walls: int
    scale: float
    worst_scale: float
    spans: int


def hit_points(keyframes: Iterable[Keyframe], plan_from_map: Pose2) -> WallPoints:
    """What the beams of keyframes have hit, and where they came from, in the plan's frame."""
    points, towards = [np.zeros((0, 2))], [np.zeros((0, 2))]
    for keyframe in keyframes:
        reading, beams = keyframe.reading, keyframe.reading.beams
        plan_from_base = compose(plan_from_map, keyframe.map_from_base)
        rays = beams.directions[reading.returned]
        points.append(transform(plan_from_base, rays * reading.ranges[reading.returned, None] + np.array(beams.origin)))
        towards.append(transform(Pose2(0.0, 0.0, plan_from_base.yaw), -rays))
    return WallPoints(np.concatenate(points), np.concatenate(towards))


def straight_walls(segments: Floats, plan: FloorPlan | None = None) -> list[StraightWall]:
    """Outlines (n, 2, 2) [m] that lie on one line, joined over openings; those of at least LONG.

    plan: says which side is free; None: both are, of walls without thickness. Then what stands parallel within REACH behind
    one may be taken for its other side: bends still hold, the worst span may not.
    """
    faces = list(_faces(segments, plan))
    walls: list[StraightWall] = []
    while faces:
        first = faces[0]
        same = [face for face in faces if _on_one_line(first, face)]
        faces = [face for face in faces if not _on_one_line(first, face)]
        walls += _joined(first, same)
    return [wall for wall in walls if wall.length >= LONG]


def straightness(found: WallPoints, walls: Sequence[StraightWall]) -> Straightness:
    """Of the points that beams have hit, in the frame of the true walls."""
    bends: list[float] = []
    judged: list[tuple[StraightWall, float]] = []
    for wall in walls:
        along, aside = _points_of(found, wall)
        if _seen_length(along) < LONG:
            continue
        bends += _bend(along, aside)
        judged.append((wall, _offset(aside)))
    errors = np.array(list(_spans(judged))).reshape(-1, 2)
    if len(errors) == 0:
        return Straightness(max(bends, default=np.nan), len(judged), np.nan, np.nan, 0)
    shares = errors[:, 0] / errors[:, 1]
    worst = float(shares[np.argmax(np.abs(shares))])
    return Straightness(max(bends, default=np.nan), len(judged), float(errors[:, 0].sum() / errors[:, 1].sum()), worst, len(errors))


def _faces(segments: Floats, plan: FloorPlan | None) -> Iterator[StraightWall]:
    """The segments by each side that is free, running so that it is to the left."""
    ends = segments[:, 1] - segments[:, 0]
    lengths = np.hypot(ends[:, 0], ends[:, 1])
    some = lengths > SAME_LINE
    starts, ends, lengths = segments[some, 0], ends[some], lengths[some]
    along = ends / lengths[:, None]
    left = np.column_stack((-along[:, 1], along[:, 0]))
    free_left = free_right = np.ones(len(lengths), dtype=np.bool_)
    if plan is not None:
        grid, middles, off = as_grid(plan), starts + ends / 2.0, 2.0 * plan.resolution
        free_left, free_right = (values_at(grid, middles + side * off * left) == 0 for side in (1.0, -1.0))
        free_left, free_right = free_left & ~free_right, free_right & ~free_left
    for i in range(len(lengths)):
        if free_left[i]:
            yield StraightWall(starts[i], along[i], left[i], float(lengths[i]))
        if free_right[i]:
            yield StraightWall(starts[i] + ends[i], -along[i], -left[i], float(lengths[i]))


def _on_one_line(a: StraightWall, b: StraightWall) -> bool:
    turn = abs(a.along[0] * b.along[1] - a.along[1] * b.along[0])
    aside = max(abs(float((b.start + s * b.along - a.start) @ a.towards_free)) for s in (0.0, b.length))
    return bool(a.towards_free @ b.towards_free > 0.0 and turn < SAME_DIRECTION and aside < SAME_LINE)


def _joined(line: StraightWall, faces: Sequence[StraightWall]) -> Iterator[StraightWall]:
    """The stretches that faces on one line make together."""
    stretches = sorted((float((face.start - line.start) @ line.along), face.length) for face in faces)
    low, high = stretches[0][0], sum(stretches[0])
    for start, length in stretches[1:]:
        if start > high + OPENING:
            yield StraightWall(line.start + low * line.along, line.along, line.towards_free, high - low)
            low = start
        high = max(high, start + length)
    yield StraightWall(line.start + low * line.along, line.along, line.towards_free, high - low)


def _points_of(found: WallPoints, wall: StraightWall) -> tuple[Floats, Floats]:
    """Where along the wall and how far in front of it the points on it lie [m]."""
    relative = found.points - wall.start
    along, aside = relative @ wall.along, relative @ wall.towards_free
    chosen = (np.abs(aside) < REACH) & (along > 0.0) & (along < wall.length) & (found.towards_free @ wall.towards_free > SAME_SIDE)
    return along[chosen], aside[chosen]


def _seen_length(along: Floats) -> float:
    """m from the first point to the last, 0 when too few of the metres between have any."""
    if len(along) == 0 or len(np.unique(np.floor(along))) < SEEN * np.ptp(along):
        return 0.0
    return float(np.ptp(along))


def _bend(along: Floats, aside: Floats) -> Iterator[float]:
    """Turn [rad] over BASE metres, in overlapping windows of that length: the curvature of a robust parabola."""
    for start in np.arange(along.min(), max(along.max() - BASE, along.min()) + 1e-9, BASE / 2.0):
        here = (along >= start) & (along <= start + BASE)
        if _seen_length(along[here]) >= BENDABLE:
            yield abs(2.0 * _parabola(along[here] - start, aside[here])) * BASE


def _offset(aside: Floats) -> float:
    """m, where most of the points lie; niches do not count."""
    near = aside
    for width in (0.1, 0.05):
        near = aside[np.abs(aside - np.partition(near, len(near) // 2)[len(near) // 2]) < width]
    return float(near.mean())


def _parabola(s: Floats, y: Floats) -> float:
    """Coefficient of s^2, points far off left out by Tukey's weights: niches and furniture are no bend."""
    terms = np.column_stack((np.ones_like(s), s, s * s))
    weights = np.ones_like(s)
    fit = np.zeros(3)
    for _ in range(ROUNDS):
        root = np.sqrt(weights)[:, None]
        fit = np.linalg.lstsq(terms * root, y * root[:, 0], rcond=None)[0]
        residual = np.abs(y - terms @ fit)
        limit = 4.685 * max(1.4826 * float(np.median(residual)), 0.01)
        weights = np.where(residual < limit, (1.0 - (residual / limit) ** 2) ** 2, 0.0)
    return float(fit[2])


def _spans(judged: Sequence[tuple[StraightWall, float]]) -> Iterator[tuple[float, float]]:
    """(too long by, length) [m] of the distances between parallel walls of at least LONG."""
    for (a, aside_a), (b, aside_b) in combinations(judged, 2):
        if abs(a.along[0] * b.along[1] - a.along[1] * b.along[0]) > SAME_DIRECTION:
            continue
        apart = float((a.start - b.start) @ b.towards_free)
        if abs(apart) >= LONG:
            way = np.sign(apart)
            yield float(way * (aside_a * (a.towards_free @ b.towards_free) - aside_b)), abs(apart)
