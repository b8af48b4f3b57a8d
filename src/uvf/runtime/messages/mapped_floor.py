"""How much of its floor a ground vehicle has mapped: the one figure of the report's criterion and of the page."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Grid
from uvf.models.scenario import MissionVehicle
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import floor_plan, reachable_floor
from uvf.runtime.messages.convert import occupancy_cells

RESOLUTION = 0.05  # m
FREE_BELOW = 50  # occupancy of 0..100


class MappedFloor:
    """The floor of ``world`` that one ground vehicle can reach from its start, as the world file has it."""

    def __init__(self, world: WorldFile, member: MissionVehicle) -> None:
        self._start = member.entry.start
        plan = floor_plan(world, RESOLUTION)
        x, y = plan.centres()
        inside = reachable_floor(plan, self._start.x, self._start.y, member.file.ground.radius if member.file.ground else 0.0)
        self._x, self._y = x[inside], y[inside]

    def share(self, grid: Grid) -> float:
        """Share, 0 to 1, of that floor which the map (placed in the world at the vehicle's start) holds as free."""
        cells = occupancy_cells(grid)
        c, s = np.cos(self._start.yaw), np.sin(self._start.yaw)
        dx, dy = self._x - self._start.x, self._y - self._start.y
        column = np.floor((c * dx + s * dy - grid.pose.position.x) / grid.cell_size.x).astype(int)
        row = np.floor((-s * dx + c * dy - grid.pose.position.y) / grid.cell_size.y).astype(int)
        within = (row >= 0) & (row < cells.shape[0]) & (column >= 0) & (column < cells.shape[1])
        free: NDArray[np.bool_] = np.zeros(len(dx), dtype=np.bool_)
        free[within] = (cells[row[within], column[within]] >= 0) & (cells[row[within], column[within]] < FREE_BELOW)
        return float(free.mean()) if len(free) else 0.0
