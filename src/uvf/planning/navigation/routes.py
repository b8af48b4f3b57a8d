"""Routes over what the sensors have seen, for a vehicle without a map: unknown ground is taken for free."""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.planning.costmap.costmap import Cell, Costmap, Frame
from uvf.planning.costmap.inflation import INSCRIBED, NO_INFORMATION
from uvf.planning.local.controller import LocalController
from uvf.planning.navigation.failures import Failure
from uvf.planning.navigation.navigator import NavigationGoal, Route
from uvf.planning.search.grid_search import GridSearch
from uvf.planning.smoothing import resample

Floats = NDArray[np.float64]
Point = tuple[float, float]

INSET = 0.3  # m from the window's border to where a goal beyond it is sought
UNDERFOOT = 0.4  # m of a path's beginning that does not count when it is looked at again: the vehicle stands there


class LayerRoutes:
    """Plans by A* over the obstacle layer of a controller."""

    def __init__(self, controller: LocalController) -> None:
        self._controller = controller
        self._known_free = KnownFree()

    def plan(self, pose: Pose2, goal: NavigationGoal) -> Route:
        """The best path to the goal, or to the place in its direction where the window ends."""
        costs = self._controller.leaving(self._controller.costmap(), pose)
        return self._known_free.judged(one_after_the_other(partial(route_over, costs, self._controller.factors), pose, goal), costs)

    def is_free(self, path: Floats) -> bool:
        """Whether the vehicle's centre may still be everywhere on the path."""
        return still_free(self._controller.costmap(), path)

    def has_room_to_turn(self, pose: Pose2) -> bool:
        """Whether no known obstacle is in the way of turning on the spot."""
        return self._controller.has_room_to_turn(pose)

    def reset(self) -> None:
        """Nothing is known but what the layer holds."""


def one_after_the_other(plan: Callable[[Point, Point], Route], pose: Pose2, goal: NavigationGoal) -> Route:
    """The route through the places on the way to the goal; a place that something stands on is left out.

    plan: from one place to another [m].
    """
    here, paths = (pose[0], pose[1]), []
    for place in goal.via:
        route = plan(here, place)
        if route.failure == Failure.GOAL_OCCUPIED:
            continue
        if route.path is None:
            return route
        paths.append(route.path)
        here = place
    last = plan(here, (goal.x, goal.y))
    return last if last.path is None else Route(np.concatenate((*paths, last.path)))


class KnownFree:
    """Where the last paths led over ground that was known to be free: if an obstacle is there now, it has come, and may leave again."""

    def __init__(self) -> None:
        self._points: Floats = np.zeros((0, 2))

    def judged(self, route: Route, costs: Costmap) -> Route:
        """The route; a failure to find one becomes ``Failure.BLOCKED`` where something has come."""
        cells, inside = cells_of(self._points, costs.frame, costs.values.shape)
        values = costs.values[cells[:, 0], cells[:, 1]]
        taken = self._points[inside][(values >= INSCRIBED) & (values < NO_INFORMATION)]
        if route.path is not None:
            self._points = np.concatenate((taken, _well_known(costs, route.path)))
        elif route.failure == Failure.NO_VALID_PATH and len(taken):
            return Route(None, Failure.BLOCKED)
        return route


def _well_known(costs: Costmap, path: Floats) -> Floats:
    """The points of a path (n, 2) [m] within whose inscribed radius all ground is known: no wall comes into view there later."""
    cells, inside = cells_of(path, costs.frame, costs.values.shape)
    reach = int(np.ceil(costs.footprint.inscribed_radius / costs.resolution))
    around = np.arange(-reach, reach + 1)
    rows, columns = np.array(costs.values.shape)[:, None, None, None] - 1
    patches = costs.values[
        np.clip(cells[:, 0, None, None] + around[:, None], 0, rows), np.clip(cells[:, 1, None, None] + around[None, :], 0, columns)
    ]
    known: Floats = path[inside][(patches != NO_INFORMATION).all(axis=(1, 2))]
    return known


def route_over(costs: Costmap, factors: Floats, here: Point, there: Point) -> Route:
    """The cheapest route by A* over a costmap from here to there [m] or, where that lies beyond, to the border in its direction.

    factors: (256,) cost factors [-] by value.
    """
    start, cell = costs.cell(*here), costs.cell(*there)
    if not costs.holds(start):
        return Route(None, Failure.START_OUTSIDE_MAP)
    if costs.holds(cell) and INSCRIBED <= costs.values[cell] < NO_INFORMATION:
        return Route(None, Failure.GOAL_OCCUPIED)
    at = cell if costs.holds(cell) else _towards(costs, here, there)
    found = GridSearch(costs.values, factors).astar(start, at)
    if found is None:
        return Route(None, Failure.NO_VALID_PATH)
    points = costs.points(found.cells)
    points[0] = here
    if costs.holds(cell):
        points[-1] = there
    return Route(resample(points))


def still_free(costs: Costmap, path: Floats) -> bool:
    """Whether the vehicle's centre may be everywhere on a path (n, 2) [m], but for its very beginning, where the vehicle stands."""
    cells, _ = cells_of(path[np.hypot(*(path - path[0]).T) > UNDERFOOT] if len(path) else path, costs.frame, costs.values.shape)
    values = costs.values[cells[:, 0], cells[:, 1]]
    return not ((values >= INSCRIBED) & (values < NO_INFORMATION)).any()


def cells_of(points: Floats, frame: Frame, shape: tuple[int, ...]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Rows and columns (k, 2) of the points (n, 2) [m] that lie on a grid of a frame and shape, and which ones do (n,)."""
    resolution, origin = frame
    cells = np.floor((points[:, ::-1] - np.array(origin)[::-1]) / resolution).astype(np.int64)
    inside = ((cells >= 0) & (cells < shape)).all(axis=1)
    return cells[inside], inside


def _towards(costs: Costmap, here: Point, there: Point) -> Cell:
    """The cell in the goal's direction where the window ends; if it is not free, the nearest one to it that is."""
    rows, columns = costs.values.shape
    half = np.array((columns, rows)) * costs.resolution / 2 - INSET
    ahead = np.array((there[0] - here[0], there[1] - here[1]))
    ahead = ahead * float((half / np.maximum(np.abs(ahead), 1e-9)).min())
    row, column = costs.cell(here[0] + ahead[0], here[1] + ahead[1])
    row, column = min(max(row, 0), rows - 1), min(max(column, 0), columns - 1)
    open_cells = np.argwhere((costs.values < INSCRIBED) | (costs.values == NO_INFORMATION))
    if not len(open_cells):
        return row, column
    nearest = open_cells[np.argmin(np.hypot(open_cells[:, 0] - row, open_cells[:, 1] - column))]
    return int(nearest[0]), int(nearest[1])
