"""Maps of map_server (picture and yaml) as worlds: occupied cells are walls (http://wiki.ros.org/map_server#Map_format)."""

from pathlib import Path
from typing import Annotated, Literal

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from uvf.launch.worlds.notes import Notes
from uvf.launch.worlds.sdf_world import HOME
from uvf.runtime.params import BadInput, load_yaml
from uvf.runtime.world_file import Box, WorldFile

Mask = NDArray[np.bool_]
Share = Annotated[float, Meta(ge=0, le=1)]
Rectangle = tuple[int, int, int, int]
"""First row, first column, number of rows, number of columns."""
MANY = 3000  # boxes


class MapFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The yaml beside the picture."""

    image: str
    resolution: Annotated[float, Meta(gt=0, le=10)]  # m
    origin: list[float]  # x, y [m], yaw [rad] of the picture's lower left corner
    occupied_thresh: Share = 0.65
    free_thresh: Share = 0.196
    negate: bool | int = 0
    mode: Literal["trinary", "scale", "raw"] = "trinary"


def map_world(path: Path, height: float, notes: Notes) -> WorldFile:
    """Walls of ``height`` [m] where the map is occupied. Raises BadInput."""
    if path.suffix not in (".yaml", ".yml"):
        path = path.with_suffix(".yaml")
    if not path.is_file():
        raise BadInput(f"{path}: no such file; the picture's yaml says its resolution and origin")
    file = load_yaml(path, MapFile)
    if len(file.origin) not in (2, 3):
        raise BadInput(f"{path}: origin: {file.origin}; write x, y [m] and yaw [rad]")
    occupied, known = _read(path, file)
    rectangles = greedy_rectangles(occupied)
    notes.add(f"{int(occupied.sum())} occupied cells of {file.resolution:g} m became {len(rectangles)} boxes")
    if len(rectangles) > MANY:
        notes.add(f"more than {MANY} boxes are slow; clean the picture of single cells first")
    if not known.all():
        notes.add("cells that the map does not know are floor here", f"{int((~known).sum())}")
    notes.add("a map does not say where on Earth it lies: set 'origin'")
    boxes = [_box(i, rectangle, file, height) for i, rectangle in enumerate(rectangles, 1)]
    return WorldFile(f"Walls of the map {path.name}.", HOME, _floor(known, file), boxes=boxes, ground_colour=(0.6, 0.6, 0.58))


def _read(path: Path, file: MapFile) -> tuple[Mask, Mask]:
    """Occupied and known cells (rows, columns), row 0 the lowest."""
    picture = path.parent / file.image
    try:
        with Image.open(picture) as opened:
            has_alpha = "A" in opened.getbands()
            grey = np.asarray(opened.convert("LA" if has_alpha else "L"), dtype=np.float64)
    except (OSError, UnidentifiedImageError, ValueError) as error:
        raise BadInput(f"{picture}: cannot be read as a picture: {error}; give a PGM or PNG") from error
    seen = grey[..., 1] > 0 if has_alpha else np.ones(grey.shape, dtype=np.bool_)
    pixels = grey[..., 0] if has_alpha else grey
    if file.mode == "raw":  # the pixels are the cells' values: 0 .. 100 %, above that unknown
        seen, p = seen & (pixels <= 100), pixels / 100
    else:
        p = pixels / 255 if file.negate else 1 - pixels / 255
    occupied = seen & (p > file.occupied_thresh)
    return np.flipud(occupied), np.flipud(seen & (occupied | (p < file.free_thresh)))


def greedy_rectangles(cells: Mask) -> list[Rectangle]:
    """Few rectangles that cover exactly the cells that are set: at each first free cell the larger of the two that grow along and up."""
    left = cells.copy()
    found = []
    for row, column in np.argwhere(cells):
        if not left[row, column]:
            continue
        wide = _grown(left[row:, column:])
        tall = _grown(left[row:, column:].T)[::-1]
        rows, columns = max(wide, (tall[0], tall[1]), key=lambda size: size[0] * size[1])
        left[row : row + rows, column : column + columns] = False
        found.append((int(row), int(column), rows, columns))
    return found


def _grown(cells: Mask) -> tuple[int, int]:
    """(rows, columns) of the rectangle at [0, 0] that first grows along its row, then upward."""
    columns = _run(cells[0])
    return _run(np.asarray(cells[:, :columns].all(axis=1))), columns


def _run(values: Mask) -> int:
    """How many are set before the first that is not."""
    return int(len(values) if values.all() else np.argmin(values))


def _box(number: int, rectangle: Rectangle, file: MapFile, height: float) -> Box:
    row, column, rows, columns = rectangle
    size = (columns * file.resolution, rows * file.resolution, height)
    x, y = _world(file, column + columns / 2, row + rows / 2)
    return Box(f"wall_{number}", (x, y, height / 2), size, (0.0, 0.0, _yaw(file)), (0.75, 0.73, 0.68))


def _yaw(file: MapFile) -> float:
    return file.origin[2] if len(file.origin) == 3 else 0.0


def _world(file: MapFile, column: float, row: float) -> tuple[float, float]:
    """x, y [m] of a point given in cells from the lower left corner."""
    c, s = np.cos(_yaw(file)), np.sin(_yaw(file))
    dx, dy = column * file.resolution, row * file.resolution
    return float(file.origin[0] + c * dx - s * dy), float(file.origin[1] + s * dx + c * dy)


def _floor(known: Mask, file: MapFile) -> tuple[float, float, float, float]:
    """The rectangle about all cells that the map knows."""
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if len(rows) == 0:
        raise BadInput(f"{file.image}: no cell is free or occupied; look at negate and the thresholds")
    corners = [_world(file, c, r) for c in (columns[0], columns[-1] + 1) for r in (rows[0], rows[-1] + 1)]
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    return round(float(low[0]), 3), round(float(low[1]), 3), round(float(high[0]), 3), round(float(high[1]), 3)
