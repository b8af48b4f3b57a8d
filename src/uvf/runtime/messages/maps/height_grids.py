"""Maps of heights as messages: of each cell the ``top`` and the ``ground`` [m, world], NaN where nothing is known."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Grid, PackedElementField
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import planar_pose, stamp

Singles = NDArray[np.float32]

FRAME = "world"
FIELDS = (("top", 0), ("ground", 4))
STRIDE = 8


def heights_message(top: Singles, ground: Singles, resolution: float, corner: tuple[float, float], t: float) -> Grid:
    """Message at ``t`` [s] of heights (rows, columns) [m, world]; row 0 is at the lowest y, ``corner`` (x, y) [m] that of cell [0, 0]."""
    columns = top.shape[1]
    grid = Grid(
        timestamp=stamp(t),
        frame_id=FRAME,
        pose=planar_pose(*corner, 0.0),
        column_count=columns,
        row_stride=STRIDE * columns,
        cell_stride=STRIDE,
        fields=[PackedElementField(name=name, offset=offset, type=PackedElementField.FLOAT32) for name, offset in FIELDS],
        data=np.stack((top, ground), axis=2).astype("<f4").tobytes(),
    )
    grid.cell_size.x = grid.cell_size.y = resolution
    return grid


def has_heights(grid: Grid) -> bool:
    """Whether a message is said to hold heights."""
    return [field.name for field in grid.fields] == [name for name, _ in FIELDS]


def heights_of(grid: Grid) -> tuple[Singles, Singles]:
    """Top and ground (rows, columns) [m, world] of a message. Raises BadInput for one that holds no heights in square cells."""
    row = STRIDE * grid.column_count
    if not has_heights(grid) or grid.cell_stride != STRIDE or grid.row_stride != row or not grid.data or len(grid.data) % row:
        raise BadInput(f"a grid of {grid.column_count} columns with {len(grid.data)} bytes holds no top and ground in whole rows")
    if grid.cell_size.x != grid.cell_size.y:
        raise BadInput(f"a grid with cells of {grid.cell_size.x:g} x {grid.cell_size.y:g} m is no map: they have to be squares")
    both = np.frombuffer(grid.data, dtype="<f4").reshape(-1, grid.column_count, 2)
    return both[:, :, 0], both[:, :, 1]
