"""The map seen from above: a slice of it as an occupancy grid, and heights."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.octree.layout import BLOCKS, REACH, SIDE, SPREAD, Blocks
from uvf.slam.octree.leaves import block_places
from uvf.slam.octree.octree import Octree

Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Cells = NDArray[np.int8]

FREE, UNKNOWN, OCCUPIED = 0, -1, 100


@dataclass(frozen=True)
class Columns:
    """One value a column of cells; row 0 is at the lowest y, cell [0, 0] has its lower left corner at (x, y) [m].

    slice: (rows, columns) -1 unknown, 0 free, 100 occupied, of the heights asked for. top: (rows, columns) m, upper side of the highest
    occupied cell; ground: m, upper side of the lowest occupied cell with a free one on it; NaN where there is none.
    resolution: m, width of a column.
    """

    slice: Cells
    top: Singles
    ground: Singles
    resolution: float
    x: float
    y: float


def columns_of(octree: Octree, low: float, high: float, most: int) -> Columns | None:
    """The map seen from above, in columns of cells; None while nothing is known.

    The slice holds the cells that reach into low..high [m]: one occupied cell makes its column occupied, else one free cell makes it free.
    Where there would be more than ``most`` columns they are put together, four in one, until there are not; no larger grid is made
    on the way.
    """
    blocks = octree.blocks
    if octree.is_empty:
        return None
    places = block_places(blocks.keys[: blocks.counts[BLOCKS]])
    order = np.lexsort((places[:, 2], places[:, 0], places[:, 1]))
    corner, last = places[:, :2].min(axis=0), places[:, :2].max(axis=0)
    size = (last - corner + 1)[::-1] * SIDE
    halvings = 0
    while np.prod(-(-size >> halvings)) > most:
        halvings += 1
    shape = tuple((-(-size >> halvings)).tolist())
    band = (int(np.floor(low / octree.resolution)) + REACH, int(np.ceil(high / octree.resolution)) + REACH)
    cells = np.full(shape, UNKNOWN, dtype=np.int8)
    top, ground = np.full((2, *shape), np.nan, dtype=np.float32)
    _look_down(blocks, (places[order], order, corner), (*band, halvings), (cells, top, ground))
    x, y = ((corner * SIDE - REACH) * octree.resolution).tolist()
    top, ground = ((heights - REACH) * np.float32(octree.resolution) for heights in (top, ground))
    return Columns(cells, top, ground, octree.resolution * 2**halvings, x, y)


@compiled
def _look_down(blocks: Blocks, sorted_: tuple[Ints, Ints, Ints], how: tuple[int, int, int], out: tuple[Cells, Singles, Singles]) -> None:
    """sorted_: places (n, 3) of the blocks, upwards within each column of them, their numbers (n,), and the lowest x and y (2,);
    how: the first cell of the slice, the first above it, and how often four columns are put together: of these what is occupied and what
    is high counts, of the ground what is low. Heights go out in cells from the map's lowest corner.
    """
    places, numbers, corner = sorted_
    low, high, halvings = how
    cells, top, ground = out
    under, stands = np.empty((SIDE, SIDE), dtype=np.int64), np.empty((SIDE, SIDE), dtype=np.bool_)
    for i in range(places.shape[0]):
        if i == 0 or places[i, 0] != places[i - 1, 0] or places[i, 1] != places[i - 1, 1]:
            under[:] = -1  # the occupied cell that would be the ground if the next one is free
            stands[:] = False  # whether the ground has been found
        number, base = numbers[i], places[i, 2] * SIDE
        slot = blocks.slots[number]
        for ly in range(SIDE):
            row = ((places[i, 1] - corner[1]) * SIDE + ly) >> halvings
            for lx in range(SIDE):
                column = ((places[i, 0] - corner[0]) * SIDE + lx) >> halvings
                for lz in range(SIDE):
                    inside = SPREAD[lx] | SPREAD[ly] << 1 | SPREAD[lz] << 2
                    value = blocks.uniform[number] if slot < 0 else blocks.values[slot, inside]
                    if value != value:
                        continue
                    z = base + lz
                    if value >= 0.0:
                        if not top[row, column] >= z + 1:
                            top[row, column] = z + 1
                        under[ly, lx] = z
                    elif under[ly, lx] == z - 1 and not stands[ly, lx]:
                        stands[ly, lx] = True
                        if not ground[row, column] <= z:
                            ground[row, column] = z
                    if low <= z < high:
                        cells[row, column] = max(cells[row, column], OCCUPIED if value >= 0.0 else FREE)
