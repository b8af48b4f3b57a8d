"""What sensors other than a planar lidar see of the ground about a vehicle, in the plane: depth cameras and sonars."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]

FLOOR = 0.04  # m: what rises less counts as floor
DROP, STEEP = 0.06, 0.25  # m, m/m: floor that falls by more, and steeper than a ramp of 14 deg may lead down, ends there
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


def depth_sight(eye: tuple[float, float, float], points: Floats, top: float, reach: float) -> GroundSight:
    """Of points (n, 3) [m, base frame; z = 0 the floor] that a depth camera at ``eye`` sees: one beam for each bearing.

    What lies between the floor and ``top`` [m] is an obstacle: a pallet below a lidar, a table's edge above it. So is the edge from which
    the floor drops: there a ray passes that ends at lower ground. Ground is free from the first floor that is seen; what lies nearer,
    below the picture, is not told of, and nothing beyond ``reach`` [m] from the eye, in the plane.
    """
    points = points[points[:, 2] < top]
    away = points[:, :2] - np.array(eye[:2])
    ranges, sectors = np.hypot(*away.T), np.floor(np.arctan2(away[:, 1], away[:, 0]) / BEARING).astype(np.int64)
    above, below = max(eye[2], 0.0), np.maximum(-points[:, 2], 0.0)
    passes = ranges * np.where(below > 0.0, above / (above + below + 1e-9), 1.0)  # through the floor's plane, or where it ends
    order = np.lexsort((ranges, sectors))
    order = order[passes[order] <= reach]
    ranges, sectors, heights = ranges[order], sectors[order], points[order, 2]
    parts = _parts(sectors)
    beams = [_of_sector(ranges[part], heights[part], eye[2]) for part in parts]
    first, last, hits = (np.array(column) for column in zip(*beams, strict=True)) if beams else (np.zeros(0),) * 3
    middles = (sectors[[part.start for part in parts]] + 0.5) * BEARING
    told = last > 0.0
    rays = np.column_stack((np.cos(middles), np.sin(middles)))[told]
    foot = np.array(eye[:2])
    return GroundSight(eye[:2], foot + first[told, None] * rays, foot + last[told, None] * rays, hits[told].astype(np.bool_))


def _parts(sectors: NDArray[np.int64]) -> list[slice]:
    """Of sorted sectors, where each one lies."""
    edges = np.flatnonzero(np.diff(sectors)) + 1
    return [slice(a, b) for a, b in zip([0, *edges], [*edges, len(sectors)], strict=True)] if len(sectors) else []


def _of_sector(ranges: Floats, heights: Floats, eye_height: float) -> tuple[float, float, bool]:
    """From and up to where [m] the ground is free, and whether an obstacle ends it; (0, 0, False) where nothing can be told."""
    floor = heights <= FLOOR
    risen, ground = ranges[~floor], ranges[floor]
    end = min(float(risen[ENOUGH - 1]) if len(risen) >= ENOUGH else np.inf, _edge(ground, heights[floor], eye_height))
    if np.isfinite(end):
        ground = ground[ground < end]
        return (float(ground[0]) if len(ground) else end), end, True
    return (float(ground[0]), float(ground[-1]), False) if len(ground) else (0.0, 0.0, False)


def _edge(ranges: Floats, heights: Floats, eye_height: float) -> float:
    """Range [m] of the first edge from which the floor (n,), nearest first, drops; infinite where there is none.

    Between two points of the floor a slope that is hidden behind its edge falls as much as a drop: it is taken for one where it would be
    steeper than a ramp. The first floor that is seen is compared with that below the eye, on which the vehicle stands.
    """
    r, z = np.concatenate(((0.0,), ranges)), np.concatenate(((0.0,), heights))
    fall = z[:-1] - z[1:]
    for k in np.flatnonzero((fall > DROP) & (fall > STEEP * (r[1:] - r[:-1]))).tolist():
        if (z[k + 1 : k + 1 + ENOUGH] < z[k] - DROP).sum() == ENOUGH:
            passed = r[k + 1] * (eye_height - z[k]) / (eye_height - z[k + 1])  # by the ray that ends at lower ground
            return max(float(passed), float(r[k]))
    return np.inf


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
