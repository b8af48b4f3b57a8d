"""The footprint of solids between two heights: their shadows on the ground as convex outlines, segments and cells of a grid.

They are the true floor plan of a world. Boxes, spheres and upright cylinders are exact; triangles are clipped to the heights; a
leaning cylinder is taken as the prism of ``SIDES`` faces round it, too wide by at most 0.13 % of its radius. A mesh is its surface:
the inside of a closed one is not filled.
"""

from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.bvh import Bvh
from uvf.maths.compiled import compiled
from uvf.maths.solids import BOX, CYLINDER, SPHERE, TRIANGLE, Solids

Floats = NDArray[np.float64]

SIDES = 64
TOUCH = 1e-9
"""[m] An overlap up to this is only a touch, and a corner no farther from a straight side is none."""
UPRIGHT = 1 - 1e-12
CUBE: Floats = np.array([(x, y, z) for z in (-1.0, 1.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


class Footprint(NamedTuple):
    """Convex outlines, each (k, 2) [m] anticlockwise (two corners: a sheet seen edge-on), and discs (m, 3) x, y, radius [m]."""

    outlines: list[Floats]
    discs: Floats


def footprint(solids: Solids | Bvh, low: float, high: float) -> Footprint:
    """Shadows on the ground of what lies between the heights ``low`` < ``high`` [m]; a solid that only touches them is left out."""
    outlines = _triangle_outlines(solids.rows[solids.kinds == TRIANGLE, :9].reshape(-1, 3, 3), low, high)
    discs = []
    for kind, row in zip(solids.kinds, solids.rows, strict=True):
        if kind == TRIANGLE:
            continue
        axes, centre = _world_from_unit(row)
        if kind == SPHERE:
            discs += _disc_of_sphere(centre, axes[0, 0], low, high)
        elif kind == CYLINDER and abs(axes[2, 2]) > UPRIGHT * np.linalg.norm(axes[:, 2]):
            if centre[2] - abs(axes[2, 2]) < high and centre[2] + abs(axes[2, 2]) > low:
                discs.append((centre[0], centre[1], float(np.linalg.norm(axes[:, 0]))))
        else:
            outlines += _prism_outlines((CUBE if kind == BOX else _prism()) @ axes.T + centre, low, high)
    return Footprint(outlines, np.array(discs, dtype=np.float64).reshape(-1, 3))


def segments(shadows: Footprint) -> Floats:
    """Sides (n, 2, 2) of all outlines, by their ends x, y [m]; discs count as polygons of ``SIDES`` corners. Shadows may overlap."""
    angles = np.arange(SIDES) * (2 * np.pi / SIDES)
    ring = np.column_stack((np.cos(angles), np.sin(angles)))
    closed = [*shadows.outlines, *(disc[:2] + disc[2] * ring for disc in shadows.discs)]
    sides = [np.stack((outline, np.roll(outline, -1, axis=0)), axis=1)[: None if len(outline) > 2 else 1] for outline in closed]
    return np.concatenate([np.zeros((0, 2, 2)), *sides])


def covered(shadows: Footprint, origin: tuple[float, float], resolution: float, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Which cells (rows, columns) lie in a shadow with any part; cell [r, c] begins at ``origin`` + (c, r) * ``resolution`` [m].

    A shadow that only touches a cell's border does not cover it; a sheet seen edge-on that lies in a border covers both sides.
    """
    cells = np.zeros(shape, dtype=np.bool_)
    frame = np.array((*origin, resolution), dtype=np.float64)
    for outline in shadows.outlines:
        _cover_outline(cells, frame, outline)
    _cover_discs(cells, frame, shadows.discs)
    return cells


def _world_from_unit(row: Floats) -> tuple[Floats, Floats]:
    """(3, 3) scaled axes as columns and (3,) centre of a box, cylinder or sphere."""
    unit_from_world = row.reshape(3, 4)
    axes = np.linalg.inv(unit_from_world[:, :3]).astype(np.float64)
    return axes, -axes @ unit_from_world[:, 3]


def _disc_of_sphere(centre: Floats, radius: float, low: float, high: float) -> list[tuple[float, float, float]]:
    away = max(low - centre[2], centre[2] - high, 0.0)
    return [(centre[0], centre[1], float(np.sqrt(radius * radius - away * away)))] if away < radius else []


def _prism() -> Floats:
    """Corners of the prism round the unit cylinder: a bottom ring, then a top ring."""
    angles = np.arange(SIDES) * (2 * np.pi / SIDES)
    ring = np.column_stack((np.cos(angles), np.sin(angles))) / np.cos(np.pi / SIDES)
    return np.concatenate([np.column_stack((ring, np.full(SIDES, z))) for z in (-1.0, 1.0)])


def _prism_outlines(corners: Floats, low: float, high: float) -> list[Floats]:
    """None or one: corners are two rings of equal length."""
    if corners[:, 2].min() >= high or corners[:, 2].max() <= low:
        return []
    bottom, top = np.split(corners, 2)
    starts = np.concatenate((bottom, top, bottom))
    ends = np.concatenate((np.roll(bottom, -1, axis=0), np.roll(top, -1, axis=0), top))
    return [_hull(_between(corners, starts, ends, (low, high)))]


def _triangle_outlines(triangles: Floats, low: float, high: float) -> list[Floats]:
    heights = triangles[:, :, 2]
    met = (heights.min(axis=1) <= high) & (heights.max(axis=1) >= low)
    return [_hull(_between(t, t, np.roll(t, -1, axis=0), (low, high))) for t in triangles[met]]


def _between(corners: Floats, starts: Floats, ends: Floats, heights: tuple[float, float]) -> Floats:
    """(k, 2): the corners between both heights, and where the edges from starts to ends cross one of them."""
    low, high = heights
    points = [corners[(corners[:, 2] >= low) & (corners[:, 2] <= high), :2]]
    for height in heights:
        crossing = (starts[:, 2] < height) != (ends[:, 2] < height)
        a, b = starts[crossing], ends[crossing]
        share = (height - a[:, 2]) / (b[:, 2] - a[:, 2])
        points.append(a[:, :2] + share[:, np.newaxis] * (b[:, :2] - a[:, :2]))
    return np.concatenate(points)


def _hull(points: Floats) -> Floats:
    """Convex hull, anticlockwise, without corners in a line: Andrew's monotone chain (1979)."""
    ordered = sorted(set(map(tuple, points.tolist())))
    if len(ordered) < 3:
        return np.array(ordered).reshape(-1, 2)
    chain = [*_half_hull(ordered)[:-1], *_half_hull(ordered[::-1])[:-1]]
    return np.array(chain)


def _half_hull(ordered: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    chain: list[tuple[float, ...]] = []
    for x, y in ordered:
        while len(chain) > 1 and _is_straight(chain[-2], chain[-1], (x, y)):
            chain.pop()
        chain.append((x, y))
    return chain


def _is_straight(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> bool:
    """Whether b is no corner to the right of the way from a to c; by distance, or what rounding does to a sheet would be a sliver."""
    twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return twice_area <= TOUCH * max(hypot(c[0] - a[0], c[1] - a[1]), TOUCH)


@compiled
def _cell_range(begin: float, end: float, resolution: float, size: int) -> tuple[int, int]:
    """First and one past the last cell that may be met; one to spare on both sides."""
    first, last = np.floor(begin / resolution) - 1, np.floor(end / resolution) + 2
    return int(min(max(first, 0), size)), int(min(max(last, 0), size))


@compiled
def _cover_outline(cells: NDArray[np.bool_], frame: Floats, outline: Floats) -> None:
    """Separating axes: the cell's own two and the normal of each side; a sheet is let touch."""
    resolution = frame[2]
    corners = outline - frame[:2]
    low_x, high_x = corners[:, 0].min(), corners[:, 0].max()
    low_y, high_y = corners[:, 1].min(), corners[:, 1].max()
    margin = TOUCH if outline.shape[0] > 2 else -TOUCH
    first_row, end_row = _cell_range(low_y, high_y, resolution, cells.shape[0])
    first_column, end_column = _cell_range(low_x, high_x, resolution, cells.shape[1])
    for r in range(first_row, end_row):
        for c in range(first_column, end_column):
            x, y = c * resolution, r * resolution
            if x + resolution <= low_x + margin or x >= high_x - margin or y + resolution <= low_y + margin or y >= high_y - margin:
                continue
            if not _beside(corners, x + resolution / 2, y + resolution / 2, (resolution / 2, margin)):
                cells[r, c] = True


@compiled
def _beside(corners: Floats, x: float, y: float, half_margin: tuple[float, float]) -> bool:
    """Whether the square round (x, y) lies on the outer side of one of the outline's sides."""
    half, margin = half_margin
    n = corners.shape[0]
    for i in range(n):
        j = (i + 1) % n
        ex, ey = corners[j, 0] - corners[i, 0], corners[j, 1] - corners[i, 1]
        inward = ex * (y - corners[i, 1]) - ey * (x - corners[i, 0]) + half * (abs(ex) + abs(ey))
        if inward <= margin * np.hypot(ex, ey):
            return True
    return False


@compiled
def _cover_discs(cells: NDArray[np.bool_], frame: Floats, discs: Floats) -> None:
    resolution = frame[2]
    for i in range(discs.shape[0]):
        x, y, radius = discs[i, 0] - frame[0], discs[i, 1] - frame[1], discs[i, 2]
        first_row, end_row = _cell_range(y - radius, y + radius, resolution, cells.shape[0])
        first_column, end_column = _cell_range(x - radius, x + radius, resolution, cells.shape[1])
        for r in range(first_row, end_row):
            for c in range(first_column, end_column):
                dx = max(c * resolution - x, x - (c + 1) * resolution, 0.0)
                dy = max(r * resolution - y, y - (r + 1) * resolution, 0.0)
                if np.hypot(dx, dy) < radius - TOUCH:
                    cells[r, c] = True
