"""Correlative scan matching: tries every pose of a window, for when the motion guess is too far off to refine.

Olson, "Real-Time Correlative Scan Matching" (2009), one level: the score of a pose is the mean likelihood of the
scan's points in the field of distances to what is occupied.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.slam.occupancy import OccupancyMap
from uvf.maths.compiled import compiled
from uvf.maths.grids import distance_field
from uvf.maths.planar import Pose2
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """Half sizes and steps of the search."""

    position: float = 0.3  # m
    heading: float = 0.3  # rad
    step: float = 0.05  # m
    turn: float = 0.03  # rad


@compiled
def _best(
    start: tuple[float, float, float], points: Floats, likelihood: Floats, offsets: tuple[Floats, Floats]
) -> tuple[int, int, int, float]:
    """Indices (x, y, heading) into the offsets of the best pose, and its score; all lengths in cells."""
    shifts, turns = offsets
    best, bx, by, bt = -1.0, 0, 0, 0
    rows, columns = likelihood.shape
    n = points.shape[0]
    for k in range(turns.shape[0]):
        c, s = np.cos(start[2] + turns[k]), np.sin(start[2] + turns[k])
        for i in range(shifts.shape[0]):
            for j in range(shifts.shape[0]):
                score = 0.0
                for p in range(n):
                    column = int(np.floor(start[0] + shifts[i] + c * points[p, 0] - s * points[p, 1]))
                    row = int(np.floor(start[1] + shifts[j] + s * points[p, 0] + c * points[p, 1]))
                    if 0 <= row < rows and 0 <= column < columns:
                        score += likelihood[row, column]
                if score > best:
                    best, bx, by, bt = score, i, j, k
    return bx, by, bt, best / max(n, 1)


def search(occupancy: OccupancyMap, start: Pose2, points: Floats, window: Window = Window()) -> tuple[Pose2, float]:
    """(map_from_base, score 0..1) of the best pose around ``start``. points: (n, 2) m, base frame."""
    cell = occupancy.resolution
    likelihood = np.exp(-0.5 * distance_field(occupancy.log_odds > 0.0) ** 2)
    steps = round(window.position / window.step)
    shifts = np.arange(-steps, steps + 1) * window.step / cell
    turns = np.arange(-round(window.heading / window.turn), round(window.heading / window.turn) + 1) * window.turn
    origin = occupancy.origin
    start_cells = ((start[0] - origin[0]) / cell, (start[1] - origin[1]) / cell, start[2])
    i, j, k, score = _best(start_cells, points / cell, likelihood, (shifts, turns))
    return (start[0] + shifts[i] * cell, start[1] + shifts[j] * cell, wrap(start[2] + turns[k])), score
