"""Worlds of others taken over into a folder of ``worlds/``."""

import re
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from uvf.models.importing.heights import TIFF, terrain_world
from uvf.models.importing.map_image import map_world
from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf.world import SdfImport
from uvf.models.world.file import WorldFile, load_world
from uvf.models.world.writer import write_world
from uvf.models.yaml_data import BadInput

SDF = (".world", ".sdf")
PICTURES = (".pgm", ".png")
MAPS = (".yaml", ".yml", *PICTURES)
BUILDING, ROBOTS = ".building.yaml", (".urdf", ".xacro")


class Options(NamedTuple):
    """Options of an import. models: folders with Gazebo models; height: of a map's walls [m]; replace: overwrite a world of that name.

    upright: turn meshes that say that y is up; terrain: [m] east, north and height of a picture of heights, which is no map then.
    """

    models: Sequence[Path] = ()
    height: float = 2.0
    replace: bool = False
    upright: bool = False
    terrain: tuple[float, float, float] | None = None


def import_world(file: Path, folder: Path, options: Options) -> tuple[Path, list[str]]:
    """Imports a world; returns the new world.yaml and lines about what is in it and what was left out. Raises BadInput."""
    _refuse_taken(folder, options.replace)
    if not file.is_file():
        raise BadInput(f"{file}: no such file")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".import-", dir=folder.parent) as scratch:
        made = Path(scratch) / folder.name
        made.mkdir()
        world, notes = _read(file, made, options)
        written = write_world(world, made, [f"note: {note}" for note in notes])
        try:
            load_world(made.parent, made.name)
        except BadInput as error:
            raise BadInput(f"{file}: {str(error).rpartition('world.yaml:')[2].partition(': ')[2]}") from error
        make_room(folder, options.replace)
        made.rename(folder)
    return folder / written.name, [*(f"note: {note}" for note in notes), _counts(world)]


def new_folder(worlds: Path, name: str) -> Path:
    """Folder of a world of that name. Raises BadInput for a name that is no plain folder's."""
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_-]*", name):
        raise BadInput(f"a world cannot be called '{name}'; use letters, digits, - and _")
    return worlds / name


def make_room(folder: Path, replace: bool) -> None:
    """Removes a folder that is there already when it may be replaced. Raises BadInput when it may not."""
    _refuse_taken(folder, replace)
    shutil.rmtree(folder, ignore_errors=True)


def _refuse_taken(folder: Path, replace: bool) -> None:
    if folder.exists() and not replace:
        raise BadInput(f"{folder} is there already; give another --name, or --replace to overwrite it")


def _read(file: Path, folder: Path, options: Options) -> tuple[WorldFile, list[str]]:
    if file.suffix.lower() in TIFF or options.terrain is not None:
        notes = Notes()
        return terrain_world(file, folder, options.terrain, notes), notes.lines()
    if file.suffix in PICTURES and not any(file.with_suffix(ending).is_file() for ending in (".yaml", ".yml")):
        heights = "one of heights is taken with --terrain EAST NORTH HEIGHT, in metres"
        raise BadInput(f"{file}: a picture of a map has {file.stem}.yaml beside it, which says its resolution and origin; {heights}")
    if file.name.endswith(BUILDING):
        raise BadInput(f"{file}: a building as drawn for Open-RMF is no map; give the SDF world that rmf_building_map_tools make of it")
    if file.suffix in ROBOTS:
        raise BadInput(f"{file}: a URDF is a vehicle ('uvf vehicle import'); of a building make an SDF of it first: gz sdf -p FILE.urdf")
    if file.suffix in MAPS:
        notes = Notes()
        return map_world(file, options.height, notes), notes.lines()
    if file.suffix not in SDF:
        raise BadInput(f"{file}: files of this kind are not taken over; give {', '.join((*SDF, *MAPS, *TIFF))}")
    reading = SdfImport(file, folder, options.models, options.upright)
    return reading.world(), reading.notes.lines()


def _counts(world: WorldFile) -> str:
    groups = ("boxes", "cylinders", "spheres", "meshes", "looks")
    counts = [f"{len(getattr(world, group))} {group}" for group in groups]
    return "taken over: " + ", ".join([*(["terrain"] if world.terrain is not None else []), *counts])
