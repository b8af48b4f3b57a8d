"""What floor a body of any outline can come to: its poses on the plan, in cells and headings, that hang together from a start."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, signal
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from uvf.maths.se2 import Pose2
from uvf.models.world.geometry import FloorPlan

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

HEADINGS = 16
"""Of a whole turn. Between two of them the outline's corners pass over less than a fifth of their distance from the centre."""


def covered_floor(plan: FloorPlan, start: Pose2, outline: Floats) -> Mask:
    """Floor (rows, columns) that a body can cover which starts at a pose [m, rad, world] and may move and turn in every way.

    outline: (n, 2) [m] convex, anticlockwise, about its place. Empty where it does not fit at the start.
    """
    shapes = [_shape(outline, 2 * np.pi * k / HEADINGS, plan.resolution) for k in range(HEADINGS)]
    free = np.stack([~_spread(plan.cells, shape[::-1, ::-1]) for shape in shapes])
    row, column = plan.cell(start.x, start.y)
    if not (0 <= row < plan.cells.shape[0] and 0 <= column < plan.cells.shape[1]):
        return np.zeros_like(plan.cells)
    numbers = _numbered(free)
    nearest = round(start.yaw / (2 * np.pi / HEADINGS))
    here = {int(numbers[k % HEADINGS, row, column]) for k in (nearest, nearest - 1, nearest + 1)} - {0}
    poses = np.isin(numbers, list(here))
    covered = np.zeros_like(plan.cells)
    for places, shape in zip(poses, shapes, strict=True):
        if places.any():
            covered |= _spread(places, shape)
    return covered & ~plan.cells


def _shape(outline: Floats, heading: float, resolution: float) -> Mask:
    """Cells whose middle lies in the turned outline, about the cell in the middle."""
    c, s = np.cos(heading), np.sin(heading)
    corners = outline @ np.array(((c, s), (-s, c)))
    reach = int(np.ceil(np.abs(corners).max() / resolution))
    along = np.arange(-reach, reach + 1) * resolution
    x, y = np.meshgrid(along, along)
    inside = np.ones(x.shape, dtype=np.bool_)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0
    inside[reach, reach] = True
    return inside


def _spread(cells: Mask, shape: Mask) -> Mask:
    """Where the shape lies on cells, put on each."""
    wide: Mask = signal.oaconvolve(cells.astype(np.float32), shape.astype(np.float32), mode="same") > 0.5
    return wide


def _numbered(free: Mask) -> NDArray[np.int32]:
    """Poses (headings, rows, columns) that hang together, by numbers from 1; 0 where the body does not fit. Headings go round."""
    numbers, count = ndimage.label(free)
    last, first = numbers[-1], numbers[0]
    both = (last > 0) & (first > 0)
    pairs = coo_array((np.ones(int(both.sum())), (last[both], first[both])), shape=(count + 1, count + 1))
    joined: NDArray[np.int32] = connected_components(pairs, directed=False)[1].astype(np.int32)[numbers]
    return np.where(free, joined + 1, 0).astype(np.int32)
