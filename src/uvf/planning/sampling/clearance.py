"""Where a body of discs may be: a field of clearances, looked up along curves in steps as long as the room there allows.

A point counts as its cell does: a disc is free where the clearance of the cell below its centre is at least its radius, as on a costmap.
"""

from math import cos, floor, inf, isfinite, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, moved
from uvf.maths.grids import distance_field

Floats = NDArray[np.float64]

SHORT = 0.2
"""Cells: the step where there is no room for a longer one."""
HALF_DIAGONAL = 0.70711


class ClearanceField(NamedTuple):
    """``values`` (rows, columns) [m] to the nearest obstacle's edge; ``resolution`` [m]; ``x``, ``y`` [m] of cell [0, 0]'s lower corner."""

    values: NDArray[np.float32]
    resolution: float
    x: float
    y: float


class Body(NamedTuple):
    """A footprint as discs: their ``offsets`` (k,) [m] ahead of the reference point along the body's axis, and ``radii`` (k,) [m]."""

    offsets: Floats
    radii: Floats


def clearance_field(occupied: NDArray[np.bool_], resolution: float, origin: tuple[float, float] = (0.0, 0.0)) -> ClearanceField:
    """The field of an ``occupied`` grid (rows, columns): from each cell's centre to half a cell before the nearest occupied centre [m].

    origin: (x, y) [m] of the lower corner of cell [0, 0]. Raises ValueError for an empty grid or a resolution that is not positive.
    """
    values = (distance_field(np.ascontiguousarray(occupied, dtype=np.bool_)) - 0.5) * resolution if np.size(occupied) else np.empty((0, 0))
    return checked_field(ClearanceField(values.astype(np.float32), resolution, *origin))


def checked_field(field: ClearanceField) -> ClearanceField:
    """The same, contiguous. Raises ValueError for a field without cells, with NaN, or a resolution that is not positive."""
    values = np.ascontiguousarray(field.values, dtype=np.float32)
    if values.ndim != 2 or not values.size:
        raise ValueError(f"values: a field of shape {values.shape}; it takes (rows, columns), at least one of each")
    if np.isnan(values).any():
        raise ValueError("values: there is NaN in the field; unknown cells take a clearance of 0 m, or what they are thought to have")
    if not (field.resolution > 0 and isfinite(field.resolution) and isfinite(field.x) and isfinite(field.y)):
        raise ValueError(f"a field of resolution {field.resolution} m at ({field.x}, {field.y}) m; it must be positive, all finite")
    return ClearanceField(values, float(field.resolution), float(field.x), float(field.y))


def disc(radius: float) -> Body:
    """The body of a round vehicle of ``radius`` [m]."""
    return discs([(0.0, radius)])


def discs(parts: list[tuple[float, float]]) -> Body:
    """A body of (offset [m], radius [m]) along its axis. Raises ValueError for none, and for a radius that is negative or not finite."""
    array = np.array(parts, dtype=np.float64).reshape(-1, 2)
    if not len(array) or not np.isfinite(array).all() or (array[:, 1] < 0).any():
        raise ValueError(f"a body of discs {parts}; it takes at least one (offset [m], radius [m]), finite, no radius negative")
    return Body(np.ascontiguousarray(array[:, 0]), np.ascontiguousarray(array[:, 1]))


def rectangle(ahead: float, behind: float, width: float, count: int) -> Body:
    """``count`` equal discs that cover a rectangle reaching ``ahead`` and ``behind`` [m] of the reference point, ``width`` [m] wide."""
    pitch = (ahead + behind) / count
    radius = 0.5 * float(np.hypot(pitch, width))
    return discs([(-behind + (i + 0.5) * pitch, radius) for i in range(count)])


@compiled
def _cell(field: ClearanceField, x: float, y: float) -> tuple[int, int]:
    return floor((y - field.y) / field.resolution), floor((x - field.x) / field.resolution)


@compiled
def _is_free(field: ClearanceField, row: int, column: int, radius: float) -> bool:
    rows, columns = field.values.shape
    return 0 <= row < rows and 0 <= column < columns and bool(field.values[row, column] >= radius)


@compiled
def room(field: ClearanceField, x: float, y: float, radius: float) -> float:
    """How far [m] the centre of a disc may move any way on free cells; 0 where only its own cell is sure, negative where it is not free."""
    row, column = _cell(field, x, y)
    if not _is_free(field, row, column, radius):
        return -1.0
    u, v = (x - field.x) / field.resolution, (y - field.y) / field.resolution
    rows, columns = field.values.shape
    border = min(u, columns - u, v, rows - v) * field.resolution
    aside = sqrt((u - column - 0.5) ** 2 + (v - row - 0.5) ** 2)
    inner: float = field.values[row, column] - radius - (aside + HALF_DIAGONAL) * field.resolution
    least: float = max(min(border, inner), 0.0)
    return least


@compiled
def is_clear(field: ClearanceField, body: Body, at: Triple, facing: float) -> bool:
    """Whether every disc of the body is free at a configuration; ``facing`` -1: the body looks against the heading."""
    for i in range(body.radii.size):
        ahead = facing * body.offsets[i]
        row, column = _cell(field, at[0] + ahead * cos(at[2]), at[1] + ahead * sin(at[2]))
        if not _is_free(field, row, column, body.radii[i]):
            return False
    return True


@compiled
def _cuts_corner(field: ClearanceField, body: Body, before: Triple, at: Triple, facing: float) -> bool:
    """Whether a disc has moved across a corner of a cell that is not free, on a short step from ``before``."""
    for i in range(body.radii.size):
        ahead = facing * body.offsets[i]
        row, column = _cell(field, before[0] + ahead * cos(before[2]), before[1] + ahead * sin(before[2]))
        to_row, to_column = _cell(field, at[0] + ahead * cos(at[2]), at[1] + ahead * sin(at[2]))
        if row != to_row and column != to_column:
            radius = body.radii[i]
            if not (_is_free(field, row, to_column, radius) and _is_free(field, to_row, column, radius)):
                return True
    return False


@compiled
def _step(field: ClearanceField, body: Body, at: Triple, curvature: float, facing: float) -> float:
    """How far [m] the body may drive along a curvature [1/m] on free cells, at least a short step; negative where it is not free."""
    step = inf
    c, s = cos(at[2]), sin(at[2])
    for i in range(body.radii.size):
        ahead = facing * body.offsets[i]
        least = room(field, at[0] + ahead * c, at[1] + ahead * s, body.radii[i])
        if least < 0.0:
            return -1.0
        step = min(step, max(least, SHORT * field.resolution) / sqrt(1.0 + (curvature * ahead) ** 2))
    return step


@compiled
def _bulges(field: ClearanceField, body: Body, at: Triple, curvature: float, facing: float) -> bool:
    """Whether the arc of a short step may leave free cells although both its ends are on them: between them it bulges, by so little."""
    bulge = 0.5 * abs(curvature) * (SHORT * field.resolution) ** 2
    for i in range(body.radii.size):
        ahead, radius = facing * body.offsets[i], body.radii[i]
        x, y = at[0] + ahead * cos(at[2]), at[1] + ahead * sin(at[2])
        for side in (-bulge, bulge):
            row, column = _cell(field, x, y + side)
            to_row, to_column = _cell(field, x + side, y)
            if not (_is_free(field, row, column, radius) and _is_free(field, to_row, to_column, radius)):
                return True
    return False


@compiled
def free_length(field: ClearanceField, body: Body, start: Triple, segments: Floats, facing: float) -> float:
    """Distance [m] that the body can drive along segments (k, 2) from ``start`` until it is not free; the whole length where it can.

    Sphere stepping: nothing can be met within the room that the field shows. A start that is not free gives -1.
    """
    done, safe, at, total = 0.0, -1.0, start, np.abs(segments[:, 0]).sum()
    before, was_short = start, False
    for k in range(segments.shape[0]):
        length, direction, curvature = abs(segments[k, 0]), (1.0 if segments[k, 0] >= 0.0 else -1.0), segments[k, 1]
        if length == 0.0:
            continue
        begin, s = at, 0.0
        while True:
            step = _step(field, body, at, curvature, facing)
            is_short = step <= SHORT * field.resolution
            is_end = done + s == 0.0 or done + s >= total
            if step < 0.0 or (was_short and _cuts_corner(field, body, before, at, facing)):
                return safe
            if is_short and curvature != 0.0 and not is_end and _bulges(field, body, at, curvature, facing):
                return safe
            safe = done + s
            if s >= length:
                break
            before, was_short = at, is_short
            s = min(s + step, length)
            at = moved(begin[0], begin[1], begin[2], curvature, direction * s)
        done += length
    return done


@compiled
def is_free_way(field: ClearanceField, body: Body, start: Triple, segments: Floats, facing: float) -> bool:
    """Whether the body can drive all of the segments (k, 2) from ``start``."""
    total = 0.0
    for k in range(segments.shape[0]):
        total += abs(segments[k, 0])
    if total == 0.0:
        return is_clear(field, body, start, facing)
    return free_length(field, body, start, segments, facing) >= total
