"""The map as a pruned octree: its leaves, in the order of their Morton numbers, as OctoMap's tree of 16 levels has them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.octree.layout import AXIS, BLOCKS, CELLS, Blocks
from uvf.slam.octree.octree import Octree

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Depths = NDArray[np.uint8]

DEPTH = 16
BLOCK_DEPTH = 14
CENTRE = 1 << (DEPTH - 1)
"""Cell along each axis at which OctoMap has the origin."""
SHIFT = (1 << (AXIS - 1)) - (1 << (BLOCK_DEPTH - 1))
"""Blocks between the lowest corner of the map and that of OctoMap's tree."""
BLOCKS_MOST = 1 << 24
"""Of a map that is read: cubes that are known throughout take little room in a file."""


STAGES = (
    (32, 0x1F00000000FFFF),
    (16, 0x1F0000FF0000FF),
    (8, 0x100F00F00F00F00F),
    (4, 0x10C30C30C30C30C3),
    (2, 0x1249249249249249),
)
"""Shift and mask by which the bits of a number are drawn apart, two empty places between them, from the upper half on."""


class TooLarge(ValueError):
    """A map does not fit into what it is to be put into."""


class Leaves(NamedTuple):
    """Leaves of an octree. codes: (n,) Morton number of the lowest cell in each, rising; values: (n,) log-odds.

    depths: (n,) 16 = a cell; a leaf's side is 2^(16 - depth) cells.
    """

    codes: Ints
    depths: Depths
    values: Singles


def leaves_of(octree: Octree) -> Leaves:
    """Leaves of all that is known, pruned. Raises TooLarge for a map that reaches farther than OctoMap's 32768 cells from the origin."""
    blocks = octree.blocks
    places = block_places(blocks.keys[: blocks.counts[BLOCKS]]) - SHIFT
    if len(places) and (places.min() < 0 or places.max() >= 1 << BLOCK_DEPTH):
        raise TooLarge(
            f"the map reaches more than {CENTRE * octree.resolution:g} m from its origin: too far for OctoMap at {octree.resolution:g} m"
        )
    codes = morton(places)
    order = np.argsort(codes)
    return Leaves(*_prune_blocks(blocks, codes[order], order))


def pruned(leaves: Leaves) -> Leaves:
    """The leaves with each eight that fill a cube and say the same as one."""
    return Leaves(*_prune(*leaves))


def coarser(leaves: Leaves, depth: int) -> Leaves:
    """The leaves with none smaller than those of ``depth``; of several in one, the most occupied counts (as for OctoMap's inner nodes)."""
    shift = 3 * (DEPTH - depth)
    codes = leaves.codes >> shift << shift
    first = np.flatnonzero(np.diff(codes, prepend=-1))
    values = np.maximum.reduceat(leaves.values, first) if len(first) else leaves.values
    return pruned(Leaves(codes[first], np.minimum(leaves.depths[first], depth).astype(np.uint8), values))


def likeliest(leaves: Leaves, lowest: np.float32, highest: np.float32) -> Leaves:
    """The leaves with each surely occupied, ``highest``, or surely free, ``lowest``."""
    return pruned(leaves._replace(values=np.where(leaves.values >= 0.0, highest, lowest).astype(np.float32)))


def boxes(leaves: Leaves, resolution: float) -> tuple[Floats, Floats]:
    """Middles (n, 3) [m] and sides (n,) [m] of the leaves, in cells of ``resolution`` [m]."""
    sides = (1 << (DEPTH - leaves.depths.astype(np.int64))).astype(np.float64)
    corners = unmorton(leaves.codes) - CENTRE
    return (corners + sides[:, None] / 2) * resolution, sides * resolution


def bounds(leaves: Leaves, resolution: float) -> tuple[Floats, Floats] | None:
    """Lowest and highest corner (3,) [m] of all that is known, in cells of ``resolution`` [m]; None while nothing is."""
    if not len(leaves.codes):
        return None
    middles, sides = boxes(leaves, resolution)
    return (middles - sides[:, None] / 2).min(axis=0), (middles + sides[:, None] / 2).max(axis=0)


def octree_of(leaves: Leaves, resolution: float) -> Octree:
    """Map that has these leaves, in cells of ``resolution`` [m]. Raises TooLarge for one that is known in too large a volume."""
    octree = Octree(resolution)
    large = leaves.depths <= BLOCK_DEPTH
    counts = np.left_shift(1, 3 * (BLOCK_DEPTH - leaves.depths[large].astype(np.int64)))
    if counts.sum() > BLOCKS_MOST:
        raise TooLarge(f"{counts.sum()} blocks of {CELLS} cells are known throughout; {BLOCKS_MOST} are read at most")
    octree.set_blocks(_keys(_runs(leaves.codes[large] // CELLS, counts)), np.repeat(leaves.values[large], counts))
    counts = np.left_shift(1, 3 * (DEPTH - leaves.depths[~large].astype(np.int64)))
    cells = _runs(leaves.codes[~large], counts)
    octree.set_cells(_keys(cells // CELLS), cells % CELLS, np.repeat(leaves.values[~large], counts))
    return octree


def _runs(starts: Ints, counts: Ints) -> Ints:
    """Each start and the numbers that follow it, as many as are counted."""
    ends = np.cumsum(counts)
    return np.repeat(starts - ends + counts, counts) + np.arange(ends[-1] if len(ends) else 0)


def _keys(codes: Ints) -> Ints:
    """Of blocks, from their Morton numbers in OctoMap's tree."""
    x, y, z = (unmorton(codes) + SHIFT).T
    keys: Ints = z << (2 * AXIS) | y << AXIS | x
    return keys


def block_places(keys: Ints) -> Ints:
    """Places (n, 3) x, y, z of blocks by their keys (n,), counted from the map's lowest corner."""
    mask = (1 << AXIS) - 1
    places: Ints = np.column_stack((keys & mask, keys >> AXIS & mask, keys >> (2 * AXIS) & mask))
    return places


def morton(places: Ints) -> Ints:
    """Morton numbers (n,): the bits of places (n, 3) below 2^21 interleaved, x in the lowest place."""
    for shift, mask in STAGES:
        places = (places | places << shift) & mask
    codes: Ints = places[:, 0] | places[:, 1] << 1 | places[:, 2] << 2
    return codes


def unmorton(codes: Ints) -> Ints:
    """Places (n, 3) of Morton numbers (n,); the inverse of ``morton``."""
    places = codes[:, None] >> np.arange(3, dtype=np.int64) & STAGES[-1][1]
    for (shift, _), (_, mask) in zip(STAGES[::-1], (*STAGES[-2::-1], (0, 0x1FFFFF)), strict=True):
        places = (places | places >> shift) & mask
    return places


@compiled
def _push(leaves: tuple[Ints, Depths, Singles], n: int, code: int, depth: int, value: np.float32) -> int:
    """Adds a leaf to ``n`` others, and makes one of eight that say the same, and so on upwards; how many there are then."""
    codes, depths, values = leaves
    codes[n], depths[n], values[n] = code, depth, value
    n += 1
    while depth > 0 and n >= 8 and (code >> (3 * (DEPTH - depth))) & 7 == 7:
        parent = code >> (3 * (DEPTH - depth + 1))
        if codes[n - 8] >> (3 * (DEPTH - depth + 1)) != parent:
            break
        alike = True
        for i in range(n - 8, n):
            alike = alike and depths[i] == depth and values[i] == value
        if not alike:
            break
        n -= 7
        depth -= 1
        code = parent << (3 * (DEPTH - depth))
        codes[n - 1], depths[n - 1] = code, depth
    return n


@compiled
def _prune(codes: Ints, depths: Depths, values: Singles) -> tuple[Ints, Depths, Singles]:
    out = (np.empty_like(codes), np.empty_like(depths), np.empty_like(values))
    n = 0
    for i in range(codes.shape[0]):
        n = _push(out, n, codes[i], int(depths[i]), values[i])
    return out[0][:n].copy(), out[1][:n].copy(), out[2][:n].copy()


@compiled
def _prune_blocks(blocks: Blocks, codes: Ints, order: Ints) -> tuple[Ints, Depths, Singles]:
    """codes: Morton numbers of the blocks, rising; order: the number of each block."""
    most = 0
    for number in order:
        most += 1 if blocks.slots[number] < 0 else np.sum(~np.isnan(blocks.values[blocks.slots[number]]))
    out = (np.empty(most, dtype=np.int64), np.empty(most, dtype=np.uint8), np.empty(most, dtype=np.float32))
    n = 0
    for i in range(order.shape[0]):
        slot = blocks.slots[order[i]]
        if slot < 0:
            n = _push(out, n, codes[i] * CELLS, BLOCK_DEPTH, blocks.uniform[order[i]])
            continue
        for j in range(CELLS):
            value = blocks.values[slot, j]
            if value == value:
                n = _push(out, n, codes[i] * CELLS + j, DEPTH, value)
    return out[0][:n].copy(), out[1][:n].copy(), out[2][:n].copy()
