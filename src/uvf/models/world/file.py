"""``worlds/<name>/world.yaml``: walls, obstacles, wind and where on Earth it is, as data."""

import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.models.keys import key, name_like, plain
from uvf.models.quantities import PATH, Angle, Angles
from uvf.models.world.wind import Wind, check_wind
from uvf.models.yaml_data import BadInput, FileLocation, load_yaml, nearest

Share = Annotated[float, Meta(ge=0, le=1)]
Colour = tuple[Share, Share, Share]
Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]  # local coordinates stay near the origin
Positive = Annotated[float, Meta(ge=1e-4, le=1e4)]
Area = tuple[Metres, Metres, Metres, Metres]
FileName = Annotated[str, name_like(PATH, 200, "a file's name has letters, digits and _, ., / or -, and no spaces")]
Seconds = Annotated[float, Meta(ge=0, le=1e5)]
Script = list[tuple[Seconds, Metres, Metres, float]]
"""Keys of a motion: t [s], x, y [m], yaw [rad]; closed, for it begins anew at its end."""
Tesla = Annotated[float, Meta(ge=-1e-3, le=1e-3)]
TERRAIN = "terrain"  # what touches it is told so
LARGEST_FLOOR = 1e6  # m^2; maps and scores cut it into cells


class Origin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where the world frame's origin lies (WGS84)."""

    latitude: Annotated[float, Meta(ge=-90, le=90), key("deg", "WGS84 latitude of the point (0, 0, 0).")]
    longitude: Annotated[float, Meta(ge=-180, le=180), key("deg", "WGS84 longitude of the point (0, 0, 0).")]
    altitude: Annotated[float, Meta(ge=-500, le=10_000), key("m", "Height of z = 0 above mean sea level.")] = 0.0


class Wall(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An upright wall along a poly-line of corner points [m, world]."""

    points: Annotated[
        list[tuple[Metres, Metres]],
        Meta(min_length=2),
        plain("Corners [x, y] in metres, world frame; the wall runs along the line through them."),
    ]
    height: Annotated[Positive, key("m", "Height above z = 0.")] = 2.5
    thickness: Annotated[Positive, key("m", "Thickness, half to each side of the line.")] = 0.1
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.85, 0.83, 0.78)


class Box(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``rpy`` leans it, for ramps; with a ``path`` it moves by script: a door."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    centre: Annotated[tuple[Metres, Metres, Metres], plain("Middle of the box x, y, z [m], world frame.")]
    size: Annotated[tuple[Positive, Positive, Positive], plain("Length, width, height [m] along its own axes.")]
    rpy: Annotated[Angles, plain("Roll, pitch, yaw [rad]. A pitch makes a ramp: positive lowers the end at +x.")] = (0.0, 0.0, 0.0)
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.55, 0.4, 0.25)
    path: Annotated[
        Script,
        plain(
            "Motion by script: keys [t, x, y, yaw] in s, m, m, rad; t rises from 0, the last key is at the place of "
            "the first, and the motion repeats."
        ),
    ] = []
    hidden: Annotated[bool, plain("Felt by vehicles and lidars and not drawn, for `looks` show it.")] = False


class Ramp(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A sloping block that rises from the ground to ``height`` over ``length``, for rovers to drive up."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    foot: Annotated[tuple[Metres, Metres], plain("Middle of the lower edge x, y [m], world frame, on the ground z = 0.")]
    height: Annotated[Positive, key("m", "Height of the upper edge.")]
    length: Annotated[Positive, key("m", "Way from the lower edge to the upper one, seen from above.")]
    width: Annotated[Positive, key("m", "Width, half to each side of the foot.")]
    yaw: Annotated[Angle, key("rad", "Direction in which it rises, counter-clockwise from east.")] = 0.0
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.6, 0.52, 0.45)


class Cylinder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Stands on its lower face; ``rpy`` tilts it about that face's middle; with a ``path`` it moves by script: a person."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    base: Annotated[tuple[Metres, Metres, Metres], plain("Middle of the lower face x, y, z [m], world frame.")]
    radius: Annotated[Positive, key("m", "Radius.")]
    height: Annotated[Positive, key("m", "Height along its axis.")]
    rpy: Annotated[Angles, plain("Roll, pitch, yaw [rad]. The cylinder tilts about the middle of its lower face.")] = (0.0, 0.0, 0.0)
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.5, 0.5, 0.55)
    path: Annotated[
        Script,
        plain(
            "Motion by script: keys [t, x, y, yaw] in s, m, m, rad; t rises from 0, the last key is at the place of "
            "the first, and the motion repeats."
        ),
    ] = []
    hidden: Annotated[bool, plain("Felt by vehicles and lidars and not drawn, for `looks` show it.")] = False


class Sphere(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A ball."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    centre: Annotated[tuple[Metres, Metres, Metres], plain("Middle x, y, z [m], world frame.")]
    radius: Annotated[Positive, key("m", "Radius.")]
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.5, 0.5, 0.55)
    hidden: Annotated[bool, plain("Felt by vehicles and lidars and not drawn, for `looks` show it.")] = False


class Mesh(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Triangles of an STL or OBJ file in the world's folder; of a loaded world ``file`` is the whole path."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    file: Annotated[FileName, plain("STL or OBJ file in the world's folder.")]
    position: Annotated[tuple[Metres, Metres, Metres], plain("Place of the file's origin x, y, z [m], world frame.")] = (0.0, 0.0, 0.0)
    rpy: Annotated[Angles, plain("Roll, pitch, yaw [rad].")] = (0.0, 0.0, 0.0)
    scale: Annotated[tuple[Positive, Positive, Positive], plain("Factors along the file's axes; a file in millimetres needs 0.001.")] = (
        1.0,
        1.0,
        1.0,
    )
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.6, 0.6, 0.6)
    hidden: Annotated[bool, plain("Felt by vehicles and lidars and not drawn, for `looks` show it.")] = False


class Look(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Triangles that are seen by cameras and on the page and touch nothing; an OBJ file may have a picture, by its MTL file."""

    file: Annotated[FileName, plain("STL or OBJ file in the world's folder.")]
    position: Annotated[tuple[Metres, Metres, Metres], plain("Place of the file's origin x, y, z [m], world frame.")] = (0.0, 0.0, 0.0)
    rpy: Annotated[Angles, plain("Roll, pitch, yaw [rad].")] = (0.0, 0.0, 0.0)
    scale: Annotated[tuple[Positive, Positive, Positive], plain("Factors along the file's axes.")] = (1.0, 1.0, 1.0)
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1; a picture is multiplied by it.")] = (1.0, 1.0, 1.0)


class Field(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A level coloured patch on the ground, for eyes and cameras only: a meadow, a road, a floor."""

    area: Annotated[Area, plain("x_min, y_min, x_max, y_max [m], world frame.")]
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")]


class Strip(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A level runway that aircraft take off from and land on in both directions."""

    name: Annotated[str, plain("Name of the runway.")]
    centre: Annotated[tuple[Metres, Metres, Metres], plain("Middle of the runway x, y, z [m], world frame; z is its surface.")]
    yaw: Annotated[Angle, key("rad", "One of its two directions, counter-clockwise from east.")]
    length: Annotated[float, Meta(ge=20, le=1e4), key("m", "Length.")]
    width: Annotated[float, Meta(ge=2, le=200), key("m", "Width.")]


class Windsock(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A sock on a pole that shows the wind of the air simulation; vehicles bump into the pole alone."""

    name: Annotated[str, plain("Name that contacts and events use; no two things of a world share one.")]
    base: Annotated[tuple[Metres, Metres, Metres], plain("Foot of the pole x, y, z [m], world frame.")]
    height: Annotated[Positive, key("m", "Height of the pole, at whose top the wind is shown.")] = 6.0


class Terrain(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Hills from a grey picture, 8 or 16 bit: black is the height of ``position``, white ``size[2]`` above it, north is up.

    Its outermost pixels lie on the rim of ``size[0]`` x ``size[1]``. Beyond it the ground is z = 0, and it lies nowhere lower.
    """

    heights: Annotated[FileName, plain("Grey PNG, 8 or 16 bit, in the world's folder; its top is north.")]
    size: Annotated[tuple[Positive, Positive, Positive], plain("Extent [m]: east, north, and height from black to white.")]
    position: Annotated[
        tuple[Metres, Metres, Annotated[float, Meta(ge=0, le=1e4)]],
        plain("Place of the picture's middle x, y, and height of black z [m], world frame."),
    ] = (0.0, 0.0, 0.0)
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (0.42, 0.52, 0.3)


class WorldFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of world.yaml."""

    about: Annotated[str, plain("One sentence for lists.")]
    origin: Annotated[Origin, plain("Where on Earth the world frame's origin lies.")]
    floor: Annotated[Area, plain("Area that ground vehicles may use: x_min, y_min, x_max, y_max [m].")]
    walls: Annotated[list[Wall], plain("Upright walls.")] = []
    boxes: Annotated[list[Box], plain("Boxes: furniture, ramps, platforms, doors.")] = []
    ramps: Annotated[list[Ramp], plain("Ramps up to platforms.")] = []
    cylinders: Annotated[list[Cylinder], plain("Cylinders: pillars, people.")] = []
    spheres: Annotated[list[Sphere], plain("Spheres.")] = []
    meshes: Annotated[list[Mesh], plain("Things with a shape from a file.")] = []
    looks: Annotated[list[Look], plain("What is only seen; what it stands for is `hidden`.")] = []
    terrain: Annotated[Terrain | None, plain("Hills from a picture.")] = None
    strips: Annotated[list[Strip], plain("Runways that aircraft land on; they are not drawn.")] = []
    windsocks: Annotated[list[Windsock], plain("Windsocks; they show the wind that blows.")] = []
    wind: Annotated[Wind, plain("Wind of the place.")] = Wind()
    magnetic_field: Annotated[tuple[Tesla, Tesla, Tesla], plain("Magnetic field [T], ENU.")] = (0.0, 22.0e-6, -42.0e-6)
    ground_colour: Annotated[Colour, plain("Colour of the ground beyond the fields: red, green, blue, each 0 to 1.")] = (0.36, 0.5, 0.24)
    fields: Annotated[list[Field], plain("Coloured patches of ground, visual only. Where two overlap, the first counts.")] = []


def load_world(worlds: str | Path, name: str, named_at: FileLocation | None = None) -> WorldFile:
    """Reads ``<worlds>/<name>/world.yaml`` in the folder of all worlds; ``named_at``: the spot of a file that names it. Raises BadInput."""
    worlds = Path(worlds)
    path = worlds / name / "world.yaml"
    if not path.is_file():
        known = [p.parent.name for p in worlds.glob("*/world.yaml")]
        raise BadInput(f"{f'{named_at}: ' if named_at else ''}no world '{name}' in {worlds}; {nearest(name, known)}")
    world = load_yaml(path, WorldFile)
    place = FileLocation(str(path))
    check_wind(world.wind, place.at("wind"))
    _check_area(world.floor, place.at("floor"))
    x_min, y_min, x_max, y_max = world.floor
    if (x_max - x_min) * (y_max - y_min) > LARGEST_FLOOR:
        raise BadInput(f"{place.at('floor')}: more than {LARGEST_FLOOR:g} m^2; it is only where ground vehicles drive")
    for i, field in enumerate(world.fields):
        _check_area(field.area, place.at("fields", i, "area"))
    for i, wall in enumerate(world.walls):
        if any(a == b for a, b in pairwise(wall.points)):
            raise BadInput(f"{place.at('walls', i)}: the same point twice in a row; take one away")
    _check_things(world, path.parent, place)
    if world.terrain is not None:
        _check_file(path.parent, world.terrain.heights, place.at("terrain", "heights"))
    return _with_whole_paths(world, path.parent)


def _with_whole_paths(world: WorldFile, folder: Path) -> WorldFile:
    meshes, looks = (
        [msgspec.structs.replace(m, file=str((folder / m.file).resolve())) for m in part] for part in (world.meshes, world.looks)
    )
    world = msgspec.structs.replace(world, meshes=meshes, looks=looks)
    if world.terrain is None:
        return world
    terrain = msgspec.structs.replace(world.terrain, heights=str((folder / world.terrain.heights).resolve()))
    return msgspec.structs.replace(world, terrain=terrain)


def _check_file(folder: Path, name: str, place: FileLocation) -> None:
    if not (folder / name).is_file():
        near = nearest(name, (p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()))
        raise BadInput(f"{place}: no file '{name}' in {folder}; {near}")


def _check_area(area: tuple[float, float, float, float], place: FileLocation) -> None:
    x_min, y_min, x_max, y_max = area
    if x_min >= x_max or y_min >= y_max:
        raise BadInput(f"{place}: nothing lies in it; give x_min, y_min, x_max, y_max with each minimum below its maximum")


def _check_things(world: WorldFile, folder: Path, place: FileLocation) -> None:
    """What is touched is told by its name; scripts close; meshes are there."""
    seen = {TERRAIN} if world.terrain is not None else set()
    groups: dict[str, Sequence[Box | Ramp | Cylinder | Sphere | Mesh | Windsock]] = {
        "boxes": world.boxes,
        "ramps": world.ramps,
        "cylinders": world.cylinders,
        "spheres": world.spheres,
        "meshes": world.meshes,
        "windsocks": world.windsocks,
    }
    for group, things in groups.items():
        for i, thing in enumerate(things):
            if thing.name in seen:
                raise BadInput(f"{place.at(group, i, 'name')}: '{thing.name}' is given twice; each thing has a name of its own")
            seen.add(thing.name)
            if isinstance(thing, Box | Cylinder) and thing.path:
                _check_script(thing.path, place.at(group, i, "path"))
            if isinstance(thing, Mesh):
                _check_file(folder, thing.file, place.at(group, i, "file"))
    for i, look in enumerate(world.looks):
        _check_file(folder, look.file, place.at("looks", i, "file"))


def _check_script(keys: Script, place: FileLocation) -> None:
    times = [key[0] for key in keys]
    if len(keys) < 2 or times[0] != 0.0 or any(a >= b for a, b in pairwise(times)):
        raise BadInput(f"{place}: two or more keys [t, x, y, yaw] with t rising from 0 must stand there")
    if math.dist(keys[0][1:3], keys[-1][1:3]) > 1e-6:
        raise BadInput(f"{place}: it begins at {keys[0][1:3]} and ends at {keys[-1][1:3]}; come back to the beginning, for it goes round")
