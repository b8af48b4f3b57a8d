"""Where ground vehicles drive: the floor or the terrain, and what rises from it without a step, ramps and the platforms behind them.

A surface counts when it slopes by no more than ``STEEPEST`` and its rim lies no more than ``LEDGE`` above or below what is drivable
already; so a ramp is no obstacle, a table top or a kerb stays one. Each spot has one height, the uppermost: there is no driving
under a bridge that can be driven on.
"""

from collections.abc import Iterator
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from uvf.maths.solids import BOX, CYLINDER, SPHERE, TRIANGLE, Solids
from uvf.models.world.terrain import Relief

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
A = TypeVar("A", Floats, Mask)

STEEPEST = float(np.radians(15.0))
STEEPEST_GRADIENT = float(np.tan(STEEPEST)) + 1e-6  # of a surface that is as steep as that by rounding too
LEDGE = 0.01  # m, a threshold that small wheels get over
SIDES = 32  # of a disc


class DrivableGround(NamedTuple):
    """Drivable ground, cell by cell: height (rows, columns) [m, world], slope (rows, columns) as a gradient [-].

    surface: (n,) which primitives are driven on instead of bumped into.
    """

    height: Floats
    slope: Floats
    surface: Mask

    def cliffs(self, resolution: float) -> Mask:
        """Cells (rows, columns), of side ``resolution`` [m], beside a step that a vehicle cannot take, and those that are too steep."""
        found = self.slope > STEEPEST_GRADIENT
        for axis in (0, 1):
            allowed = LEDGE + resolution * np.maximum(*_pairs(self.slope, axis))
            lower, upper = _pairs(self.height, axis)
            step = np.abs(upper - lower) > allowed
            first, second = _pairs(found, axis)
            np.logical_or(first, step, out=first)
            np.logical_or(second, step, out=second)
        return found


class _Face(NamedTuple):
    """An upward face of primitive ``owner`` as cells: rows and columns, heights there [m] and its gradient."""

    owner: int
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    heights: Floats
    lowest: float
    slope: float


def drivable(solids: Solids, xs: Floats, ys: Floats, relief: Relief | None = None) -> DrivableGround:
    """Drivable ground of the cells with centres at ``xs`` (columns,) and ``ys`` (rows,) [m, world]; without ``relief`` on z = 0."""
    height, slope = (np.zeros((len(ys), len(xs))) for _ in range(2)) if relief is None else relief.at(*np.meshgrid(xs, ys))
    ground = DrivableGround(height, slope, np.zeros(len(solids.kinds), dtype=np.bool_))
    rastered = [(owner, corners, _raster(owner, corners, xs, ys)) for owner, corners in _upward(solids)]
    pending = [face for _, _, face in rastered if face is not None]
    pending.sort(key=lambda face: face.lowest)
    resolution = float(xs[1] - xs[0]) if len(xs) > 1 else 1.0
    while True:
        top = float(ground.height.max(initial=0.0)) + LEDGE + resolution
        joined = [face for face in pending if face.lowest <= top and _joins(face, ground, resolution)]
        if not joined:
            break
        for face in joined:
            _lay(face, ground)
        taken = {id(face) for face in joined}
        pending = [face for face in pending if id(face) not in taken]
    for owner, corners in [(owner, corners) for owner, corners, cells in rastered if cells is None]:
        ground.surface[owner] |= _lies_on(corners.mean(axis=0), ground, (xs, ys))
    return ground


def _pairs(values: A, axis: int) -> tuple[A, A]:
    """Views of all neighbours along an axis."""
    return (values[:-1], values[1:]) if axis == 0 else (values[:, :-1], values[:, 1:])


def _upward(solids: Solids) -> Iterator[tuple[int, Floats]]:
    """(owner, (k, 3) corners) of each face that is not too steep."""
    least = np.cos(STEEPEST)
    for i, (kind, row) in enumerate(zip(solids.kinds, solids.rows, strict=True)):
        if kind == TRIANGLE:
            corners = row[:9].reshape(3, 3)
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            if abs(normal[2]) >= least * np.linalg.norm(normal) > 0:
                yield i, corners
        elif kind != SPHERE:
            yield from ((i, corners) for corners in _tops(kind, row, least))


def _tops(kind: int, row: Floats, least: float) -> Iterator[Floats]:
    unit_from_world = row.reshape(3, 4)
    axes = np.linalg.inv(unit_from_world[:, :3])
    centre = -axes @ unit_from_world[:, 3]
    for k in (0, 1, 2) if kind == BOX else (2,):
        up = axes[:, k] * np.sign(axes[2, k])
        if up[2] < least * np.linalg.norm(up) or up[2] == 0:
            continue
        one, other = axes[:, (k + 1) % 3], axes[:, (k + 2) % 3]
        if kind == CYLINDER:
            angles = np.arange(SIDES) * (2 * np.pi / SIDES)
            yield centre + up + np.outer(np.cos(angles), one) + np.outer(np.sin(angles), other)
        else:
            yield np.array([centre + up + a * one + b * other for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def _raster(owner: int, corners: Floats, xs: Floats, ys: Floats) -> _Face | None:
    """The cells whose centres lie under a face; None when there are none."""
    low, high = corners.min(axis=0), corners.max(axis=0)
    columns = np.arange(np.searchsorted(xs, low[0]), np.searchsorted(xs, high[0], side="right"))
    rows = np.arange(np.searchsorted(ys, low[1]), np.searchsorted(ys, high[1], side="right"))
    if len(columns) == 0 or len(rows) == 0:
        return None
    grid_rows, grid_columns = (g.ravel() for g in np.meshgrid(rows, columns, indexing="ij"))
    inside = _within(corners[:, :2], xs[grid_columns], ys[grid_rows])
    if not inside.any():
        return None
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    gradient = -normal[:2] / normal[2]
    r, c = grid_rows[inside], grid_columns[inside]
    heights = corners[0, 2] + gradient[0] * (xs[c] - corners[0, 0]) + gradient[1] * (ys[r] - corners[0, 1])
    return _Face(owner, r, c, heights, float(heights.min()), float(np.hypot(*gradient)))


def _within(outline: Floats, x: Floats, y: Floats) -> Mask:
    """Which points lie in a convex outline (k, 2), its rim included."""
    sides = np.roll(outline, -1, axis=0) - outline
    turns = np.array([ex * (y - oy) - ey * (x - ox) for (ox, oy), (ex, ey) in zip(outline, sides, strict=True)])
    slack = 1e-9 * float(np.abs(sides).max() + 1.0)
    inside: Mask = np.logical_or((turns >= -slack).all(axis=0), (turns <= slack).all(axis=0))
    return inside


def _joins(face: _Face, ground: DrivableGround, resolution: float) -> bool:
    """Whether one can drive onto the face from what is drivable, there or in a neighbouring cell."""
    for dr, dc in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
        r = np.clip(face.rows + dr, 0, ground.height.shape[0] - 1)
        c = np.clip(face.columns + dc, 0, ground.height.shape[1] - 1)
        allowed = LEDGE + resolution * np.maximum(face.slope, ground.slope[r, c])
        if (np.abs(ground.height[r, c] - face.heights) <= allowed).any():
            return True
    return False


def _lies_on(middle: Floats, ground: DrivableGround, axes: tuple[Floats, Floats]) -> bool:
    """Whether a face too small to hold a cell's centre is part of the ground: a finely meshed ramp is one of many such."""
    xs, ys = axes
    x, y, z = middle
    resolution = float(xs[1] - xs[0]) if len(xs) > 1 else 1.0
    r, c = round((y - ys[0]) / resolution), round((x - xs[0]) / resolution)
    if not (0 <= r < len(ys) and 0 <= c < len(xs)):
        return False
    return bool(abs(ground.height[r, c] - z) <= LEDGE + resolution * ground.slope[r, c])


def _lay(face: _Face, ground: DrivableGround) -> None:
    higher = face.heights > ground.height[face.rows, face.columns]
    r, c = face.rows[higher], face.columns[higher]
    ground.height[r, c] = face.heights[higher]
    ground.slope[r, c] = face.slope
    ground.surface[face.owner] = True
