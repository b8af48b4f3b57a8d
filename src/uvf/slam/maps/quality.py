"""How good a map is: against the true floor plan, or against another map.

Nothing is aligned here: where the map lies is handed in (by the trajectory, say), so that a map that is warped as a whole
cannot look good by being shifted to where it fits best.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from uvf.maths.se2 import Pose2, compose
from uvf.models.world.geometry import FloorPlan
from uvf.models.world.map_file import GridMap
from uvf.slam.maps.placing import centres, values_at
from uvf.slam.maps.walls import OCCUPIED, WallFigures, WallPoints, beside_free, wall_figures, wall_points

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

TOLERANCES = (0.05, 0.10)  # m
LOOK_OFF = 0.1  # m in front of a surface, which a map has to know to be asked for the surface
GENUINE = 0.5
"""Part of a doubled stretch that the truth has too, from which on it is none."""


@dataclass(frozen=True)
class Detection:
    """How well walls are found within ``tolerance`` [m].

    precision: share of the map's walls that are true ones; recall: share of the true ones that it has.
    """

    tolerance: float
    precision: float
    recall: float

    @property
    def f1(self) -> float:
        """F1 score, 0 to 1: the harmonic mean of precision and recall."""
        total = self.precision + self.recall
        return 2.0 * self.precision * self.recall / total if total else 0.0


@dataclass(frozen=True)
class WallAgreement:
    """Agreement of walls. detections: for each of TOLERANCES.

    to_true, to_map: distances (mean, 95th percentile) [m] from the map's walls to true ones, and back.
    """

    detections: tuple[Detection, ...]
    to_true: tuple[float, float]
    to_map: tuple[float, float]


@dataclass(frozen=True)
class MapScore:
    """Scores of a map. free_iou, occupied_iou: intersection over union, over cells that both know [-].

    unknown: share of the floor that the map lacks [-]; thickness: of its walls [m].
    """

    walls: WallAgreement
    free_iou: float
    occupied_iou: float
    unknown: float
    thickness: float
    double_walls: int


def score(grid: GridMap, plan: FloorPlan, plan_from_map: Pose2, floor: Mask | None = None) -> MapScore:
    """Scores of a map against the truth. plan_from_map: where the map's frame lies in the plan's.

    plan: cells a few times smaller than the map's tell distances well; floor: its cells that could have been seen, else all free ones.
    """
    placed = GridMap(grid.cells, grid.resolution, compose(plan_from_map, grid.origin))
    true = as_grid(plan)
    surface = wall_points(true)
    found = wall_points(placed)
    walls = agreement((found.points, np.ones(len(found.points), dtype=np.bool_)), (surface.points, _seen(surface, placed)))
    truth_here = values_at(true, centres(placed)).reshape(grid.cells.shape)
    free_iou, occupied_iou = overlaps(grid.cells, truth_here)
    rows, columns = np.nonzero(~plan.cells if floor is None else floor)
    x, y = plan.axes()
    unknown = values_at(placed, np.column_stack((x[columns], y[rows]))) < 0
    figures = wall_figures(grid)
    shell = np.where((truth_here > OCCUPIED) & ~beside_free(truth_here), -1, truth_here).astype(np.int8)
    doubles = _ghosts(figures, GridMap(shell, grid.resolution, placed.origin))
    return MapScore(walls, free_iou, occupied_iou, float(unknown.mean()) if len(unknown) else 0.0, figures.thickness, doubles)


def compare(a: GridMap, b: GridMap) -> tuple[WallAgreement, float, float]:
    """(walls of ``a`` against those of ``b`` where each knows the other's place, IoU [-] of free cells, of occupied ones).

    Their origins are in one frame.
    """
    found, others = wall_points(a), wall_points(b)
    walls = agreement((found.points, _seen(found, b)), (others.points, _seen(others, a)))
    return walls, *overlaps(a.cells, values_at(b, centres(a)).reshape(a.cells.shape))


def as_grid(plan: FloorPlan) -> GridMap:
    """The plan as an occupancy grid in which every cell is known."""
    return GridMap(np.where(plan.cells, 100, 0).astype(np.int8), plan.resolution, Pose2(plan.x, plan.y, 0.0))


def agreement(found: tuple[Floats, Mask], true: tuple[Floats, Mask]) -> WallAgreement:
    """Agreement of found with true wall points, each (n, 2) [m] with a mask (n,) of those that count.

    Points that do not count may be matched, but need not be.
    """
    to_true, to_map = _nearest(found[0][found[1]], true[0]), _nearest(true[0][true[1]], found[0])
    detections = tuple(Detection(t, _share(to_true <= t), _share(to_map <= t)) for t in TOLERANCES)
    return WallAgreement(detections, _mean_and_tail(to_true), _mean_and_tail(to_map))


def _seen(walls: WallPoints, grid: GridMap) -> Mask:
    """(n,) whether a map knows the place in front of these walls, and so had to see them."""
    seen: Mask = values_at(grid, walls.points + LOOK_OFF * walls.towards_free) >= 0
    return seen


def overlaps(cells: NDArray[np.int8], others: NDArray[np.int8]) -> tuple[float, float]:
    """Intersection over union [-] of the free and of the occupied cells, over those that both grids (rows, columns) know."""
    known = (cells >= 0) & (others >= 0)
    a, b = cells[known] > OCCUPIED, others[known] > OCCUPIED
    return _share((~a & ~b)[~a | ~b]), _share((a & b)[a | b])


def _ghosts(figures: WallFigures, truth: GridMap) -> int:
    """Doubled stretches, without those that are gaps of the truth as well; the truth's solids are hollow."""
    true_gaps = ndimage.binary_dilation(wall_figures(truth).doubled, iterations=2)
    labels, count = ndimage.label(figures.doubled, np.ones((3, 3)))
    genuine = ndimage.mean(true_gaps, labels, np.arange(1, count + 1)) if count else np.zeros(0)
    return int((np.asarray(genuine) < GENUINE).sum())


def _nearest(points: Floats, others: Floats) -> Floats:
    """(n,) m from each point to the nearest of the others; infinite without any."""
    if len(points) == 0 or len(others) == 0:
        return np.full(len(points), np.inf)
    distances: Floats = cKDTree(others).query(points)[0]
    return distances


def _share(yes: Mask) -> float:
    return float(yes.mean()) if len(yes) else 0.0


def _mean_and_tail(distances: Floats) -> tuple[float, float]:
    if len(distances) == 0:
        return float("nan"), float("nan")
    return float(distances.mean()), float(np.percentile(distances, 95.0))
