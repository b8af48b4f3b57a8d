"""The skeleton of free ground: what is left when cells are taken away, nearest to obstacles first, as long as nothing is torn apart.

Ordered homotopic thinning (Vincent 1991; Talbot & Vincent 1992), anchored at the ridge of the distance field, whose cells have their
nearest obstacles on opposite sides: the generalised Voronoi diagram (Choset & Burdick, "Sensor-based exploration", IJRR 19 (2000)).
"""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

OPPOSITE = -0.5
"""Cosine of the angle between the nearest obstacles, below which they lie on opposite sides: 120 degrees; corners of rooms have less."""


def skeleton(free: Mask) -> Mask:
    """The cells (rows, columns) of the skeleton of free ground, in as many four-connected parts as that is."""
    padded = np.pad(free, 1, constant_values=False)
    distance, nearest = ndimage.distance_transform_edt(padded, return_indices=True)
    left = padded.copy()
    cells = np.flatnonzero(padded)
    order = cells[np.argsort(distance.ravel()[cells], kind="stable")]
    flat, anchored = left.ravel(), _ridge(padded, nearest).ravel()
    while len(order):
        order = _thin(flat, anchored, padded.shape[1], order)
    return np.ascontiguousarray(left[1:-1, 1:-1])


def _ridge(free: Mask, nearest: NDArray[np.int32]) -> Mask:
    """Cells whose nearest obstacle lies opposite to that of a cell beside them; ``nearest`` (2, rows, columns): row and column of it."""
    rows, columns = np.indices(free.shape)
    to = np.stack((nearest[0] - rows, nearest[1] - columns)).astype(np.float64)
    size = np.maximum(np.hypot(to[0], to[1]), 1.0)
    ridge = np.zeros(free.shape, dtype=np.bool_)
    for here, beside in (((slice(None), slice(1, None)), (slice(None), slice(None, -1))), ((slice(1, None),), (slice(None, -1),))):
        cosine = (to[(slice(None), *here)] * to[(slice(None), *beside)]).sum(axis=0) / (size[here] * size[beside])
        # Of two cells that meet on a ridge one is enough, or corridors of even width have two lines.
        ridge[here] |= (cosine < OPPOSITE) & free[here] & free[beside] & (size[here] >= size[beside])
        ridge[beside] |= (cosine < OPPOSITE) & free[here] & free[beside] & (size[here] < size[beside])
    return ridge


@compiled
def _is_simple(left: Mask, i: int, columns: int) -> bool:
    """Whether taking cell ``i`` away tears nothing apart and makes no hole: its four-connectivity number is 1 (Yokoi et al. 1975)."""
    a, b, c = left[i + 1], left[i + 1 + columns], left[i + columns]
    d, e, f = left[i - 1 + columns], left[i - 1], left[i - 1 - columns]
    g, h = left[i - columns], left[i + 1 - columns]
    number = int(a) - int(a and b and c) + int(c) - int(c and d and e) + int(e) - int(e and f and g) + int(g) - int(g and h and a)
    return number == 1


@compiled
def _thin(left: Mask, anchored: Mask, columns: int, order: Ints) -> Ints:
    """Takes cells away in their order, once through; those to be looked at again, none when nothing has changed."""
    again = np.empty(order.size, dtype=np.int64)
    n, taken = 0, 0
    for k in range(order.size):
        i = order[k]
        if anchored[i]:
            continue
        if _is_simple(left, i, columns):
            left[i] = False
            taken += 1
        else:
            again[n] = i
            n += 1
    return again[:n] if taken > 0 else again[:0]
