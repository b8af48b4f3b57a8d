"""Heights as terrain: grey pictures, and GeoTIFF elevation models with the place and the spacing that they state.

GeoTIFF 1.1 (OGC 19-008r4): pixel scale and tie point; of the keys those that tell degrees from metres.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError
from scipy import ndimage

from uvf.maths.geodesy import LocalTangent
from uvf.models.importing.notes import Notes
from uvf.models.lfs_pointer import refuse_pointer
from uvf.models.world.earth_field import earth_field
from uvf.models.world.file import Origin, Terrain, WorldFile
from uvf.models.world.terrain import FINEST
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

PIXEL_SCALE, TIE_POINT, GEO_KEYS, NO_DATA = 33550, 33922, 34735, 42113  # tags
MODEL_TYPE, PIXEL_IS, MODEL_UNIT = 1024, 1025, 3076  # keys
PROJECTED, GEOGRAPHIC, PIXEL_IS_POINT, METRE = 1, 2, 2, 9001
METRIC = ("F", "I", "I;16", "I;16B", "I;16S")
"""Pictures of a TIFF whose numbers are metres."""
STEPS = 65535  # of a grey picture of 16 bit
FLATTEST = 0.01  # m from the lowest to the highest
TIFF = (".tif", ".tiff")
WIDEST, WIDEST_FLOOR = 1e4, 200.0  # m
HOME = Origin(40.77, 14.79, 300.0)
"""Where worlds lie that do not say it: the University of Salerno."""


@dataclass(frozen=True)
class HeightGrid:
    """Heights (rows, columns), the first row in the north: metres where the file is an elevation model, else brightness, 0 to 1."""

    heights: Floats
    size: tuple[float, float] | None = None
    """m, east and north, between the middles of the outermost cells; None where the file does not say."""
    origin: Origin | None = None
    """Of the middle at height 0; None where the file does not say."""


def read_heights(path: Path, notes: Notes) -> HeightGrid:
    """The heights of a picture or an elevation model. Raises BadInput for what cannot be read."""
    refuse_pointer(path)
    try:
        with Image.open(path) as picture:
            tags: dict[int, Any] = dict(getattr(picture, "tag_v2", {}))
            mode = picture.mode
            if mode not in ("L", *METRIC):
                notes.add("a picture in colours: its brightness is taken for heights", path.name)
            grey = picture if mode in ("L", *METRIC) else picture.convert("L")
            cells = np.asarray(grey, dtype=np.float64)
    except FileNotFoundError as error:
        raise BadInput(f"{path}: no such file") from error
    except (OSError, UnidentifiedImageError, ValueError, Image.DecompressionBombError) as error:
        raise BadInput(f"{path}: not a picture or elevation model that can be read ({error})") from error
    if cells.ndim != 2 or min(cells.shape) < 2:
        raise BadInput(f"{path}: {' x '.join(map(str, cells.shape[::-1]))} pixels; heights need two or more a side")
    if PIXEL_SCALE in tags:
        return _elevations(path, cells, tags, notes)
    if path.suffix.lower() in TIFF and mode in METRIC:
        raise BadInput(f"{path}: it does not say how wide its cells are (no ModelPixelScale); write it as GeoTIFF with gdal_translate")
    brightest = cells.max()
    if not np.isfinite(cells).all() or brightest <= cells.min():
        raise BadInput(f"{path}: all of it has one brightness, so there are no heights in it")
    return HeightGrid(cells / brightest)


def _elevations(path: Path, cells: Floats, tags: dict[int, Any], notes: Notes) -> HeightGrid:
    keys = _geo_keys(tags)
    if keys.get(MODEL_TYPE) not in (PROJECTED, GEOGRAPHIC) or keys.get(MODEL_UNIT, METRE) != METRE:
        raise BadInput(f"{path}: neither degrees nor metres; project it first, e.g. with gdalwarp -t_srs EPSG:4326")
    known = _known(cells, tags)
    if not known.any():
        raise BadInput(f"{path}: no height is known in it")
    if not known.all():
        notes.add("cells without a height lie as low as the lowest", f"{int((~known).sum())}")
        cells = np.where(known, cells, cells[known].min())
    rows, columns = cells.shape
    step_x, step_y = (abs(float(v)) for v in tags[PIXEL_SCALE][:2])
    across, along = (columns - 1) * step_x, (rows - 1) * step_y
    if not (np.isfinite((across, along)).all() and across > 0 and along > 0):
        raise BadInput(f"{path}: ModelPixelScale is {step_x:g}, {step_y:g}; the cells of heights are wider than 0")
    if keys[MODEL_TYPE] == PROJECTED:
        notes.add("an elevation model in projected metres: set 'origin'")
        return HeightGrid(cells, (across, along))
    column, row, _, x, y = (float(v) for v in tags.get(TIE_POINT, (0.0,) * 6)[:5])
    offset = 0.0 if keys.get(PIXEL_IS) == PIXEL_IS_POINT else 0.5  # of a cell's middle
    longitude, latitude = x + (offset - column) * step_x + across / 2, y - (offset - row) * step_y - along / 2
    if not (abs(latitude) <= 89 and abs(longitude) <= 360):
        raise BadInput(f"{path}: its middle lies at {latitude:g}, {longitude:g} deg; that is no place to drive")
    tangent = LocalTangent.from_degrees(latitude, longitude, 0.0)
    east = 2 * tangent.enu(np.radians(latitude), np.radians(longitude + across / 2), 0.0)[0]
    north = 2 * tangent.enu(np.radians(latitude + along / 2), np.radians(longitude), 0.0)[1]
    size = float(east), float(north)
    return HeightGrid(cells, size, Origin(round(latitude, 7), round((longitude + 180.0) % 360.0 - 180.0, 7)))


def _geo_keys(tags: dict[int, Any]) -> dict[int, int]:
    """Short keys of the directory: id -> value."""
    entries = np.array(tags.get(GEO_KEYS, ()), dtype=np.int64)[4:]
    entries = entries[: len(entries) // 4 * 4].reshape(-1, 4)
    return {int(key): int(value) for key, place, _, value in entries if place == 0}


def _known(cells: Floats, tags: dict[int, Any]) -> NDArray[np.bool_]:
    known: NDArray[np.bool_] = np.isfinite(cells)
    try:
        known &= cells != float(tags.get(NO_DATA, "nan"))
    except ValueError:
        return known
    return known


def terrain_of(grid: HeightGrid, size: tuple[float, float, float], file: Path, notes: Notes) -> Terrain:
    """Terrain of ``size`` [m], east, north and from the lowest to the highest cell; ``file``: the picture that is written for it.

    Raises BadInput for heights that are level.
    """
    heights = grid.heights
    rows, columns = heights.shape
    if max(rows, columns) > FINEST:
        ways = [np.linspace(0, n - 1, min(n, FINEST)) for n in (rows, columns)]
        blur = [max(n / FINEST - 1, 0.0) / 2 for n in (rows, columns)]
        smooth = ndimage.gaussian_filter(heights, blur)
        heights = ndimage.map_coordinates(smooth, np.meshgrid(*ways, indexing="ij"), order=1)
        notes.add(f"more than {FINEST} cells a side: taken every", f"{size[0] / (heights.shape[1] - 1):.3g} m")
    low, high = heights.min(), heights.max()
    if max(size) > WIDEST:
        cut = "cut out a part, e.g. with gdal_translate -projwin"
        raise BadInput(f"{file.name}: {size[0]:.4g} x {size[1]:.4g} x {size[2]:.4g} m; terrain has at most {WIDEST:g} m a side: {cut}")
    if size[2] < FLATTEST:
        raise BadInput(f"{file.name}: from the lowest to the highest {size[2]:g} m; that is level ground")
    Image.fromarray(np.round((heights - low) / (high - low) * STEPS).astype(np.uint16)).save(file)
    return Terrain(file.name, size)


def terrain_world(path: Path, folder: Path, size: tuple[float, float, float] | None, notes: Notes) -> WorldFile:
    """A world of ``folder`` with nothing but the terrain of a file of heights, its lowest at z = 0; size: [m] of one that states none.

    Raises BadInput.
    """
    grid = read_heights(path, notes)
    if grid.size is not None:
        whole = (*grid.size, float(np.ptp(grid.heights)))
        place = grid.origin
        origin = None if place is None else Origin(place.latitude, place.longitude, round(float(grid.heights.min()), 2))
    elif size is None:
        raise BadInput(f"{path}: a picture does not say how wide and high it is; give --terrain EAST NORTH HEIGHT, in metres")
    else:
        whole, origin = size, None
    notes.add(f"{whole[0]:.4g} x {whole[1]:.4g} m, {whole[2]:.4g} m from the lowest to the highest, which lie at z = 0 and above")
    terrain = terrain_of(grid, whole, folder / f"{path.stem}-heights.png", notes)
    if origin is None:
        notes.add("the file does not say where on Earth it lies: set 'origin'")
    floor, lies = terrain_floor(terrain, notes), origin or HOME
    return WorldFile(f"Terrain of {path.name}.", lies, floor, terrain=terrain, magnetic_field=earth_field(lies))


def terrain_floor(terrain: Terrain, notes: Notes) -> tuple[float, float, float, float]:
    """The floor of a terrain: all of it, or the middle of a large one, because plans and scores cut the floor into cells."""
    (x, y, _), (east, north) = terrain.position, (min(side, WIDEST_FLOOR) / 2 for side in terrain.size[:2])
    if max(terrain.size[:2]) > WIDEST_FLOOR:
        notes.add(f"the drivable floor is {WIDEST_FLOOR:g} m a side about the middle; set 'floor'")
    x_min, y_min, x_max, y_max = (round(v, 2) for v in (x - east, y - north, x + east, y + north))
    return x_min, y_min, x_max, y_max
