"""Whether a vehicle's whole outline is free at a pose between the cells' centres: mostly one look-up, near obstacles the exact test.

Poses are x and y in cells (the cell is their whole part: x the column, y the row) and a yaw [rad].
"""

from math import ceil, cos, floor, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.headings import Bits, blocked_headings, heading_bin
from uvf.planning.costmap.inflation import LETHAL

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]

HALF_CELL = 0.5
"""Cells, by which the outline is widened: what a map shows as occupied may lie anywhere in its cell, as ``make_costmap`` has it."""
OFF_CENTRE = sqrt(0.5)  # cells, from a cell's centre to its farthest point


class PoseCheck(NamedTuple):
    """``values`` (rows, columns) and their ``factors`` (256,); ``near`` (rows, columns) bits of headings in which an obstacle may be
    touched from somewhere in the cell; ``sides`` (n, 3) of the outline, normal and distance [cells]; ``reach`` [cells] of the outline."""

    values: Bytes
    factors: Floats
    near: Bits
    sides: Floats
    reach: int


def pose_check(costs: Costmap, factors: Floats) -> PoseCheck:
    """What is needed to check poses of the costmap's own footprint on it."""
    resolution, footprint = costs.resolution, costs.footprint
    near = blocked_headings(costs.values == LETHAL, resolution, footprint.padded((HALF_CELL + OFF_CENTRE) * resolution))
    sides = footprint.sides()
    sides[:, 2] /= resolution
    reach = ceil(footprint.circumscribed_radius / resolution + 2.0 * HALF_CELL) + 1
    return PoseCheck(np.ascontiguousarray(costs.values), factors, near, np.ascontiguousarray(sides), reach)


@compiled
def touches(check: PoseCheck, x: float, y: float, yaw: float, margin: float) -> bool:
    """Whether the outline, widened by ``margin`` [cells], covers an occupied cell's centre."""
    rows, columns = check.values.shape
    row, column, c, s = floor(y), floor(x), cos(yaw), sin(yaw)
    for r in range(max(row - check.reach, 0), min(row + check.reach + 1, rows)):
        for k in range(max(column - check.reach, 0), min(column + check.reach + 1, columns)):
            if check.values[r, k] != LETHAL:
                continue
            dx, dy = k + 0.5 - x, r + 0.5 - y
            ahead, aside = c * dx + s * dy, c * dy - s * dx
            inside = True
            for i in range(check.sides.shape[0]):
                if check.sides[i, 0] * ahead + check.sides[i, 1] * aside > check.sides[i, 2] + margin:
                    inside = False
                    break
            if inside:
                return True
    return False


@compiled
def price_at(check: PoseCheck, x: float, y: float, yaw: float, margin: float) -> float:
    """Cost factor of a pose; negative where the vehicle cannot be."""
    rows, columns = check.values.shape
    row, column = floor(y), floor(x)
    if not (0 <= row < rows and 0 <= column < columns):
        return -1.0
    price: float = check.factors[check.values[row, column]]
    if price < 0.0:
        return -1.0
    shut = (check.near[row, column] >> np.uint64(heading_bin(yaw))) & np.uint64(1)
    return -1.0 if shut != np.uint64(0) and touches(check, x, y, yaw, margin) else price
