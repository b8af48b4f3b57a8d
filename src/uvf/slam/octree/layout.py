"""How the map's blocks lie in memory, and the sensor model: OctoMap's (Hornung et al., "OctoMap: an efficient probabilistic 3D mapping
framework based on octrees", Autonomous Robots 2013).

Blocks of 4 x 4 x 4 cells are found by a hash of their place. A block's cells stand in Morton order, so that eight that make one node of an
octree are neighbours in memory. A block whose cells all say the same holds one value only. Compiled kernels take these numbers in when they
are compiled: who changes one must change the files of the kernels too, or numba's cache on disk goes on with the old ones.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Numbers = NDArray[np.int32]
Words = NDArray[np.uint64]
Flags = NDArray[np.bool_]

BITS, SIDE, CELLS = 2, 4, 64
AXIS = 21
"""Bits of a block's place along one axis: the map reaches 2**20 blocks to each side."""
REACH = SIDE << (AXIS - 1)
"""Cells from the origin to the map's end, to each side."""

HIT, MISS = np.float32(np.log(0.7 / 0.3)), np.float32(np.log(0.4 / 0.6))
LOWEST, HIGHEST = np.float32(np.log(0.1192 / 0.8808)), np.float32(np.log(0.971 / 0.029))
"""Log-odds: change of a cell by a hit and by a miss, and the clamping thresholds (OctoMap's default probabilities)."""
UNKNOWN = np.float32(np.nan)

SPREAD = np.array((0, 1, 8, 9))
"""The two bits of a cell's place along x, two apart: x | y << 1 | z << 2 of these is its Morton number."""
SLACK = 8
"""Blocks more than the straight way between its ends that a ray may touch, through rounding."""


class Blocks(NamedTuple):
    """All that is known. table: (2^k,) number of a block by hash, -1 empty; keys: (n,) place of each block; slots: (n,) row of ``values``,
    -1: all cells are ``uniform``; uniform: (n,); values: (m, 64) log-odds, NaN unknown; spare: (m,) free rows, a stack;
    counts: blocks, spare rows, touched blocks.
    """

    table: Numbers
    keys: Ints
    slots: Numbers
    uniform: Singles
    values: Singles
    spare: Numbers
    counts: Ints


class Marks(NamedTuple):
    """What one scan has seen. rows: (n,) where a block is in ``touched`` (if it is there); touched: (r,) numbers of blocks;
    free, hit: (r,) one bit a cell.
    """

    rows: Numbers
    touched: Numbers
    free: Words
    hit: Words


BLOCKS, SPARE, TOUCHED = 0, 1, 2
