"""Maps as messages."""

from schemas.messages import Grid
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import occupancy_cells, occupancy_grid, planar_pose, pose2_of


def as_message(grid: GridMap, frame: str, t: float) -> Grid:
    """Message of a map at ``t`` [s]; frame: what the grid's origin is given in."""
    message = occupancy_grid(grid.cells, grid.resolution, grid.origin.x, grid.origin.y, frame, t)
    message.pose.CopyFrom(planar_pose(*grid.origin))
    return message


def as_map(message: Grid) -> GridMap:
    """Map of a message. Raises BadInput for a message that is no occupancy of square cells."""
    columns, size = message.column_count, message.cell_size
    if columns == 0 or len(message.data) == 0 or len(message.data) % columns or message.row_stride != columns:
        raise BadInput(f"a grid of {columns} columns with {len(message.data)} bytes is no map of whole rows")
    if not size.x > 0.0 or size.x != size.y:
        raise BadInput(f"a grid with cells of {size.x:g} x {size.y:g} m is no map: they have to be squares")
    return GridMap(occupancy_cells(message), size.x, pose2_of(message.pose))
