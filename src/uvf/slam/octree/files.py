"""OctoMap's files: .ot holds the log-odds, .bt only what is occupied and what is free.

A file is a few lines of text, the last ``data``, and then the tree from the root down, each node before its children. .ot: each node's
log-odds (a single-precision number) and one bit for each child that is there. .bt: inner nodes only, two bits a child: 0 unknown, 1 free,
2 occupied, 3 has children. Both equal OctoMap's to the byte (``AbstractOcTree::write``, ``AbstractOccupancyOcTree::writeBinary``).
"""

import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.models.yaml_data import BadInput
from uvf.slam.octree.layout import HIGHEST, LOWEST
from uvf.slam.octree.leaves import DEPTH, Leaves, TooLarge, likeliest, octree_of, pruned
from uvf.slam.octree.octree import Octree

Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Bytes = NDArray[np.uint8]
Pairs = NDArray[np.uint16]
Flags = NDArray[np.bool_]

FULL, BINARY = "# Octomap OcTree file", "# Octomap OcTree binary file"
COMMENT = "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
HEADER_END = re.compile(rb"^data[ \t\r]*\n", re.MULTILINE)
NODE = np.dtype([("value", "<f4"), ("children", "u1")])


class FileNodes(NamedTuple):
    """Nodes of the whole tree, from the root down, each before its children. value: (n,) log-odds, of an inner node its children's highest;
    children: (n,) one bit each; pairs: (n,) two bits each, as in .bt.
    """

    value: Singles
    children: Bytes
    pairs: Pairs


def to_ot(leaves: Leaves, resolution: float) -> bytes:
    """Content of an .ot file of leaves in cells of ``resolution`` [m]."""
    nodes = FileNodes(*_nodes(*leaves))
    packed = np.empty(len(nodes.value), dtype=NODE)
    packed["value"], packed["children"] = nodes.value, nodes.children
    return _header(FULL, len(packed), resolution) + packed.tobytes()


def to_bt(leaves: Leaves, resolution: float) -> bytes:
    """Content of a .bt file of leaves in cells of ``resolution`` [m]; how sure a cell is is lost."""
    nodes = FileNodes(*_nodes(*likeliest(leaves, LOWEST, HIGHEST)))
    inner = nodes.pairs[nodes.children > 0]
    return _header(BINARY, len(nodes.value), resolution) + inner.astype("<u2").tobytes()


def _header(first: str, size: int, resolution: float) -> bytes:
    return f"{first}{COMMENT}id OcTree\nsize {size}\nres {resolution:g}\ndata\n".encode()


def read_octree(data: bytes, name: str) -> Octree:
    """Map in the content of a .bt or .ot file; name: of the file. Raises BadInput."""
    first, resolution, size, body = _read_header(data, name)
    if first == BINARY:
        pairs = np.frombuffer(body[: len(body) // 2 * 2], dtype="<u2").astype(np.uint16)
        codes, depths, values, count = _read_binary(pairs, (LOWEST, HIGHEST)) if size else _NOTHING
    else:
        packed = np.frombuffer(body[: len(body) // NODE.itemsize * NODE.itemsize], dtype=NODE)
        codes, depths, values, count = _read_full(packed["value"].copy(), packed["children"].copy()) if size else _NOTHING
    if count != size:
        raise BadInput(
            f"{name}: the header says {size} nodes, but the data are {'cut short' if count < 0 else f'{count}'}; copy the file again"
        )
    if not np.isfinite(values).all():
        raise BadInput(f"{name}: a cell's log-odds are not finite; the file is damaged")
    order = np.argsort(codes)
    try:
        return octree_of(pruned(Leaves(codes[order], depths[order], values[order])), resolution)
    except TooLarge as error:
        raise BadInput(f"{name}: {error}") from None


_NOTHING = (np.empty(0, dtype=np.int64), np.empty(0, dtype=np.uint8), np.empty(0, dtype=np.float32), 0)


def _read_header(data: bytes, name: str) -> tuple[str, float, int, bytes]:
    """First line, resolution [m], number of nodes, and what comes after the header."""
    if not data.startswith((FULL.encode(), BINARY.encode())):
        raise BadInput(f"{name}: no OctoMap file; the first line of one is '{BINARY}' or '{FULL}'")
    end = HEADER_END.search(data)
    if end is None:
        raise BadInput(f"{name}: the header has no line 'data'; the file is cut short")
    lines = [line.strip() for line in data[: end.start()].decode("ascii", "replace").splitlines()]
    fields = {key: value for key, _, value in (line.partition(" ") for line in lines) if not key.startswith("#")}
    if fields.get("id") != "OcTree":
        raise BadInput(f"{name}: a tree of kind '{fields.get('id', '')}'; only 'OcTree' is read")
    try:
        resolution, size = float(fields["res"]), int(fields["size"])
    except (KeyError, ValueError):
        raise BadInput(f"{name}: the header says no 'res' and 'size' as numbers") from None
    if not (0.0 < resolution < np.inf and size >= 0):
        raise BadInput(f"{name}: res {resolution:g}, size {size}: both must be above zero")
    return lines[0], resolution, size, data[end.end() :]


@compiled
def _shared(a: int, b: int) -> int:
    """Depth of the smallest node that holds both cells."""
    depth = DEPTH
    differing = a ^ b
    while differing:
        differing >>= 3
        depth -= 1
    return depth


@compiled
def _nodes(codes: Ints, depths: Bytes, values: Singles) -> tuple[Singles, Bytes, Pairs]:
    """All nodes above and at the leaves, see ``FileNodes``; the codes rise."""
    count = 0
    for i in range(codes.shape[0]):
        count += int(depths[i]) - (_shared(codes[i], codes[i - 1]) if i else -1)
    value, children, pairs = np.empty(count, dtype=np.float32), np.zeros(count, dtype=np.uint8), np.zeros(count, dtype=np.uint16)
    at = np.zeros(DEPTH + 1, dtype=np.int64)
    n, deepest = 0, -1
    for i in range(codes.shape[0]):
        depth = int(depths[i])
        shared = _shared(codes[i], codes[i - 1]) if i else -1
        for level in range(deepest, shared, -1):
            if level > 0:
                value[at[level - 1]] = max(value[at[level - 1]], value[at[level]])
        for level in range(shared + 1, depth + 1):
            at[level] = n
            value[n] = values[i]
            if level > 0:
                child = (codes[i] >> (3 * (DEPTH - level))) & 7
                kind = 3 if level < depth else (2 if values[i] >= 0.0 else 1)
                children[at[level - 1]] |= np.uint8(1 << child)
                pairs[at[level - 1]] |= np.uint16(kind << (2 * child))
            n += 1
        deepest = depth
    for level in range(deepest, 0, -1):
        value[at[level - 1]] = max(value[at[level - 1]], value[at[level]])
    return value, children, pairs


@compiled
def _read_full(value: Singles, children: Bytes) -> tuple[Ints, Bytes, Singles, int]:
    """The leaves, and how many nodes there are; -1: the data end too early, or go too deep."""
    codes, depths, values = np.empty(value.shape[0], dtype=np.int64), np.empty(value.shape[0], dtype=np.uint8), np.empty_like(value)
    open_codes, open_depths = np.zeros(8 * DEPTH + 8, dtype=np.int64), np.zeros(8 * DEPTH + 8, dtype=np.int64)
    waiting, n, leaves = 1, 0, 0
    while waiting > 0:
        waiting -= 1
        code, depth = open_codes[waiting], open_depths[waiting]
        if n >= value.shape[0] or (children[n] and depth >= DEPTH):
            return codes[:0], depths[:0], values[:0], -1
        if not children[n]:
            codes[leaves], depths[leaves], values[leaves] = code, depth, value[n]
            leaves += 1
        for child in range(7, -1, -1):
            if children[n] & np.uint8(1 << child):
                open_codes[waiting], open_depths[waiting] = code | child << (3 * (DEPTH - 1 - depth)), depth + 1
                waiting += 1
        n += 1
    return codes[:leaves], depths[:leaves], values[:leaves], n


@compiled
def _read_binary(pairs: Pairs, sure: tuple[np.float32, np.float32]) -> tuple[Ints, Bytes, Singles, int]:
    """As ``_read_full``; sure: log-odds of what is free and of what is occupied."""
    most = 8 * pairs.shape[0]
    codes, depths, values = np.empty(most, dtype=np.int64), np.empty(most, dtype=np.uint8), np.empty(most, dtype=np.float32)
    open_codes, open_depths = np.zeros(8 * DEPTH + 8, dtype=np.int64), np.zeros(8 * DEPTH + 8, dtype=np.int64)
    waiting, n, leaves = 1, 0, 0
    while waiting > 0:
        waiting -= 1
        code, depth = open_codes[waiting], open_depths[waiting]
        if n >= pairs.shape[0] or depth >= DEPTH:
            return codes[:0], depths[:0], values[:0], -1
        for child in range(7, -1, -1):
            kind = (pairs[n] >> np.uint16(2 * child)) & np.uint16(3)
            below = code | child << (3 * (DEPTH - 1 - depth))
            if kind == 3:
                open_codes[waiting], open_depths[waiting] = below, depth + 1
                waiting += 1
            elif kind:
                codes[leaves], depths[leaves], values[leaves] = below, depth + 1, sure[0] if kind == 1 else sure[1]
                leaves += 1
        n += 1
    return codes[:leaves], depths[:leaves], values[:leaves], n + leaves
