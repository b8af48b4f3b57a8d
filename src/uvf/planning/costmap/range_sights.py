"""What sensors other than a planar lidar see of the ground about a vehicle, in the plane: depth cameras and sonars."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]

FLOOR = 0.04  # m: what rises less counts as floor
BEARING = 0.02  # rad, of a sector of a depth picture
ENOUGH = 2
"""Points of a sector, nearest ones first, without which it is taken for noise."""
ARC = 0.04  # m between the beams that stand for a sonar's cone, where they end


class GroundSight(NamedTuple):
    """Ground that was seen along beams [m, base frame]: free from ``starts`` to ``ends`` (n, 2), an obstacle where ``hits`` (n,)."""

    eye: Point
    starts: Floats
    ends: Floats
    hits: Mask


def depth_sight(eye: Point, points: Floats, top: float) -> GroundSight:
    """Of points (n, 3) [m, base frame; z = 0 the floor] that a depth camera sees from above ``eye``: one beam for each bearing.

    What lies between the floor and ``top`` [m] is an obstacle: a pallet below a lidar, a table's edge above it. Ground is free from the
    first floor that is seen; what lies nearer, below the picture, is not told of.
    """
    points = points[points[:, 2] < top]
    away = points[:, :2] - np.array(eye)
    ranges, sectors = np.hypot(*away.T), np.floor(np.arctan2(away[:, 1], away[:, 0]) / BEARING).astype(np.int64)
    order = np.lexsort((ranges, sectors))
    ranges, sectors, floor = ranges[order], sectors[order], points[order, 2] <= FLOOR
    parts = _parts(sectors)
    beams = [_of_sector(ranges[part], floor[part]) for part in parts]
    first, last, hits = (np.array(column) for column in zip(*beams, strict=True)) if beams else (np.zeros(0),) * 3
    middles = (sectors[[part.start for part in parts]] + 0.5) * BEARING
    told = last > 0.0
    rays = np.column_stack((np.cos(middles), np.sin(middles)))[told]
    return GroundSight(eye, np.array(eye) + first[told, None] * rays, np.array(eye) + last[told, None] * rays, hits[told].astype(np.bool_))


def _parts(sectors: NDArray[np.int64]) -> list[slice]:
    """Of sorted sectors, where each one lies."""
    edges = np.flatnonzero(np.diff(sectors)) + 1
    return [slice(a, b) for a, b in zip([0, *edges], [*edges, len(sectors)], strict=True)] if len(sectors) else []


def _of_sector(ranges: Floats, floor: Mask) -> tuple[float, float, bool]:
    """From and up to where [m] the ground is free, and whether an obstacle ends it; (0, 0, False) where nothing can be told."""
    risen, ground = ranges[~floor], ranges[floor]
    hit = len(risen) >= ENOUGH
    if hit:
        ground = ground[ground < risen[ENOUGH - 1]]
        return (float(ground[0]) if len(ground) else float(risen[ENOUGH - 1])), float(risen[ENOUGH - 1]), True
    return (float(ground[0]), float(ground[-1]), False) if len(ground) else (0.0, 0.0, False)


def cone_sight(eye: Point, bearing: float, opening: float, reading: tuple[float, float]) -> GroundSight:
    """Of a sonar that looks along ``bearing`` with an opening angle [rad]: the arc on which the nearest thing lies.

    reading: (range, farthest) [m], the range 0 where nothing is within the farthest.
    """
    distance, farthest = reading
    seen = 0.0 < distance <= farthest
    n = 2 + int(opening * farthest / ARC)
    angles = bearing + opening * np.linspace(-0.5, 0.5, n)
    ends = np.array(eye) + (distance if seen else farthest) * np.column_stack((np.cos(angles), np.sin(angles)))
    return GroundSight(eye, np.tile(np.array(eye), (n, 1)), ends, np.full(n, seen))
