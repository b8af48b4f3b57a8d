"""Correlative scan matching: tries every pose of a window, for when the motion guess is too far off to refine.

Olson, "Real-Time Correlative Scan Matching" (2009), one level: the score of a pose is the mean likelihood of the
scan's points in the field of distances to what is occupied.
"""

import numpy as np
from numpy.typing import NDArray

from services.slam.occupancy import OccupancyMap
from uvf.maths.compiled import compiled
from uvf.maths.grids import distance_field
from uvf.maths.planar import Pose2
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]


REACH, STEP = 0.3, 0.05  # m, half the window's side and its grid
TURN_REACH, TURN_STEP = 0.3, 0.03  # rad


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


def search(occupancy: OccupancyMap, start: Pose2, points: Floats) -> tuple[Pose2, float]:
    """(map_from_base, score 0..1) of the best pose around ``start``. points: (n, 2) m, base frame."""
    cell = occupancy.resolution
    likelihood = np.exp(-0.5 * distance_field(occupancy.log_odds > 0.0) ** 2)
    shifts: Floats = _offsets(REACH, STEP) / cell
    turns = _offsets(TURN_REACH, TURN_STEP)
    origin = occupancy.origin
    start_cells = ((start[0] - origin[0]) / cell, (start[1] - origin[1]) / cell, start[2])
    i, j, k, score = _best(start_cells, points / cell, likelihood, (shifts, turns))
    return Pose2(start[0] + shifts[i] * cell, start[1] + shifts[j] * cell, wrap(start[2] + turns[k])), score


def _offsets(reach: float, step: float) -> Floats:
    """Evenly spaced, symmetric about zero."""
    n = round(reach / step)
    return np.linspace(-n * step, n * step, 2 * n + 1)
