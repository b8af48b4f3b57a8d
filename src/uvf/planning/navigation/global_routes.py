"""Routes of the global planner on a map that may be wrong, with what the sensors see now on it."""

from collections import deque
from math import ceil, dist

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.grids import distance_field
from uvf.maths.se2 import Pose2, transform
from uvf.planning.costmap.costmap import Frame
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.inflation import FREE_SPACE, LETHAL
from uvf.planning.costmap.obstacle_layer import ObstacleLayer
from uvf.planning.costmap.own_ground import around
from uvf.planning.costmap.shared_map import SharedMap
from uvf.planning.costmap.zone_mask import KEPT_OUT, ZoneMask
from uvf.planning.global_planner import MOST_CELLS, GlobalPlanner
from uvf.planning.navigation.navigator import NavigationGoal, Route
from uvf.planning.navigation.routes import KnownFree, cells_of, one_after_the_other, still_free

Floats = NDArray[np.float64]
Cells = NDArray[np.int8]

Point = tuple[float, float]

AROUND = 5.5  # m
DRIVEN_EVERY, DRIVEN_MOST = 0.1, 10_000  # m between two places at which the vehicle has been, and how many of them are kept
OCCUPIED = 65  # per cent, from which on a cell of the map is an obstacle
WALL = np.ones((3, 3), dtype=np.bool_)


class GlobalRoutes:
    """Plans on an occupancy grid with the obstacles of a layer on it, whose poses are in the map's frame.

    allow_unknown: as in ``GlobalPlanner.plan``. After ``reset`` what the sensors see free counts more than what the map shows: a map
    that was drawn with something in the way does not shut it for ever.
    """

    def __init__(self, planner: GlobalPlanner, layer: ObstacleLayer, hidden: HiddenObstacles) -> None:
        self.allow_unknown = False
        self._planner, self._layer, self._hidden = planner, layer, hidden
        self._drawn: tuple[Cells, Frame] | None = None
        self._map: tuple[Cells, Frame] | None = None
        """The map as it was drawn, and with what is to be kept out of."""
        self._walls: NDArray[np.bool_] = np.zeros((0, 0), dtype=np.bool_)
        self._trusts_sight = False
        self._known_free = KnownFree()
        self._keep_out: tuple[ZoneMask, Pose2] | None = None
        self._shared: SharedMap | None = None
        self.shared_is_too_large = False
        """Whether another vehicle's map is left out, because both maps together have too many cells."""
        self._shown: bytes | None = None
        self._given: tuple[Cells, Frame] | None = None
        self._driven: deque[Point] = deque(maxlen=DRIVEN_MOST)

    def drive(self, here: Point) -> None:
        """The vehicle is at ``here`` [m]."""
        if not self._driven or dist(here, self._driven[-1]) >= DRIVEN_EVERY:
            self._driven.append(here)

    def keep_out(self, mask: ZoneMask, mask_from_map: Pose2) -> None:
        """From now on the vehicle is not to drive where the mask says so."""
        self._keep_out = mask, mask_from_map
        if self._drawn is not None:
            self.take(*self._drawn)

    def share(self, shared: SharedMap | None) -> None:
        """From now on another vehicle's map lies below the own one, unless both together are too large to plan on; None: none does."""
        self._shared, self.shared_is_too_large = shared, False
        if self._drawn is not None:
            self.take(*self._drawn)

    def take(self, cells: Cells, frame: Frame) -> None:
        """A new map, (rows, columns) of -1 unknown, 0..100 per cent; frame: resolution [m] and origin [m]."""
        self._drawn, self._shown = (cells, frame), None
        if self._shared is not None and cells.size:
            self.shared_is_too_large = self._shared.cells_with(cells.shape, frame) > MOST_CELLS
            if not self.shared_is_too_large:
                radius = self._planner.body.footprint.circumscribed_radius
                cells, frame = self._shared.below(cells, frame, np.array(self._driven).reshape(-1, 2), radius)
        cells = self._kept_out(cells, frame)
        self._map = cells, frame
        self._walls = ndimage.binary_dilation(cells >= OCCUPIED, WALL)

    def look(self, here: Point) -> bool:
        """Gives the planner the map with what is seen from ``here`` [m]; whether that is another one than before."""
        if self._map is None:
            return False
        cells, frame = self._map
        lethal = cells_of(np.concatenate((self._centres(LETHAL), self._hidden.touched)), frame, cells.shape)[0]
        lethal = lethal[~self._walls[lethal[:, 0], lethal[:, 1]]]  # a wall of the map is where the map has it
        free = cells_of(self._centres(FREE_SPACE), frame, cells.shape)[0] if self._trusts_sight else lethal[:0]
        shown = lethal.tobytes() + free.tobytes()
        changed = False
        if shown != self._shown:
            self._shown, cells = shown, cells.copy()
            cells[free[:, 0], free[:, 1]] = 0
            cells[lethal[:, 0], lethal[:, 1]] = 100
            changed = self._given is None or frame != self._given[1] or not np.array_equal(cells, self._given[0])
            if changed:  # most of what is seen free is free in the map, too
                self._given = cells, frame
                self._planner.see(cells, frame)
        return self._planner.stand(here) | changed

    def plan(self, pose: Pose2, goal: NavigationGoal) -> Route:
        """The best path to the goal."""
        self.look((pose[0], pose[1]))
        route = one_after_the_other(self._between, pose, goal)
        return route if self._planner.costs is None else self._known_free.judged(route, self._planner.costs)

    def _between(self, here: Point, there: Point) -> Route:
        planned = self._planner.plan(here, there, self.allow_unknown)
        return Route(planned.path, planned.failure, planned.reason)

    def is_free(self, path: Floats) -> bool:
        """Whether the vehicle's centre may still be everywhere on the path."""
        body, costs = self._planner.body, self._planner.costs
        return still_free(self._layer.costmap(body.footprint, body.inflation), path) and (costs is None or still_free(costs, path))

    def has_room_to_turn(self, pose: Pose2) -> bool:
        """Whether no known obstacle is in the way of turning on the spot."""
        return self._layer.has_room((pose[0], pose[1]), self._planner.body.footprint.circumscribed_radius)

    def map_clearance(self, path: Floats, team: Floats) -> Floats:
        """(n,) m from the points of a path (n, 2) [m] to the nearest obstacle of the map, ``AROUND`` or more where none is near.

        Without what only the sensors see, and without the team's vehicles (k, 3), x, y and radius [m]: where one stands for a while the
        map shows it.
        """
        out = np.full(len(path), np.inf)
        if self._map is None:
            return out
        cells, frame = self._map
        at, inside = cells_of(path, frame, cells.shape)
        if not len(at):
            return out
        reach = ceil(AROUND / frame[0])
        first, last = np.maximum(at.min(axis=0) - reach, 0), at.max(axis=0) + reach + 1
        taken = cells[first[0] : last[0], first[1] : last[1]] >= OCCUPIED
        rows, columns = np.indices(taken.shape, sparse=True)
        for row, column, radius in _within(team, frame, first, taken.shape):
            window = around((int(row), int(column)), ceil(radius) + 1)
            taken[window][np.hypot(rows[window[0]] - row, columns[:, window[1]] - column) <= radius] = False
        out[inside] = ((distance_field(taken) - 0.5) * frame[0])[tuple((at - first).T)]
        return out

    def reset(self) -> None:
        """From now on what is seen free is free."""
        self._trusts_sight = True

    def _kept_out(self, cells: Cells, frame: Frame) -> Cells:
        """The map with obstacles where the mask keeps out."""
        if self._keep_out is None or not cells.size:
            return cells
        (mask, mask_from_map), (resolution, (x, y)) = self._keep_out, frame
        rows, columns = np.indices(cells.shape).reshape(2, -1)
        centres = np.column_stack(((columns + 0.5) * resolution + x, (rows + 0.5) * resolution + y))
        out = (mask.at(transform(mask_from_map, centres)) >= KEPT_OUT).reshape(cells.shape)
        return np.where(out, np.int8(100), cells)

    def _centres(self, value: int) -> Floats:
        """(n, 2) m centres of the layer's cells of a value."""
        out: Floats = (np.argwhere(self._layer.cells == value)[:, ::-1] + 0.5) * self._layer.resolution + np.array(self._layer.origin)
        return out


def _within(discs: Floats, frame: Frame, first: NDArray[np.int64], shape: tuple[int, ...]) -> list[list[float]]:
    """Row, column and radius [cells] of those of the discs (k, 3) [m] that reach into a window of the map that begins at ``first``."""
    middles = (discs[:, 1::-1] - frame[1][::-1]) / frame[0] - 0.5 - first
    radii = discs[:, 2:] / frame[0]
    near = ((middles > -radii - 1) & (middles < shape + radii)).all(axis=1)
    found: list[list[float]] = np.hstack((middles, radii))[near].tolist()
    return found
