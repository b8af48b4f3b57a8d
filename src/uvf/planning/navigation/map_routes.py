"""Routes on a known map, with what the sensors see besides; the map may be wrong."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.planning.costmap.costmap import Costmap, Frame, make_costmap
from uvf.planning.costmap.inflation import FREE_SPACE, LETHAL
from uvf.planning.local.controller import LocalController
from uvf.planning.navigation.failures import Failure
from uvf.planning.navigation.navigator import NavigationGoal, Route
from uvf.planning.navigation.routes import KnownFree, route_over, still_free

Floats = NDArray[np.float64]
Cells = NDArray[np.int8]


class MapRoutes:
    """Plans by A* on an occupancy grid (rows, columns) of -1 unknown, 0..100 per cent, with the obstacles of a controller's layer on it.

    Poses are in the map's frame, as the controller's are. Unknown ground is impassable. After ``reset`` what the sensors see
    free counts more than what the map shows: a map that was drawn with something in the way does not shut it for ever.
    """

    def __init__(self, cells: Cells, frame: Frame, controller: LocalController) -> None:
        self._cells, self._frame, self._controller = cells, frame, controller
        self._trusts_sight = False
        self._known_free = KnownFree()

    def plan(self, pose: Pose2, goal: NavigationGoal) -> Route:
        """The best path to the goal."""
        costs = self._controller.leaving(self._costmap(), pose)
        if not costs.holds(costs.cell(goal.x, goal.y)):
            return Route(None, Failure.GOAL_OUTSIDE_MAP)
        factors = self._controller.factors.copy()
        factors[-1] = -1.0
        return self._known_free.judged(route_over(costs, factors, pose, goal), costs)

    def is_free(self, path: Floats) -> bool:
        """Whether the vehicle's centre may still be everywhere on the path."""
        return still_free(self._costmap(), path)

    def has_room_to_turn(self, pose: Pose2) -> bool:
        """Whether no known obstacle is in the way of turning on the spot."""
        return self._controller.has_room_to_turn(pose)

    def reset(self) -> None:
        """From now on what is seen free is free."""
        self._trusts_sight = True

    def _costmap(self) -> Costmap:
        """The map with what is seen."""
        cells, layer = self._cells.copy(), self._controller.layer
        resolution, origin = self._frame
        rows, columns = np.indices(layer.cells.shape)
        x = (columns + 0.5) * layer.resolution + layer.origin[0]
        y = (rows + 0.5) * layer.resolution + layer.origin[1]
        r, c = (np.floor((v - o) / resolution).astype(np.int64) for v, o in ((y, origin[1]), (x, origin[0])))
        inside = (r >= 0) & (c >= 0) & (r < cells.shape[0]) & (c < cells.shape[1])
        if self._trusts_sight:
            free = inside & (layer.cells == FREE_SPACE)
            cells[r[free], c[free]] = 0
        lethal = inside & (layer.cells == LETHAL)
        cells[r[lethal], c[lethal]] = 100
        settings = self._controller.settings
        return make_costmap(cells, self._frame, self._controller.footprint.padded(settings.margin), settings.inflation)
