"""The walls that a map shows: where they are, which side they were seen from, how thick they are, where they are doubled."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.compiled import compiled
from uvf.maths.se2 import Pose2, transform
from uvf.models.world.map_file import GridMap

Floats = NDArray[np.float64]
Cells = NDArray[np.int8]
Mask = NDArray[np.bool_]

OCCUPIED = 50  # per cent, above which a cell is a wall
SIDE = 2  # cells around one, in which its free side is looked for
WINDOW = 0.5  # m, half the side of the square whose cells tell a wall's direction
FLAT = 0.4
"""Largest ratio of the variances of those cells, across and along, of a wall with a direction."""
DOUBLE_GAP = 0.3  # m of free cells between two walls, up to which they are one wall drawn twice: nothing looks in there
DOUBLE_LENGTH = 0.5  # m, shorter ones are not counted
PARALLEL = 0.98  # cosine
OPENS = 0.15  # of its length, as an open door leaf does from its wall: no double wall


@dataclass(frozen=True)
class WallPoints:
    """Wall points (n, 2) [m] and unit vectors towards_free (n, 2) to the side from which they were seen."""

    points: Floats
    towards_free: Floats


@dataclass(frozen=True)
class WallFigures:
    """Figures of a map's walls. thickness: mean over all cells of flat walls [m]; double_walls: number of stretches.

    doubled: (rows, columns) the gaps within them.
    """

    thickness: float
    double_walls: int
    doubled: Mask


def wall_points(grid: GridMap) -> WallPoints:
    """Centres of the wall cells that border on free cells, in the frame that the grid's origin is given in.

    Of cells that are as free on either side, one of the two counts.
    """
    x, y = _free_side(grid.cells)
    even = (x == 0.0) & (y == 0.0)
    x[even], y[even] = _freest(grid.cells)[:, even]
    length = np.hypot(x, y)
    wall = (grid.cells > OCCUPIED) & beside_free(grid.cells)
    rows, columns = np.nonzero(wall)
    points = np.column_stack((columns + 0.5, rows + 0.5)) * grid.resolution
    towards = np.column_stack((x[wall], y[wall])) / length[wall, None]
    return WallPoints(transform(grid.origin, points), transform(Pose2(0.0, 0.0, grid.origin.yaw), towards))


def wall_figures(grid: GridMap) -> WallFigures:
    """Thickness and double walls of a map. A gap counts as doubled where it is free, for nobody can look in between two true walls."""
    normals, flat = _normals(grid.cells > OCCUPIED, max(round(WINDOW / grid.resolution), 2))
    gaps = np.zeros(grid.cells.shape)
    reach = int(np.ceil(DOUBLE_GAP / grid.resolution - 1e-9))
    total, count = _look_across(grid.cells, normals, flat, reach, gaps)
    thickness = total / count * grid.resolution if count else 0.0
    doubled = _stretches(gaps, DOUBLE_LENGTH / grid.resolution)
    return WallFigures(thickness, int(ndimage.label(doubled, np.ones((3, 3)))[1]), doubled)


def _free_side(cells: Cells) -> tuple[Floats, Floats]:
    """Sum of the vectors from each cell to the free ones around it, x and y; (rows, columns)."""
    free = ((cells >= 0) & (cells <= OCCUPIED)).astype(np.float64)
    offsets = np.tile(np.arange(-SIDE, SIDE + 1.0), (2 * SIDE + 1, 1))
    return ndimage.correlate(free, offsets, mode="constant"), ndimage.correlate(free, offsets.T, mode="constant")


def _freest(cells: Cells) -> Floats:
    """(2, rows, columns) unit vectors along which there is most free around each cell, by the mean of doubled angles."""
    free = ((cells >= 0) & (cells <= OCCUPIED)).astype(np.float64)
    y, x = np.mgrid[-SIDE : SIDE + 1.0, -SIDE : SIDE + 1.0]
    angles = 2.0 * np.arctan2(y, x)
    turned = ndimage.correlate(free, np.sin(angles), mode="constant"), ndimage.correlate(free, np.cos(angles), mode="constant")
    along = 0.5 * np.arctan2(*turned)
    return np.stack((np.cos(along), np.sin(along)))


def beside_free(cells: Cells) -> Mask:
    """Mask (rows, columns) of the cells that are free or have a free one among their eight neighbours."""
    borders: Mask = ndimage.binary_dilation((cells >= 0) & (cells <= OCCUPIED), np.ones((3, 3)))
    return borders


def _normals(wall: Mask, reach: int) -> tuple[Floats, Mask]:
    """((rows, columns, 2) unit vector across the wall, whether the cells around lie along a line)."""
    rows, columns = wall.shape
    y, x = np.mgrid[0.0:rows, 0.0:columns]
    n, sx, sy, sxx, sxy, syy = (
        ndimage.uniform_filter(wall * layer, 2 * reach + 1, mode="constant") for layer in (np.ones(wall.shape), x, y, x * x, x * y, y * y)
    )
    n = np.where(n > 0.0, n, np.inf)
    vxx, vxy, vyy = sxx / n - (sx / n) ** 2, sxy / n - sx * sy / n**2, syy / n - (sy / n) ** 2
    mean, spread = (vxx + vyy) / 2.0, np.hypot((vxx - vyy) / 2.0, vxy)
    along = 0.5 * np.arctan2(2.0 * vxy, vxx - vyy)
    return np.stack((-np.sin(along), np.cos(along)), axis=-1), wall & (spread > 1.0) & (mean - spread < FLAT * (mean + spread))


@compiled
def _look_across(cells: Cells, normals: Floats, flat: Mask, reach: int, gaps: Floats) -> tuple[float, int]:
    """(sum of the thickness [cells], number) over the flat cells; writes free gaps of up to ``reach`` cells to a parallel wall."""
    total, count = 0.0, 0
    for row in range(cells.shape[0]):
        for column in range(cells.shape[1]):
            if not flat[row, column]:
                continue
            nx, ny = normals[row, column, 0], normals[row, column, 1]
            run = 1.0
            for sign in (-1.0, 1.0):
                run += _across((column + 0.5, row + 0.5), (sign * nx, sign * ny), reach, (cells, normals, flat), gaps)
            total += run * max(abs(nx), abs(ny))
            count += 1
    return total, count


@compiled
def _across(start: tuple[float, float], normal: tuple[float, float], reach: int, layers: tuple[Cells, Floats, Mask], gaps: Floats) -> float:
    """Wall cells beyond the start, in steps of one cell along the axis nearest to the normal; writes the gap's width into its cells."""
    cells, normals, flat = layers
    scale = 1.0 / max(abs(normal[0]), abs(normal[1]))
    dx, dy = normal[0] * scale, normal[1] * scale
    run, gap = 0, 0
    k = 1
    while True:
        c, r = int(np.floor(start[0] + k * dx)), int(np.floor(start[1] + k * dy))
        if not (0 <= r < cells.shape[0] and 0 <= c < cells.shape[1]) or cells[r, c] < 0:
            return run
        if cells[r, c] > OCCUPIED:
            if gap > 0:
                break
            run += 1
        else:
            gap += 1
            if gap * scale > reach + 1e-9:
                return run
        k += 1
    if flat[r, c] and abs(normals[r, c, 0] * normal[0] + normals[r, c, 1] * normal[1]) > PARALLEL:
        for i in range(run + 1, k):
            gaps[int(np.floor(start[1] + i * dy)), int(np.floor(start[0] + i * dx))] = gap * scale
    return run


def _stretches(gaps: Floats, length: float) -> Mask:
    """The connected parts of what is between two walls [cells] that are long enough, and as wide at one end as at the other."""
    labels, count = ndimage.label(gaps > 0.0, np.ones((3, 3)))
    keep = np.zeros(count + 1, dtype=np.bool_)
    for i, box in enumerate(ndimage.find_objects(labels), 1):
        inside = labels[box] == i
        along = np.nonzero(inside)[int(np.argmax(inside.shape))].astype(np.float64)
        if np.hypot(*inside.shape) >= length:
            widening = np.cov(along, gaps[box][inside])
            keep[i] = abs(widening[0, 1]) < OPENS * widening[0, 0]
    kept: Mask = keep[labels]
    return kept
