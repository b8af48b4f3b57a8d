"""How much of its floor a ground vehicle has mapped: the one figure of the report's criterion and of the page."""

import numpy as np

from schemas.messages import Grid
from uvf.maths.se2 import Pose2
from uvf.models.scenario import MissionVehicle
from uvf.models.urdf.outline import ground_outline
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import cell_size, floor_plan
from uvf.models.world.reach import covered_floor
from uvf.runtime.messages.convert import occupancy_cells

RESOLUTION = 0.05  # m
FREE_BELOW = 50  # occupancy of 0..100


class MappedFloor:
    """The floor of ``world`` that one ground vehicle can reach from its start, as the world file has it."""

    def __init__(self, world: WorldFile, member: MissionVehicle) -> None:
        start = member.entry.start
        plan = floor_plan(world, cell_size(world, RESOLUTION))
        x, y = plan.centres()
        body = member.file.ground
        if body is None:
            raise ValueError(f"{member.name} is no ground vehicle")
        inside = covered_floor(plan, Pose2(start.x, start.y, start.yaw), ground_outline(member.folder / body.urdf, body.radius))
        c, s, dx, dy = np.cos(start.yaw), np.sin(start.yaw), x[inside] - start.x, y[inside] - start.y
        self._ahead, self._left = (c * dx + s * dy).astype(np.float32), (c * dy - s * dx).astype(np.float32)

    def share(self, grid: Grid) -> float:
        """Share, 0 to 1, of that floor which the map (placed in the world at the vehicle's start) holds as free."""
        if not len(self._ahead):
            return 0.0
        cells = occupancy_cells(grid)
        column = (self._ahead - grid.pose.position.x) / grid.cell_size.x
        row = (self._left - grid.pose.position.y) / grid.cell_size.y
        within = (row >= 0) & (row < cells.shape[0]) & (column >= 0) & (column < cells.shape[1])
        seen = cells[row[within].astype(int), column[within].astype(int)]
        return np.count_nonzero((seen >= 0) & (seen < FREE_BELOW)) / len(self._ahead)
