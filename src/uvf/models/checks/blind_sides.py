"""Where a vehicle's lidars together do not see what stands close by."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_euler, matrix
from uvf.models.vehicle.sensors import Lidar

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

BESIDE = 0.2  # m from the outline, at which something stands
DIRECTIONS = 180  # about the vehicle, in which it is looked for
SMALL = 8  # directions side by side; a gap of less is a post of the vehicle before the beams


def blind_sides(outline: Floats, lidars: Sequence[tuple[Lidar, Mask]]) -> list[tuple[float, float]]:
    """(first, last) bearing [rad, counter-clockwise from ahead] of each side on which nothing is seen 0.2 m beside the vehicle.

    None where nothing is seen on any side: that is another fault.

    outline: (n, 2) [m, base frame], counter-clockwise; lidars: with masks (beams,) of those that end on the vehicle itself.
    """
    bearings = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    ahead = np.column_stack((np.cos(bearings), np.sin(bearings)))
    points = ahead * (_reach(outline, ahead) + BESIDE)[:, None]
    unseen = ~np.any([_sees(lidar, met, points) for lidar, met in lidars], axis=0)
    if unseen.all() or not unseen.any():
        return []
    first = int(np.argmin(unseen))  # begins where something is seen, so that no side is cut in two
    turned = np.roll(unseen, -first).astype(np.int8)
    edges = np.diff(np.concatenate(([0], turned, [0])))
    runs = zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
    return [(float(bearings[(a + first) % DIRECTIONS]), float(bearings[(b - 1 + first) % DIRECTIONS])) for a, b in runs if b - a >= SMALL]


def _reach(outline: Floats, directions: Floats) -> Floats:
    """(m,) m from base_link to the outline in directions (m, 2)."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.column_stack((edges[:, 1], -edges[:, 0]))
    offsets = (normals * outline).sum(axis=1)
    towards = directions @ normals.T
    with np.errstate(divide="ignore"):
        found: Floats = np.where(towards > 1e-12, offsets / np.maximum(towards, 1e-12), np.inf).min(axis=1)
    return found


def _sees(lidar: Lidar, met: Mask, points: Floats) -> Mask:
    """(n,) whether a beam passes by each of the points (n, 2), base frame."""
    axes = matrix(from_euler(*lidar.mount.rpy))[:2, :2]
    seen_from = (points - np.array(lidar.mount.xyz[:2])) @ axes
    ranges, turn = np.hypot(*seen_from.T), 2 * np.pi
    beam = np.mod(np.arctan2(seen_from[:, 1], seen_from[:, 0]) - lidar.angle_min, turn) / lidar.angle_increment
    nearest = np.round(beam).astype(np.int64)
    nearest = np.where(np.abs(beam - turn / lidar.angle_increment) < 0.5, 0, nearest)
    held: Mask = nearest < lidar.beams
    held &= (ranges > lidar.range_min) & (ranges < lidar.range_max)
    held &= ~met[np.minimum(nearest, lidar.beams - 1)]
    return held
