"""What a planner knows of its vehicle's ground: map, masks, and what the sensors see that the map does not show."""

from collections.abc import Sequence
from math import inf

import numpy as np

from schemas.messages import Grid, LaserScan, PoseInFrame
from services.planner.lent_maps import LentMaps
from services.planner.masks import MaskReader
from services.planner.obstacle_sensors import ObstacleSensors, OtherReadings
from uvf.maths.se2 import Pose2, compose, inverse, transform
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.costmap.terrain import TerrainLimits
from uvf.planning.global_planner import GlobalPlanner
from uvf.planning.navigation.directive import Directive
from uvf.planning.navigation.global_routes import GlobalRoutes
from uvf.runtime.messages.convert import cost_grid, occupancy_cells, pose2_of, seconds, wxyz

SIZE, RESOLUTION = 8.0, 0.05  # m, of the window in which obstacles are remembered that the map does not show
TELL_PERIOD = 2.0  # s between two costmaps that are told
LIFETIME = 30.0  # s that such an obstacle is remembered without being seen


class PlanningGround:
    """One vehicle's, in the map frame."""

    def __init__(self, vehicle: str, planner: GlobalPlanner, sensors: ObstacleSensors, world_from_map: Pose2) -> None:
        self._planner, self._vehicle = planner, vehicle
        self._told: Costmap | None = None
        self._told_at = -inf
        self._world_from_map, self._map_from_world = world_from_map, inverse(world_from_map)
        self._sensors = sensors
        self._layer = ObstacleLayer(SIZE, RESOLUTION, LIFETIME)
        self._hidden = HiddenObstacles(SIZE, RESOLUTION, LIFETIME)
        self._keep_out = MaskReader()
        self._lent = LentMaps(self._map_from_world)
        self._told_fault = ""
        self._map_stamp = -1.0
        self._cleared = -1
        self.routes = GlobalRoutes(planner, self._layer, self._hidden)
        self.here: Pose2 | None = None
        """Where the vehicle is; None while that is not known."""

    def move(self, poses: list[PoseInFrame]) -> None:
        """Where the vehicle has been and is."""
        for message in poses:
            self.here = compose(self._map_from_world, pose2_of(message.pose))
            self._sensors.placer.move(seconds(message.timestamp), self.here, wxyz(message.pose.orientation))
            self.routes.drive(self.here[:2])

    def keep_out(self, grid: Grid | None) -> None:
        """Takes what is drawn over the map."""
        mask = self._keep_out.take(grid)
        if mask is not None and self._keep_out.is_new:
            self.routes.keep_out(mask, self._world_from_map)

    def share(self, handed: Grid | None, limits: TerrainLimits, team: tuple[Grid, Pose2] | None) -> str:
        """Takes maps that others have made, as in ``LentMaps``; what has come to be wrong with them, "" if nothing or known before."""
        before = self._lent.lent
        fault = self._lent.take(handed, limits, team)
        if self._lent.lent is not before:
            self.routes.share(self._lent.lent)
            self._told_fault = ""
        if fault:
            return fault
        fault = "with the vehicle's own map it is too large to plan on; share an area of it" if self.routes.shared_is_too_large else ""
        news, self._told_fault = fault if fault != self._told_fault else "", fault
        return news

    def look(self, t: float, grid: Grid, scans: Sequence[LaserScan], readings: OtherReadings) -> bool:
        """Takes map, scans and what else was seen; whether there is something new to plan by. Where the vehicle is must be known."""
        assert self.here is not None
        here = self.here[:2]
        taken_at, new = seconds(grid.timestamp), False
        if taken_at != self._map_stamp:
            self._map_stamp, new = taken_at, True
            self.routes.take(occupancy_cells(grid), (grid.cell_size.x, (grid.pose.position.x, grid.pose.position.y)))
        self._sensors.take(t, readings, self._hidden)
        if self._sensors.bump is not None:
            self._hidden.bump(t, self._sensors.bump)
        placer = self._sensors.placer
        for scan in scans:
            if (seen := placer.place(scan)) is None:
                continue
            self._sensors.see(seen)
            self._layer.recentre(here)
            eye = transform(seen.pose, np.array((seen.eye,)))[0]
            hits = (seen.ranges > 0.0) & (seen.ranges <= placer.farthest)
            self._layer.observe(BeamObservation(seen.t, seen.t, (eye[0], eye[1]), transform(seen.pose, seen.points), hits))
            self._layer.forget(seen.t)
        self._layer.mark(self._hidden.points(t, here, SIZE / 2), t)
        return self.routes.look(here) or new

    def costmap(self, t: float) -> Grid | None:
        """What is planned on, for people to see, at ``t`` [s]; None while it is what was told, or was told just now."""
        costs = self._planner.costs
        if costs is None or costs is self._told or t - self._told_at < TELL_PERIOD:
            return None
        self._told, self._told_at = costs, t
        return cost_grid(costs.values, costs.resolution, *costs.origin, f"{self._vehicle}/map", t)

    def heed(self, directive: Directive) -> None:
        """Forgets what the tracker is to forget."""
        if directive.clear_beyond is not None and directive.number != self._cleared and self.here is not None:
            self._cleared = directive.number
            for obstacles in (self._layer, self._hidden):
                obstacles.clear(directive.clear_beyond, self.here[:2])
