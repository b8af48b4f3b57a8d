"""Cholesky factorisation of the normal matrix front by front, and the solution of what it was factorised for.

A front is kept by columns: front[c, r] is the element in row r >= c of column c, so that a column lies in one piece.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.slam.pose_graph.fronts import Tree
from uvf.slam.pose_graph.linearise import Normal

Floats = NDArray[np.float64]

PANEL = 24
"""Columns that are eliminated before the rest of a front is touched, which may not fit into the cache."""


@compiled
def _add_entries(tree: Tree, s: int, normal: Normal, damping: float, front: Floats) -> None:
    """The blocks of the normal matrix in the columns of supernode s."""
    first = tree.starts[s]
    for k in range(first, tree.starts[s + 1]):
        block, at = normal.diagonal[tree.pivots[k]], 3 * (k - first)
        for a in range(3):
            for b in range(a, 3):
                front[at + a, at + b] = block[b, a]
            front[at + a, at + a] += damping
    for k in range(tree.entry_starts[s], tree.entry_starts[s + 1]):
        block, c, r = normal.between[tree.entries[k, 0]], 3 * tree.entries[k, 1], 3 * tree.entries[k, 2]
        for a in range(3):
            for b in range(3):
                front[c + a, r + b] = block[a, b]


@compiled
def _add_child(tree: Tree, child: int, updates: Floats, front: Floats) -> None:
    """What a child has left."""
    first, count = tree.row_starts[child], tree.row_starts[child + 1] - tree.row_starts[child]
    at = tree.updates[child]
    left = updates[at : at + 9 * count * count].reshape(3 * count, 3 * count)
    for j in range(count):
        c = 3 * tree.inside[first + j]
        for i in range(j, count):
            r = 3 * tree.inside[first + i]
            for a in range(3):
                for b in range(3):
                    front[c + a, r + b] += left[3 * j + a, 3 * i + b]


@compiled
def _narrow(front: Floats, first: int, last: int) -> bool:
    """Cholesky of the columns from ``first`` to ``last``, without a look at those behind; False: not positive definite."""
    size = front.shape[0]
    for k in range(first, last, 3):
        for a in range(k, k + 3):
            if not front[a, a] > 0.0:
                return False
            scale = 1.0 / np.sqrt(front[a, a])
            for r in range(a, size):
                front[a, r] *= scale
            for c in range(a + 1, k + 3):
                f = front[a, c]
                for r in range(c, size):
                    front[c, r] -= f * front[a, r]
        for c in range(k + 3, last, 3):
            _subtract(front, k, c)
    return True


@compiled
def _subtract(front: Floats, k: int, c: int) -> None:
    """What the three columns from k leave in the three from c."""
    one, two, three = front[k], front[k + 1], front[k + 2]
    u, v, w = front[c], front[c + 1], front[c + 2]
    u1, u2, u3, v1, v2, v3, w1, w2, w3 = (
        one[c],
        two[c],
        three[c],
        one[c + 1],
        two[c + 1],
        three[c + 1],
        one[c + 2],
        two[c + 2],
        three[c + 2],
    )
    for r in range(c, front.shape[0]):
        x, y, z = one[r], two[r], three[r]
        u[r] -= u1 * x + u2 * y + u3 * z
        v[r] -= v1 * x + v2 * y + v3 * z
        w[r] -= w1 * x + w2 * y + w3 * z


@compiled
def _eliminate(front: Floats, columns: int) -> bool:
    """Cholesky of the first ``columns`` of a front and what it leaves in the others; False: not positive definite."""
    for first in range(0, columns, PANEL):
        last = min(first + PANEL, columns)
        if not _narrow(front, first, last):
            return False
        for c in range(last, front.shape[0], 3):
            for k in range(first, last, 3):
                _subtract(front, k, c)
    return True


@compiled
def factorise(tree: Tree, normal: Normal, damping: float, panels: Floats, updates: Floats) -> bool:
    """Fills ``panels`` and ``updates`` with the factor of the normal matrix plus ``damping`` [1/m^2, 1/rad^2] on its diagonal.

    Blocks between poses are [a, b] = (a of the pose eliminated first, b of the other). False: not positive definite.
    """
    largest = 0
    for s in tree.sequence:
        largest = max(largest, tree.starts[s + 1] - tree.starts[s] + tree.row_starts[s + 1] - tree.row_starts[s])
    space = np.empty(9 * largest * largest)
    for s in tree.sequence:
        columns = 3 * (tree.starts[s + 1] - tree.starts[s])
        size = columns + 3 * (tree.row_starts[s + 1] - tree.row_starts[s])
        front = space[: size * size].reshape(size, size)
        front[:] = 0.0
        _add_entries(tree, s, normal, damping, front)
        for k in range(tree.child_starts[s], tree.child_starts[s + 1]):
            _add_child(tree, tree.children[k], updates, front)
        if not _eliminate(front, columns):
            return False
        at = tree.panels[s]
        for k in range(columns * size):
            panels[at + k] = space[k]
        at, rest = tree.updates[s], size - columns
        for c in range(rest):
            for r in range(rest):
                updates[at + c * rest + r] = front[columns + c, columns + r]
    return True


@compiled
def _forward(tree: Tree, s: int, panels: Floats, x: Floats) -> None:
    pivots, rows = tree.starts[s + 1] - tree.starts[s], tree.row_starts[s + 1] - tree.row_starts[s]
    columns, at = 3 * pivots, tree.panels[s]
    size = columns + 3 * rows
    for c in range(columns):
        column = panels[at + c * size : at + (c + 1) * size]
        v = x[3 * tree.starts[s] + c] / column[c]
        x[3 * tree.starts[s] + c] = v
        for r in range(c + 1, columns):
            x[3 * tree.starts[s] + r] -= column[r] * v
        for k in range(rows):
            r, row = columns + 3 * k, 3 * tree.rows[tree.row_starts[s] + k]
            for a in range(3):
                x[row + a] -= column[r + a] * v


@compiled
def _backward(tree: Tree, s: int, panels: Floats, x: Floats) -> None:
    pivots, rows = tree.starts[s + 1] - tree.starts[s], tree.row_starts[s + 1] - tree.row_starts[s]
    columns, at = 3 * pivots, tree.panels[s]
    size = columns + 3 * rows
    for c in range(columns - 1, -1, -1):
        column = panels[at + c * size : at + (c + 1) * size]
        v = x[3 * tree.starts[s] + c]
        for k in range(rows):
            r, row = columns + 3 * k, 3 * tree.rows[tree.row_starts[s] + k]
            for a in range(3):
                v -= column[r + a] * x[row + a]
        for r in range(c + 1, columns):
            v -= column[r] * x[3 * tree.starts[s] + r]
        x[3 * tree.starts[s] + c] = v / column[c]


@compiled
def solve(tree: Tree, panels: Floats, right: Floats) -> Floats:
    """Solutions (k, n, 3) for k right sides (k, n, 3), by pose."""
    n = tree.pivots.shape[0]
    out, x = np.empty_like(right), np.empty(3 * n)
    for side in range(right.shape[0]):
        for k in range(n):
            for a in range(3):
                x[3 * k + a] = right[side, tree.pivots[k], a]
        for s in tree.sequence:
            _forward(tree, s, panels, x)
        for s in tree.sequence[::-1]:
            _backward(tree, s, panels, x)
        for k in range(n):
            for a in range(3):
                out[side, tree.pivots[k], a] = x[3 * k + a]
    return out
