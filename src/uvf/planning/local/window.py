"""What a local planner looks at: costs and shut headings about the vehicle, and how far it is to the goal from each cell."""

from dataclasses import dataclass
from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.headings import blocked_headings
from uvf.planning.costmap.inflation import LETHAL, NO_INFORMATION
from uvf.planning.search.grid_search import GridSearch

Bytes = NDArray[np.uint8]
Mask = NDArray[np.bool_]
Cells = NDArray[np.int64]
Bits = NDArray[np.uint64]
Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Point = tuple[float, float]

UNREACHED = 1e3
"""m to go from where no way leads to the goal."""


class Grids(NamedTuple):
    """Arrays (rows, columns) that rollouts look up; the first is the vehicle's window, the others have its shape."""

    values: Bytes
    """0 to 254; unknown ground counts as free."""
    seen: Mask
    """Whether a cell is known."""
    blocked: Bits
    """Bit ``heading_bin(yaw)`` set: the footprint touches an obstacle."""
    close: Bits
    """The same for the footprint with the soft margin round it, and on ground that has not been seen: what stands there is not known."""
    to_go: Floats32
    """m to the goal, longer where it is dear."""
    off_path: Floats32
    """m to the path."""
    frame: tuple[float, float, float]
    """x, y [m] of the corner of cell [0, 0], resolution [m]."""


@dataclass(frozen=True)
class WindowSettings:
    """The window about the vehicle."""

    size: float = 6.0  # m, its side
    soft_margin: float = 0.08  # m round the footprint that is entered at a price, slowly


def local_window(costs: Costmap, here: Point, path: Floats, factors: Floats, settings: WindowSettings) -> Grids:
    """The window about ``here`` [m], with the way to go along ``path`` (n, 2) [m], n >= 1, all in the costmap's frame.

    The way to go is that of a Dijkstra search over the window from the last point of the path that lies in it and is free, with
    the length of the path beyond: so a local planner sees the way round what was not there when the path was planned.
    factors: (256,) cost factors [-] by value.
    """
    half = max(ceil(settings.size / 2 / costs.resolution), 2)
    row, column = costs.cell(*here)
    shape = costs.values.shape
    window = tuple(
        slice(max(min(at, n - 1) - half, 0), max(min(at, n - 1), 0) + half + 1) for at, n in zip((row, column), shape, strict=True)
    )
    values = np.ascontiguousarray(costs.values[window])
    corner = (costs.origin[0] + window[1].start * costs.resolution, costs.origin[1] + window[0].start * costs.resolution)
    cells = np.floor((path[:, ::-1] - corner[::-1]) / costs.resolution).astype(np.int64)
    inside = ((cells >= 0) & (cells < values.shape)).all(axis=1)
    to_go, off_path = np.full(values.shape, UNREACHED), np.full(values.shape, UNREACHED)
    run, good = _in_window(values, cells, inside, factors)
    here_in_window = (min(max(row - window[0].start, 0), values.shape[0] - 1), min(max(column - window[1].start, 0), values.shape[1] - 1))
    for seed in _seeds(run, good):
        beyond = float(np.hypot(*np.diff(path[seed:], axis=0).T).sum())
        field = GridSearch(values, factors).cost_to_go((int(cells[seed, 0]), int(cells[seed, 1]))).cost * costs.resolution + beyond
        to_go = np.where(np.isfinite(field), field, UNREACHED)
        if to_go[here_in_window] < UNREACHED:
            break
    if inside.any():
        marks = np.zeros(values.shape, dtype=np.bool_)
        marks[cells[inside, 0], cells[inside, 1]] = True
        off_path = distance_field(marks) * costs.resolution
    occupied, seen = values == LETHAL, values != NO_INFORMATION
    values[~seen] = 0
    blocked, close = (
        blocked_headings(occupied, costs.resolution, footprint)
        for footprint in (costs.footprint, costs.footprint.padded(settings.soft_margin))
    )
    close |= blocked_headings(~seen, costs.resolution, costs.footprint)
    return Grids(values, seen, blocked, close, to_go.astype(np.float32), off_path.astype(np.float32), (*corner, costs.resolution))


def _in_window(values: Bytes, cells: Cells, inside: Mask, factors: Floats) -> tuple[Cells, Mask]:
    """Indices (k,) of the path's points in the window before it leaves it for the first time, and which of them are passable (k,)."""
    first = np.flatnonzero(inside)
    gaps = np.flatnonzero(np.diff(first) > 1)
    run = first[: gaps[0] + 1] if len(gaps) else first
    return run, factors[values[cells[run, 0], cells[run, 1]]] >= 0.0


def _seeds(run: Cells, good: Mask) -> list[int]:
    """Indices of the points of the path from which the way to go is measured, the better ones first.

    That is the last one in the window that is passable; where something across the whole window lies before it, the last one
    that is passable before the first that is not.
    """
    if not good.any():
        return []
    begin = int(np.argmax(good))
    block = begin + int(np.argmin(good[begin:])) if not good[begin:].all() else len(run)
    return [int(run[np.flatnonzero(good)[-1]]), int(run[block - 1])]
