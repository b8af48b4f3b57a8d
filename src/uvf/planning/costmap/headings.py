"""In which headings a footprint touches an obstacle: 64 bits a cell, one for each of 64 headings.

A pose is then checked against the whole outline by one look-up. Each obstacle cell marks the cells round it by a stencil made once
for the footprint: those places and headings at which the outline covers it (the Minkowski sum of configuration spaces, cell by cell).
"""

from functools import lru_cache
from math import ceil, pi, tau

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.footprint import RobotFootprint

Bits = NDArray[np.uint64]
Floats = NDArray[np.float64]
Offsets = NDArray[np.int32]
Mask = NDArray[np.bool_]

HEADINGS = 64
STEP = tau / HEADINGS  # rad between two headings


@compiled
def heading_bin(yaw: float) -> int:
    """The bin, 0 to 63, whose heading is nearest to ``yaw`` [rad]."""
    found: int = int(np.floor(yaw / STEP + 0.5)) & 63
    return found


@lru_cache(maxsize=32)
def stencil(footprint: RobotFootprint, resolution: float) -> tuple[Offsets, Bits]:
    """(n, 2) offsets (rows, columns) from an obstacle cell to the vehicle's cell, and (n,) bits of the headings in which it is touched.

    The obstacle is a point at its cell's centre, as costmap_2d takes it for the inscribed radius too; headings between two bins
    are covered by looking at both of a bin's borders as well.
    """
    reach = ceil(footprint.circumscribed_radius / resolution) + 1
    steps = np.arange(-reach, reach + 1)
    rows, columns = (part.ravel() for part in np.meshgrid(steps, steps, indexing="ij"))
    sides = footprint.sides()
    bits = np.zeros(len(rows), dtype=np.uint64)
    for heading in range(HEADINGS):
        covered = np.zeros(len(rows), dtype=np.bool_)
        for yaw in (heading - 0.5, heading, heading + 0.5):
            cosine, sine = np.cos(yaw * STEP), np.sin(yaw * STEP)
            # The obstacle as the vehicle sees it: it lies at minus the offset.
            x, y = -columns * resolution, -rows * resolution
            in_base = np.stack((cosine * x + sine * y, cosine * y - sine * x))
            covered |= (sides[:, :2] @ in_base <= sides[:, 2:] + 1e-9).all(axis=0)
        bits |= np.where(covered, np.uint64(1) << np.uint64(heading), np.uint64(0))
    touched = bits != 0
    return np.column_stack((rows, columns))[touched].astype(np.int32), bits[touched]


@compiled
def mark_headings(occupied: Mask, offsets: Offsets, bits: Bits, out: Bits) -> None:
    """Sets in ``out`` (rows, columns), zeros before, the headings in which the footprint of the stencil touches an occupied cell.

    Cells within an obstacle touch nothing that its border does not; only those beside free cells are stamped, the inside is shut whole.
    """
    rows, columns = occupied.shape
    everything = np.uint64(0xFFFFFFFFFFFFFFFF)
    for r in range(rows):
        for c in range(columns):
            if not occupied[r, c]:
                continue
            inside = 0 < r < rows - 1 and 0 < c < columns - 1
            if inside and occupied[r - 1, c] and occupied[r + 1, c] and occupied[r, c - 1] and occupied[r, c + 1]:
                out[r, c] = everything
                continue
            for k in range(bits.size):
                rr, cc = r + offsets[k, 0], c + offsets[k, 1]
                if 0 <= rr < rows and 0 <= cc < columns:
                    out[rr, cc] |= bits[k]


def blocked_headings(occupied: Mask, resolution: float, footprint: RobotFootprint) -> Bits:
    """(rows, columns) bit ``heading_bin(yaw)`` set: the footprint at the cell's centre with that yaw touches an occupied cell."""
    out = np.zeros(occupied.shape, dtype=np.uint64)
    mark_headings(np.ascontiguousarray(occupied), *stencil(footprint, resolution), out)
    return out


def sector(begin: float, end: float) -> int:
    """Bits of all headings from ``begin`` anticlockwise to ``end`` [rad], both counted."""
    first, n = heading_bin(begin), round(((end - begin) % tau) / STEP)
    if end - begin >= tau - pi / HEADINGS:
        return (1 << HEADINGS) - 1
    bits = 0
    for k in range(n + 1):
        bits |= 1 << ((first + k) % HEADINGS)
    return bits
