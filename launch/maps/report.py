"""What ``uvf map`` says about maps, and its pictures."""

import io
from collections.abc import Iterator
from math import degrees, isfinite, radians
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

from uvf.maths.se2 import Pose2, compose, inverse, transform
from uvf.models.scenario import ROOT
from uvf.models.whole_file import write_whole
from uvf.models.world.file import load_world
from uvf.models.world.geometry import FloorPlan, floor_plan
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.slam.maps.placing import centres, values_at
from uvf.slam.maps.quality import WallAgreement, as_grid, compare, score
from uvf.slam.maps.walls import OCCUPIED, beside_free, wall_figures

Shift = tuple[float, float, float]
"""x, y [m], yaw [deg] of the first map in the frame of the other one."""
PLAN_CELL = 0.02  # m
MOST_CELLS = 100_000_000  # of a picture
GREY, WHITE, BLACK, RED, BLUE = (128, 128, 128), (255, 255, 255), (0, 0, 0), (220, 30, 30), (30, 60, 230)


def figures(grid: GridMap) -> Iterator[str]:
    """Yields lines that describe one map."""
    rows, columns = grid.cells.shape
    x, y, yaw = grid.origin
    walls = wall_figures(grid)
    yield f"{columns} x {rows} cells of {grid.resolution:g} m: {columns * grid.resolution:.2f} x {rows * grid.resolution:.2f} m"
    yield f"lower left corner at ({x + 0.0:g}, {y + 0.0:g}) m, yaw {_degrees(yaw)} deg"
    free, occupied = (grid.cells >= 0) & (grid.cells <= OCCUPIED), grid.cells > OCCUPIED
    area = grid.resolution**2
    yield f"free {free.sum() * area:.1f} m^2, occupied {occupied.sum() * area:.2f} m^2, unknown {(grid.cells < 0).mean():.1%} of the cells"
    yield f"walls {walls.thickness:.3f} m thick; {walls.double_walls} look doubled"


def compared(a: GridMap, b: GridMap, shift: Shift, picture: Path) -> Iterator[str]:
    """Yields lines about map ``a`` against ``b``, and draws the picture.

    shift: (x [m], y [m], yaw [degrees]) of ``a`` in the frame of ``b``. Raises BadInput when the picture cannot be written.
    """
    placed = _placed(a, shift)
    walls, free, occupied = compare(placed, b)
    draw_differences(placed, b, picture)
    yield from _walls(walls)
    yield f"cells that both know: IoU of free ones {free:.3f}, of occupied ones {occupied:.3f}"


def scored(grid: GridMap, world: str, shift: Shift, picture: Path) -> Iterator[str]:
    """Yields lines about a map against the floor plan of a world, and draws the picture.

    shift: (x [m], y [m], yaw [degrees]) of the map in the world frame. Raises BadInput.
    """
    plan = floor_plan(load_world(ROOT / "worlds", world), PLAN_CELL)
    found = score(grid, plan, _pose(shift))
    draw_differences(_placed(grid, shift), _hollow(plan), picture)
    yield from _walls(found.walls)
    yield f"cells that both know: IoU of free ones {found.free_iou:.3f}, of occupied ones {found.occupied_iou:.3f}"
    yield f"{found.unknown:.1%} of the world's free floor is unknown"
    yield f"walls {found.thickness:.3f} m thick; {found.double_walls} doubled"


def draw_differences(a: GridMap, b: GridMap, picture: Path) -> None:
    """Draws the differences of two maps along the axes of ``a``, as far as both reach, into a PNG. Raises BadInput."""
    wide = _widened(a, b)
    mine, other = wide.cells, values_at(b, centres(wide)).reshape(wide.cells.shape)
    wall, other_wall = mine > OCCUPIED, other > OCCUPIED
    near, other_near = (ndimage.binary_dilation(walls, np.ones((3, 3))) for walls in (wall, other_wall))
    colours = np.full((*mine.shape, 3), GREY, dtype=np.uint8)
    colours[(mine >= 0) | (other >= 0)] = WHITE
    colours[other_wall & ~near] = BLUE
    colours[wall] = RED
    colours[wall & other_near] = BLACK
    buffer = io.BytesIO()
    Image.fromarray(np.flipud(colours)).save(buffer, "PNG")
    write_whole(picture, buffer.getvalue())


def _widened(a: GridMap, b: GridMap) -> GridMap:
    """``a`` with unknown cells around, so that it covers ``b`` too. Raises BadInput when that is too large."""
    rows, columns = np.array(b.cells.shape) * b.resolution
    corners = transform(b.origin, np.array(((0.0, 0.0), (columns, 0.0), (0.0, rows), (columns, rows))))
    local = transform(inverse(a.origin), corners) / a.resolution
    low = np.maximum(-np.floor(local.min(axis=0)), 0.0).astype(np.int64)
    high = np.maximum(np.ceil(local.max(axis=0)) - np.array(a.cells.shape[::-1]), 0.0).astype(np.int64)
    size = low + high + a.cells.shape[::-1]
    if size[0] * size[1] > MOST_CELLS:
        raise BadInput(f"a picture of {size[0]} x {size[1]} cells is too large: the maps lie far apart; give a --shift")
    cells = np.pad(a.cells, ((low[1], high[1]), (low[0], high[0])), constant_values=-1)
    corner = Pose2(-float(low[0]) * a.resolution, -float(low[1]) * a.resolution, 0.0)
    return GridMap(cells, a.resolution, compose(a.origin, corner))


def _hollow(plan: FloorPlan) -> GridMap:
    """The plan with what is inside of solids unknown, as a lidar would have it."""
    grid = as_grid(plan)
    inside = plan.cells & ~beside_free(grid.cells)
    return GridMap(np.where(inside, -1, grid.cells).astype(np.int8), grid.resolution, grid.origin)


def _placed(grid: GridMap, shift: Shift) -> GridMap:
    return GridMap(grid.cells, grid.resolution, compose(_pose(shift), grid.origin))


def _pose(shift: Shift) -> Pose2:
    """Raises BadInput."""
    if not all(isfinite(v) for v in shift):
        raise BadInput(f"--shift: {' '.join(map(str, shift))}: three finite numbers are needed")
    return Pose2(shift[0], shift[1], radians(shift[2]))


def _walls(walls: WallAgreement) -> Iterator[str]:
    for d in walls.detections:
        yield f"walls within {d.tolerance:.2f} m: F1 {d.f1:.3f}, precision {d.precision:.3f}, recall {d.recall:.3f}"
    for name, (mean, tail) in (("walls lie off the true ones", walls.to_true), ("true walls lie off the map's", walls.to_map)):
        yield f"{name} by {_metres(mean)} on average, 95 % by less than {_metres(tail)}"


def _metres(value: float) -> str:
    """``-`` where there was nothing to measure."""
    return f"{value:.3f} m" if isfinite(value) else "-"


def _degrees(angle: float) -> str:
    """An angle [rad] in degrees; 0 for -0."""
    return f"{degrees(angle) + 0.0:g}"
