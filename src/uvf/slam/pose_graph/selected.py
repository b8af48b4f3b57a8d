"""The diagonal blocks of the inverse of a factorised matrix: covariances of all poses at once.

Takahashi, Fagan, Chen, "Formation of a Sparse Bus Impedance Matrix" (1973), front by front from the root of the tree: with
L = [A; B] the columns of a supernode, X = B A^-1 and Z the inverse over its rows, the inverse over its pivots is
A^-T A^-1 + X^T Z X and that between rows and pivots -Z X.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.pose_graph.fronts import Tree

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@compiled
def _take(tree: Tree, s: int, whole: Floats, at: Ints, inverse: Floats, columns: int) -> None:
    """The inverse over the rows of supernode s, out of that over the front of its parent."""
    parent, first = tree.parents[s], tree.row_starts[s]
    size = 3 * (tree.starts[parent + 1] - tree.starts[parent] + tree.row_starts[parent + 1] - tree.row_starts[parent])
    above = whole[at[parent] : at[parent] + size * size].reshape(size, size)
    count = tree.row_starts[s + 1] - first
    for j in range(count):
        for i in range(count):
            c, r = columns + 3 * j, columns + 3 * i
            for a in range(3):
                for b in range(3):
                    inverse[c + a, r + b] = above[3 * tree.inside[first + j] + a, 3 * tree.inside[first + i] + b]


@compiled
def _divide(panel: Floats, columns: int) -> None:
    """Columns [A; B] of the factor become [A^-1; B A^-1], A lower triangular; row c of ``panel`` is column c."""
    size = panel.shape[1]
    for c in range(columns - 1, -1, -1):
        scale = 1.0 / panel[c, c]
        for r in range(c + 1, size):
            panel[c, r] *= scale
        panel[c, c] = scale
    for c in range(columns - 1, -1, -1):
        for k in range(columns - 1, c, -1):
            f = panel[c, k]
            panel[c, k] = 0.0
            for r in range(k, size):
                panel[c, r] -= f * panel[k, r]


@compiled
def _close(panel: Floats, inverse: Floats, columns: int) -> None:
    """The inverse over the pivots and between them and the rows, from that over the rows."""
    size = panel.shape[1]
    for c in range(columns):
        for r in range(columns, size):
            inverse[c, r] = 0.0
        for k in range(columns, size):
            f = panel[c, k]
            for r in range(columns, size):
                inverse[c, r] -= f * inverse[k, r]
        for r in range(columns, size):
            inverse[r, c] = inverse[c, r]
    for c in range(columns):
        for d in range(c, columns):
            total = 0.0
            for k in range(d, columns):
                total += panel[c, k] * panel[d, k]
            for k in range(columns, size):
                total -= panel[d, k] * inverse[c, k]
            inverse[c, d] = inverse[d, c] = total


@compiled
def diagonal_of_inverse(tree: Tree, panels: Floats) -> Floats:
    """Diagonal blocks (n, 3, 3) of the inverse, by pose."""
    supernodes = tree.sequence.shape[0]
    at = np.zeros(supernodes + 1, np.int64)
    for s in range(supernodes):
        size = 3 * (tree.starts[s + 1] - tree.starts[s] + tree.row_starts[s + 1] - tree.row_starts[s])
        at[s + 1] = at[s] + size * size
    whole, out = np.empty(at[supernodes]), np.empty((tree.pivots.shape[0], 3, 3))
    for s in tree.sequence[::-1]:
        columns = 3 * (tree.starts[s + 1] - tree.starts[s])
        size = columns + 3 * (tree.row_starts[s + 1] - tree.row_starts[s])
        inverse = whole[at[s] : at[s + 1]].reshape(size, size)
        panel = panels[tree.panels[s] : tree.panels[s] + columns * size].copy().reshape(columns, size)
        if size > columns:
            _take(tree, s, whole, at, inverse, columns)
        _divide(panel, columns)
        _close(panel, inverse, columns)
        for k in range(tree.starts[s], tree.starts[s + 1]):
            c = 3 * (k - tree.starts[s])
            for a in range(3):
                for b in range(3):
                    out[tree.pivots[k], a, b] = inverse[c + a, c + b]
    return out
