"""Maps of map_server, a picture and a yaml beside it, read and written as ROS 1 and Nav2 do.

http://wiki.ros.org/map_server#Map_format and nav2_map_server. The picture's top is the map's highest row.
"""

import io
import json
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray
from PIL import Image

from uvf.maths.se2 import Pose2
from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.whole_file import write_whole
from uvf.models.yaml_data import BadInput, load_yaml, nearest

Cells = NDArray[np.int8]
Mode = Literal["trinary", "scale", "raw"]
Share = Annotated[float, Meta(ge=0, le=1)]
YAML, PICTURES = (".yaml", ".yml"), (".pgm", ".png")
FREE, UNKNOWN, OCCUPIED = 254, 205, 0
"""Greys of a written trinary map."""
MOST_CELLS = 25_000_000
"""Of a map in a file: 250 x 250 m in cells of 5 cm. What tells its walls' thickness takes 150 bytes for each."""
BAND = 1_000_000  # cells of a picture looked at at once
FREE_UP_TO, OCCUPIED_FROM = 25, 65  # per cent
THRESHOLDS = {"trinary": (0.196, 0.65), "scale": (0.0, 1.0), "raw": (0.196, 0.65)}
"""(free_thresh, occupied_thresh) that the yaml is written with: grey 205 is unknown only up to 0.196."""


class MapFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The yaml."""

    image: str
    resolution: Annotated[float, Meta(gt=0, le=10)]  # m
    origin: list[float]  # x, y [m], yaw [rad] of the picture's lower left corner
    occupied_thresh: Share = 0.65
    free_thresh: Share = 0.196
    negate: bool | int = 0
    mode: Mode = "trinary"


@dataclass(frozen=True)
class GridMap:
    """An occupancy grid. cells: (rows, columns), row 0 at the lowest y; -1 unknown, 0 free .. 100 occupied.

    origin: frame_from_grid, the corner of cell [0, 0]; cells are squares of ``resolution`` [m] along the grid's axes.
    """

    cells: Cells
    resolution: float
    origin: Pose2


def load_map(path: str | Path, note: Callable[[str], None] = lambda _: None) -> GridMap:
    """Map of a yaml file, or of a picture when the yaml lies beside it under the same name. Raises BadInput.

    note: is told where another picture is taken than the yaml names.
    """
    path = Path(path)
    if path.suffix not in YAML:
        if path.suffix and path.suffix.lower() not in PICTURES:
            raise BadInput(f"{path}: no map by its ending: a map is a .yaml with a picture (.pgm or .png) beside it")
        path = path.with_suffix(YAML[0])
    if not path.is_file():
        raise BadInput(f"{path}: no such file; the picture's yaml says its resolution and origin")
    file = load_yaml(path, MapFile)
    if file.free_thresh >= file.occupied_thresh:
        raise BadInput(f"{path}: free_thresh: {file.free_thresh:g} is not below occupied_thresh, {file.occupied_thresh:g}")
    if len(file.origin) not in (2, 3):
        raise BadInput(f"{path}: origin: {file.origin}; write x, y [m] and yaw [rad]")
    picture = _picture(path, file.image)
    if picture.name != Path(file.image).name:
        note(f"there is no {file.image}, which the map names; {picture.name} beside it is taken")
    cells = _meant(_pixels(picture), file)
    yaw = file.origin[2] if len(file.origin) == 3 else 0.0
    return GridMap(np.flipud(cells), file.resolution, Pose2(file.origin[0], file.origin[1], yaw))


def save_map(grid: GridMap, path: Path, mode: str = "trinary") -> Path:
    """Writes picture and yaml; returns the yaml's path. Raises BadInput.

    path: of the yaml or the picture, which is a PGM unless the suffix says PNG or the mode needs one: ``scale`` keeps unknown
    cells as transparent ones. ``scale`` and ``raw`` keep each cell's value, ``trinary`` only whether it is free or occupied.
    """
    check_mode(path, mode)
    if grid.cells.size == 0:
        raise BadInput(f"{path}: a map without cells cannot be written")
    suffix = path.suffix if path.suffix in PICTURES else ".png" if mode == "scale" else ".pgm"
    stem = path.with_suffix("") if path.suffix in (*YAML, *PICTURES) else path
    picture, yaml = stem.with_name(stem.name + suffix), stem.with_name(stem.name + YAML[0])
    buffer = io.BytesIO()
    Image.fromarray(_greys(np.flipud(grid.cells), mode)).save(buffer, "PPM" if suffix == ".pgm" else "PNG")
    write_whole(picture, buffer.getvalue())
    write_whole(yaml, _yaml(grid, picture.name, mode).encode())
    return yaml


def check_mode(path: Path, mode: str) -> None:
    """Checks path and mode as ``save_map`` does. Raises BadInput."""
    if mode not in THRESHOLDS:
        raise BadInput(f"mode: no '{mode}' here; {nearest(mode, THRESHOLDS)}")
    if mode == "scale" and path.suffix == ".pgm":
        raise BadInput(f"{path}: mode scale needs transparency, which a PGM has not; write a .png, or take mode raw")


def _picture(yaml: Path, image: str) -> Path:
    """The one that the yaml names; when that is not there, the one that bears the yaml's name: both have been renamed."""
    named, beside = yaml.parent / image, yaml.with_suffix(Path(image).suffix)
    return beside if beside.is_file() and not named.is_file() else named


def _yaml(grid: GridMap, image: str, mode: str) -> str:
    free, occupied = THRESHOLDS[mode]
    origin = ", ".join(repr(float(v)) for v in grid.origin)
    return (
        f"image: {json.dumps(image)}\nmode: {mode}\nresolution: {float(grid.resolution)!r}\norigin: [{origin}]\n"
        f"negate: 0\noccupied_thresh: {occupied}\nfree_thresh: {free}\n"
    )


def _greys(cells: Cells, mode: str) -> NDArray[np.uint8]:
    """(rows, columns) brightness; of scale (rows, columns, 2) with the opacity."""
    known = (cells >= 0) & (cells <= 100)
    if mode == "raw":
        return np.where(known, cells, 255).astype(np.uint8)
    if mode == "scale":
        brightness = np.where(known, np.rint((100.0 - cells) * 2.55), 128)
        return np.stack((brightness, np.where(known, 255, 0)), axis=-1).astype(np.uint8)
    occupied, free = known & (cells >= OCCUPIED_FROM), known & (cells <= FREE_UP_TO)
    return np.where(occupied, OCCUPIED, np.where(free, FREE, UNKNOWN)).astype(np.uint8)


def undecided_share(grid: GridMap) -> float:
    """Share [0 to 1] of the seen cells that a trinary map has as unknown: neither surely free nor surely occupied."""
    seen = grid.cells[grid.cells >= 0]
    return float(((seen > FREE_UP_TO) & (seen < OCCUPIED_FROM)).mean()) if len(seen) else 0.0


def _pixels(picture: Path) -> NDArray[Any]:
    """(rows, columns[, 3 or 4]) brightness, or colours, or those and the opacity, as they are in the picture: of 8 or of 16 bits."""
    if picture.exists() and not picture.is_file():  # a pipe would never be opened
        raise BadInput(f"{picture}: cannot be read as a picture: it is no file; give a PGM or PNG")
    refuse_pointer(picture)
    try:
        with _bomb_is_error(), Image.open(picture) as image:
            columns, rows = image.size
            if columns * rows > MOST_CELLS:
                raise _too_large(picture, f"{columns} x {rows} cells are")
            if image.mode.startswith("I"):
                return np.asarray(image)
            transparent = "A" in image.getbands() or "transparency" in image.info
            return np.asarray(image.convert("RGBA" if transparent else "L" if image.mode in ("1", "L") else "RGB"))
    except OSError as error:
        reason = error.strerror or str(error)
        raise BadInput(f"{picture}: cannot be read as a picture: {reason}; give a PGM or PNG") from error
    except (Image.DecompressionBombWarning, Image.DecompressionBombError) as error:
        raise _too_large(picture, "its cells are") from error
    except (ValueError, SyntaxError) as error:
        raise BadInput(f"{picture}: cannot be read as a picture: {error}; give a PGM or PNG") from error


@contextmanager
def _bomb_is_error() -> Iterator[None]:
    """Pillow only warns of a picture up to twice as large as it takes for safe."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", Image.DecompressionBombWarning)
        yield


def _too_large(picture: Path, these: str) -> BadInput:
    mend = "cut it into parts, or make its cells larger"
    return BadInput(f"{picture}: cannot be read as a picture of a map: {these} more than {MOST_CELLS // 10**6} million; {mend}")


def _meant(pixels: NDArray[Any], file: MapFile) -> Cells:
    """The cells of a picture, a few lines of it at a time: numbers to reckon with take eight times the room of those in it."""
    cells = np.empty(pixels.shape[:2], dtype=np.int8)
    lines = max(1, BAND // pixels.shape[1])
    for first in range(0, len(pixels), lines):
        values = np.atleast_3d(pixels[first : first + lines] / (255.0 if pixels.dtype == np.uint8 else 65535.0))
        opacity = values[..., 3] if values.shape[2] == 4 else None
        cells[first : first + lines] = _cells(values[..., :3], opacity, file)
    return cells


def _cells(colours: NDArray[np.float64], opacity: NDArray[np.float64] | None, file: MapFile) -> Cells:
    """Of pixels, as nav2_map_server has it: trinary takes the opacity for one more colour, raw ignores negate."""
    channels = colours if opacity is None or file.mode != "trinary" else np.dstack((colours.repeat(3 // colours.shape[2], 2), opacity))
    shade = channels.mean(axis=2)
    if file.mode == "raw":
        value = np.rint(shade * 255.0)
        return np.where(value <= 100, value, -1).astype(np.int8)
    occupancy = shade if file.negate else 1.0 - shade
    between = np.full(shade.shape, -1.0)
    if file.mode == "scale":
        between = np.rint((occupancy - file.free_thresh) / (file.occupied_thresh - file.free_thresh) * 100.0)
    cells = np.where(occupancy > file.occupied_thresh, 100, np.where(occupancy < file.free_thresh, 0, between))
    if file.mode == "scale" and opacity is not None:
        cells = np.where(opacity < 1.0, -1, cells)
    return cells.astype(np.int8)
