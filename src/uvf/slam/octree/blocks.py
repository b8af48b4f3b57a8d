"""Compiled kernels on the map's blocks: rays in, log-odds kept, values out.

The arithmetic, in single precision where it is so there, is OctoMap's: a cell is changed once a scan at most, and not cleared by a scan
that has hit it. All kernels that call one another stand in this file, for numba's cache on disk does not notice a change of a kernel in
another one.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.octree.layout import (
    AXIS,
    BITS,
    BLOCKS,
    CELLS,
    HIGHEST,
    HIT,
    LOWEST,
    MISS,
    REACH,
    SIDE,
    SLACK,
    SPARE,
    SPREAD,
    TOUCHED,
    UNKNOWN,
    Blocks,
    Marks,
)

Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Numbers = NDArray[np.int32]
Flags = NDArray[np.bool_]


@compiled
def _hash(key: int) -> np.uint64:
    mixed = np.uint64(key) * np.uint64(0x9E3779B97F4A7C15)
    return mixed ^ (mixed >> np.uint64(32))


@compiled
def _place(table: Numbers, keys: Ints, key: int, mask: np.uint64) -> np.uint64:
    """Where in the table a key stands, or else the empty place where it would; mask: the table's length less one."""
    place = _hash(key) & mask
    while table[place] >= 0 and keys[table[place]] != key:
        place = (place + np.uint64(1)) & mask
    return place


@compiled
def _key(bx: int, by: int, bz: int) -> int:
    """Of the block at a place counted in blocks from the map's lowest corner."""
    return (bz << (2 * AXIS)) | (by << AXIS) | bx


@compiled
def _inside_block(x: int, y: int, z: int) -> int:
    """The Morton number of a cell in its block."""
    return int(SPREAD[x & 3] | SPREAD[y & 3] << 1 | SPREAD[z & 3] << 2)


@compiled
def find_or_add(blocks: Blocks, key: int) -> int:
    """Number of a block, which is added as unknown if it was not there; there must be room for it."""
    place = _place(blocks.table, blocks.keys, key, np.uint64(blocks.table.shape[0] - 1))
    number = blocks.table[place]
    if number < 0:
        number = np.int32(blocks.counts[BLOCKS])
        blocks.counts[BLOCKS] += 1
        blocks.table[place] = number
        blocks.keys[number] = key
        blocks.slots[number] = -1
        blocks.uniform[number] = UNKNOWN
    return int(number)


@compiled
def rehash(blocks: Blocks) -> None:
    """Fills an empty hash table with all blocks."""
    mask = np.uint64(blocks.table.shape[0] - 1)
    for number in range(blocks.counts[BLOCKS]):
        blocks.table[_place(blocks.table, blocks.keys, blocks.keys[number], mask)] = number


@compiled
def _touch(blocks: Blocks, marks: Marks, key: int) -> int:
    """A row without marks for a block that has none yet."""
    number, count = find_or_add(blocks, key), blocks.counts[TOUCHED]
    marks.rows[number] = count
    marks.touched[count] = number
    marks.free[count] = np.uint64(0)
    marks.hit[count] = np.uint64(0)
    blocks.counts[TOUCHED] = count + 1
    return int(count)


@compiled
def _cell(coordinate: np.float32, resolution: float) -> int:
    return int(np.floor((1.0 / resolution) * np.float64(coordinate))) + REACH


@compiled
def _inside(point: Singles, resolution: float) -> bool:
    limit = resolution * (REACH - SIDE)
    return bool(abs(point[0]) < limit and abs(point[1]) < limit and abs(point[2]) < limit)


@compiled
def _cut(origin: Singles, points: Singles, reach: float, resolution: float) -> tuple[Singles, Flags]:
    """Ends of the beams to (n, 3) points, cut at the reach [m], and which of them have hit something, rounded as OctoMap does; without
    those that are not finite or leave the map.
    """
    ends, is_hit, n = np.empty_like(points), np.empty(points.shape[0], dtype=np.bool_), 0
    limit, far = resolution * (REACH - SIDE), np.float32(reach)
    for i in range(points.shape[0] if _inside(origin, resolution) else 0):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        dx, dy, dz = x - origin[0], y - origin[1], z - origin[2]
        distance = np.sqrt(np.float64(dx * dx + dy * dy + dz * dz))
        is_hit[n] = distance <= reach
        if not is_hit[n]:
            norm = np.float32(distance)
            x, y, z = origin[0] + dx / norm * far, origin[1] + dy / norm * far, origin[2] + dz / norm * far
        ends[n, 0], ends[n, 1], ends[n, 2] = x, y, z
        n += abs(x) < limit and abs(y) < limit and abs(z) < limit
    return ends[:n], is_hit[:n]


@compiled
def _begin(cell: int, origin: np.float32, along: np.float32, resolution: float) -> tuple[int, float, float]:
    """Of a ray on one axis: the step to the next cell, the distance along the ray to it, and from there to each further one."""
    if along == 0.0:
        return 0, np.inf, np.inf
    step = 1 if along > 0.0 else -1
    centre = (np.float64(cell - REACH) + 0.5) * resolution
    border = centre + np.float64(np.float32(step * resolution * 0.5))
    return step, (border - np.float64(origin)) / np.float64(along), resolution / abs(np.float64(along))


@compiled
def _mark(blocks: Blocks, marks: Marks, rays: tuple[Singles, Singles, Flags], resolution: float, first: int) -> int:
    """Marks what beams see, from the beam ``first`` on; the number of beams done: fewer than there are where there was no room.

    rays: origin (3,), ends (n, 3) [m], inside the map, and whether they have hit something there (n,). Cell by cell after Amanatides & Woo,
    "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987), with the rounding of OctoMap's computeRayKeys.
    """
    origin, ends, is_hit = rays
    free, hit, rows, touched = marks.free, marks.hit, marks.rows, marks.touched
    table, keys, counts = blocks.table, blocks.keys, blocks.counts
    mask, room = np.uint64(table.shape[0] - 1), min(keys.shape[0], table.shape[0] // 2)
    x0, y0, z0 = _cell(origin[0], resolution), _cell(origin[1], resolution), _cell(origin[2], resolution)
    for i in range(first, ends.shape[0]):
        x, y, z = x0, y0, z0
        last_x, last_y, last_z = _cell(ends[i, 0], resolution), _cell(ends[i, 1], resolution), _cell(ends[i, 2], resolution)
        needed = (abs(last_x - x) + abs(last_y - y) + abs(last_z - z)) // SIDE + SLACK
        if counts[BLOCKS] + needed > room or counts[TOUCHED] + needed > touched.shape[0]:
            return int(i)
        dx, dy, dz = ends[i, 0] - origin[0], ends[i, 1] - origin[1], ends[i, 2] - origin[2]
        length = np.float32(np.sqrt(np.float64(dx * dx + dy * dy + dz * dz)))
        step_x, next_x, delta_x = _begin(x, origin[0], dx / length, resolution)
        step_y, next_y, delta_y = _begin(y, origin[1], dy / length, resolution)
        step_z, next_z, delta_z = _begin(z, origin[2], dz / length, resolution)
        stop, crossed, row = np.float64(length), SIDE, 0
        while True:
            is_end = x == last_x and y == last_y and z == last_z
            if is_end and not is_hit[i]:
                break
            if crossed >= SIDE:
                key = _key(x >> BITS, y >> BITS, z >> BITS)
                place = _place(table, keys, key, mask)
                row = rows[table[place]] if table[place] >= 0 else -1
                if row < 0 or row >= counts[TOUCHED] or touched[row] != table[place]:
                    row = _touch(blocks, marks, key)
            bit = np.uint64(1) << np.uint64(_inside_block(x, y, z))
            if is_end:
                hit[np.uint64(row)] |= bit
                break
            free[np.uint64(row)] |= bit
            if next_x < next_y and next_x < next_z:
                crossed = x ^ (x + step_x)
                x += step_x
                next_x += delta_x
            elif next_y < next_z:
                crossed = y ^ (y + step_y)
                y += step_y
                next_y += delta_y
            else:
                crossed = z ^ (z + step_z)
                z += step_z
                next_z += delta_z
            if next_x > stop and next_y > stop and next_z > stop:  # at the end, or past it by rounding
                x, y, z, crossed = last_x, last_y, last_z, SIDE
    return int(ends.shape[0])


@compiled
def _expand(blocks: Blocks, number: int) -> int:
    """The row of a block's cells, taken from the spare ones when it had a single value."""
    slot = blocks.slots[number]
    if slot < 0:
        blocks.counts[SPARE] -= 1
        slot = blocks.spare[blocks.counts[SPARE]]
        blocks.values[slot, :] = blocks.uniform[number]
        blocks.slots[number] = slot
    return int(slot)


@compiled
def _collapse(blocks: Blocks, number: int) -> None:
    """Gives the row back when all cells say the same."""
    slot = blocks.slots[number]
    values = blocks.values[slot]
    for i in range(1, CELLS):
        if values[i] != values[0]:
            return
    if values[0] == values[0]:
        blocks.uniform[number] = values[0]
        blocks.slots[number] = -1
        blocks.spare[blocks.counts[SPARE]] = slot
        blocks.counts[SPARE] += 1


@compiled
def _rows_wanted(blocks: Blocks, marks: Marks) -> int:
    """How many spare rows ``apply_marks`` may take."""
    wanted = 0
    for row in range(blocks.counts[TOUCHED]):
        number = marks.touched[row]
        wanted += blocks.slots[number] < 0 and not _stays_free(blocks, number, marks.hit[row])
    return wanted


@compiled
def _stays_free(blocks: Blocks, number: int, hit: np.uint64) -> bool:
    return bool(blocks.slots[number] < 0 and blocks.uniform[number] == LOWEST and hit == 0)


@compiled
def apply_marks(blocks: Blocks, marks: Marks) -> None:
    """Changes each marked cell once, and forgets the marks; as many spare rows as are wanted must be there."""
    for row in range(blocks.counts[TOUCHED]):
        number = marks.touched[row]
        if _stays_free(blocks, number, marks.hit[row]):
            continue
        values = blocks.values[_expand(blocks, number)]
        hit = marks.hit[row]
        seen = marks.free[row] | hit
        for i in range(CELLS):
            if (seen >> np.uint64(i)) & np.uint64(1):
                change = HIT if (hit >> np.uint64(i)) & np.uint64(1) else MISS
                before = values[i] if values[i] == values[i] else np.float32(0.0)
                values[i] = min(max(before + change, LOWEST), HIGHEST)
        _collapse(blocks, number)
    blocks.counts[TOUCHED] = 0


@compiled
def put_in(blocks: Blocks, marks: Marks, scan: tuple[Singles, Singles, float], resolution: float, first: int) -> tuple[int, int]:
    """One scan, from the beam ``first`` on, as far as there is room: the number of beams done and what is wanted.

    Fewer than all done: so many more blocks; then call it again. All done: so many spare rows; then call ``apply_marks``; 0 when that has
    been done too.

    scan: origin (3,), points (n, 3) where the beams ended [m], and the reach [m].
    """
    origin, points, reach = scan
    ends, is_hit = _cut(origin, points, reach, resolution)
    done = _mark(blocks, marks, (origin, ends, is_hit), resolution, first)
    if done < ends.shape[0]:
        return done, int(np.abs(ends[done] - origin).sum() / resolution) // SIDE + 2 * SLACK
    wanted = _rows_wanted(blocks, marks)
    if wanted > blocks.counts[SPARE]:
        return points.shape[0], wanted
    apply_marks(blocks, marks)
    return points.shape[0], 0


@compiled
def _value(blocks: Blocks, x: int, y: int, z: int) -> np.float32:
    """Log-odds of a cell inside the map; NaN unknown."""
    key = _key(x >> BITS, y >> BITS, z >> BITS)
    number = blocks.table[_place(blocks.table, blocks.keys, key, np.uint64(blocks.table.shape[0] - 1))]
    if number < 0:
        return UNKNOWN
    slot = blocks.slots[number]
    if slot < 0:
        return np.float32(blocks.uniform[number])
    return np.float32(blocks.values[slot, _inside_block(x, y, z)])


@compiled
def values_at(blocks: Blocks, points: Singles, resolution: float) -> Singles:
    """Log-odds (n,) [-] at points (n, 3) [m], in cells of ``resolution`` [m]; NaN unknown."""
    found = np.full(points.shape[0], UNKNOWN, dtype=np.float32)
    for i in range(points.shape[0]):
        p = points[i]
        if _inside(p, resolution):
            found[i] = _value(blocks, _cell(p[0], resolution), _cell(p[1], resolution), _cell(p[2], resolution))
    return found


@compiled
def cast(blocks: Blocks, rays: tuple[Singles, Singles, float], resolution: float, through_unknown: bool) -> Ints:
    """Cell (n, 3) of the first occupied cell on each ray, or -1: nothing, or the unknown, came first. resolution: side of a cell [m].

    rays: origins (n, 3) [m], directions (n, 3), reach [m] to a cell's middle; 0: to the end of the map.
    """
    origins, directions, reach = rays
    met = np.full((origins.shape[0], 3), -1)
    cell, step = np.empty(3, dtype=np.int64), np.empty(3, dtype=np.int64)
    ahead, delta = np.empty(3), np.empty(3)
    for i in range(origins.shape[0]):
        origin, along = origins[i], directions[i]
        if not _inside(origin, resolution) or not (along[0] != 0.0 or along[1] != 0.0 or along[2] != 0.0):
            continue
        norm = np.float32(np.sqrt(np.float64(along[0] * along[0] + along[1] * along[1] + along[2] * along[2])))
        for k in range(3):
            unit = along[k] / norm
            cell[k], step[k] = _cell(origin[k], resolution), int(np.sign(unit))
            centre = (np.float64(cell[k] - REACH) + 0.5) * resolution
            border = centre + step[k] * resolution * 0.5 - np.float64(origin[k])
            ahead[k] = border / np.float64(unit) if step[k] != 0 else np.inf
            delta[k] = resolution / abs(np.float64(unit)) if step[k] != 0 else np.inf
        while True:
            value = _value(blocks, cell[0], cell[1], cell[2])
            if value >= 0.0:
                met[i] = cell
                break
            if value != value and not through_unknown:
                break
            k = 1 if ahead[1] < ahead[2] else 2
            if ahead[0] < ahead[1]:
                k = 0 if ahead[0] < ahead[2] else 2
            cell[k] += step[k]
            ahead[k] += delta[k]
            if cell[k] < SIDE or cell[k] >= 2 * REACH - SIDE:
                break
            square = 0.0
            for j in range(3):
                middle = np.float32((np.float64(cell[j] - REACH) + 0.5) * resolution)
                square += np.float64((middle - origin[j]) * (middle - origin[j]))
            if reach > 0.0 and square > reach * reach:
                break
    return met


@compiled
def set_cells(blocks: Blocks, keys: Ints, inside: Ints, values: Singles) -> None:
    """Gives cells the ``values`` (n,): keys (n,) of their blocks, inside (n,) their Morton numbers there.

    Room and spare rows must be there.
    """
    for i in range(keys.shape[0]):
        slot = _expand(blocks, find_or_add(blocks, keys[i]))
        blocks.values[slot, inside[i]] = values[i]


@compiled
def set_blocks(blocks: Blocks, keys: Ints, values: Singles) -> None:
    """Gives whole new blocks with keys (n,) a single value (n,) each."""
    for i in range(keys.shape[0]):
        blocks.uniform[find_or_add(blocks, keys[i])] = values[i]
