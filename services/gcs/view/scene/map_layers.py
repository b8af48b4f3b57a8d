"""Maps on the floor and in space: occupancy, costs, octree."""

import numpy as np

from schemas.messages import FrameTransform, Grid
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.drawing import FloorPicture
from services.gcs.view.scene.levels import UP
from services.gcs.view.scene.map_image import COST, OCCUPANCY, Palette, known_part, palette_png
from services.gcs.view.scene.node_cache import Layers, NodeCache, Nodes
from services.gcs.view.scene.octree_boxes import octree_boxes
from uvf.maths.rotations import multiply, rotate, to_euler
from uvf.runtime.messages.convert import array, cost_cells, wxyz

MAP_PERIOD = 1.0  # s between two pictures of a map
OCTREE_PERIOD = 3.0  # s between two pictures of an octree


class MapLayers:
    """Draws the maps that a vehicle has told."""

    def __init__(self, nodes: NodeCache) -> None:
        self._nodes = nodes

    def of(self, v: VehicleModel, t: float) -> Layers:
        """The layers of a vehicle at ``t`` [s, wall]."""
        return {
            "map": ("Map", lambda: self._floor(v, ("map", OCCUPANCY, UP / 2), v.grid, t)),
            "team": ("Team maps", lambda: self._floor(v, ("team", OCCUPANCY, UP / 2), v.team_map, t)),
            "costmap": ("Costmaps", lambda: self._floor(v, ("costmap", COST, 1.5 * UP), v.costmap, t)),
            "costs": ("Costmaps", lambda: self._floor(v, ("costs", COST, 2 * UP), v.local_costs, t)),
            "octree": ("Octree", lambda: self._octree(v, t)),
        }

    def _floor(self, v: VehicleModel, look: tuple[str, Palette, float], grid: Grid | None, t: float) -> Nodes:
        """look: its name, its colours, and the height [m] at which it lies."""
        name, palette, z = look
        if grid is None or not grid.data or grid.column_count == 0:
            return {}
        if v.world_from_map is None and grid.frame_id != "world":
            return {}  # nobody has said yet where this map lies

        def draw() -> Nodes:
            return {"": floor_picture(grid, v.world_from_map, palette, z)}

        return self._nodes.make_seldom(f"{name} {v.name}", (grid, v.world_from_map), (t, MAP_PERIOD), draw)

    def _octree(self, v: VehicleModel, t: float) -> Nodes:
        octree = v.octree
        if octree is None:
            return {}

        def draw() -> Nodes:
            found = octree_boxes(octree)
            return {"": found} if found is not None else {}

        return self._nodes.make_seldom(f"octree {v.name}", octree, (t, OCTREE_PERIOD), draw)


def floor_picture(grid: Grid, world_from_map: FrameTransform | None, palette: Palette = OCCUPANCY, z: float = UP / 2) -> FloorPicture:
    """The grid as a picture at height ``z`` [m], placed by its pose (that of its lower left corner) and its frame's."""
    cells, (row, column) = known_part(cost_cells(grid))  # an unknown -1 of occupancy is the unknown 255 of costs
    dx, dy = grid.cell_size.x, grid.cell_size.y
    width, height = cells.shape[1] * dx, cells.shape[0] * dy
    turn = wxyz(grid.pose.orientation)
    centre = array(grid.pose.position) + rotate(turn, np.array((column * dx + width / 2, row * dy + height / 2, 0.0)))
    if world_from_map is not None and grid.frame_id != "world":
        map_turn = wxyz(world_from_map.rotation)
        turn, centre = multiply(map_turn, turn), array(world_from_map.translation) + rotate(map_turn, centre)
    x, y, above = (float(c) for c in centre)
    return FloorPicture(palette_png(cells, palette), width, height, (x, y, above + z), to_euler(turn)[2])
