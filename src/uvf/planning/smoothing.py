"""From a path of cells to one that a vehicle likes to follow: resampled, rounded, no nearer to obstacles than allowed."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Costmap

Floats = NDArray[np.float64]

SPACING = 0.1  # m between the points
ROUNDS = 60
FIDELITY, TENSION = 0.05, 0.45
"""Pull to the original point, and to the middle of the neighbours, per round."""


def way_along(points: Floats) -> Floats:
    """(n,) m of the way along a polyline (n, 2) [m] to each of its points."""
    out = np.zeros(len(points))
    np.cumsum(np.hypot(*np.diff(points, axis=0).T), out=out[1:])
    return out


def resample(points: Floats, spacing: float = SPACING) -> Floats:
    """Points (m, 2) [m] of the same polyline as (n, 2) at even distances of about ``spacing`` [m], ends kept."""
    if len(points) < 2:
        return points
    lengths = way_along(points)
    n = max(int(np.ceil(lengths[-1] / spacing)), 1)
    at = np.linspace(0.0, lengths[-1], n + 1)
    return np.column_stack((np.interp(at, lengths, points[:, 0]), np.interp(at, lengths, points[:, 1])))


@compiled
def _relax(points: Floats, distance: Floats, frame: tuple[float, float, float], least: float) -> Floats:
    """Gradient smoothing (Thrun 2012): each point towards its neighbours' middle, unless it is nearer than ``least`` [cells] there."""
    x0, y0, resolution = frame
    smooth = points.copy()
    rows, columns = distance.shape
    for _ in range(ROUNDS):
        for i in range(1, points.shape[0] - 1):
            x = smooth[i, 0] + FIDELITY * (points[i, 0] - smooth[i, 0])
            y = smooth[i, 1] + FIDELITY * (points[i, 1] - smooth[i, 1])
            x += TENSION * (0.5 * (smooth[i - 1, 0] + smooth[i + 1, 0]) - x)
            y += TENSION * (0.5 * (smooth[i - 1, 1] + smooth[i + 1, 1]) - y)
            r, c = int(np.floor((y - y0) / resolution)), int(np.floor((x - x0) / resolution))
            if 0 <= r < rows and 0 <= c < columns and distance[r, c] >= least:
                smooth[i, 0], smooth[i, 1] = x, y
    return smooth


def smoothed(points: Floats, costs: Costmap, least: float) -> Floats:
    """The polyline (n, 2) [m, map frame] resampled and rounded, (m, 2) points.

    least: [m], no point is moved to where its clearance is less.
    """
    return _relax(resample(points), costs.distance, (*costs.origin, costs.resolution), least / costs.resolution + 0.5)


def length(points: Floats) -> float:
    """Length [m] of a polyline (n, 2) [m]."""
    return float(np.hypot(*np.diff(points, axis=0).T).sum()) if len(points) > 1 else 0.0


def first_part(points: Floats, way: float) -> Floats:
    """The beginning of a polyline (n, 2) [m], ``way`` [m] long; its first point at least."""
    if len(points) < 2:
        return points
    along = way_along(points)
    if way <= 0.0 or way >= along[-1]:
        return points[:1] if way <= 0.0 else points
    end = [np.interp(way, along, points[:, k]) for k in (0, 1)]
    return np.vstack((points[along < way], end))


def from_place(points: Floats, place: tuple[float, float]) -> tuple[Floats, float]:
    """The rest (m, 2) [m] of a polyline (n, 2) from a vehicle's place on, which comes first; and the length [m] of what is left out."""
    if not len(points):
        return points, 0.0
    nearest = int(np.argmin(np.hypot(points[:, 0] - place[0], points[:, 1] - place[1])))
    return np.vstack((place, points[nearest + 1 :])), length(points[: nearest + 1])
