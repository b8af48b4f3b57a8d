"""``worlds/<name>/world.yaml``: walls, obstacles, wind and where on Earth it is, as data."""

from itertools import pairwise
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.runtime.params import BadInput, Place, load_yaml, nearest

Share = Annotated[float, Meta(ge=0, le=1)]
Colour = tuple[Share, Share, Share]
Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]  # local coordinates stay near the origin
Positive = Annotated[float, Meta(ge=1e-4, le=1e4)]
Area = tuple[Metres, Metres, Metres, Metres]
WindSpeed = Annotated[float, Meta(ge=-100, le=100)]
Tesla = Annotated[float, Meta(ge=-1e-3, le=1e-3)]
LARGEST_FLOOR = 1e6  # m^2; maps and scores cut it into cells


class Origin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where the world frame's origin lies (WGS84)."""

    latitude: Annotated[float, Meta(ge=-90, le=90)]  # deg
    longitude: Annotated[float, Meta(ge=-180, le=180)]  # deg
    altitude: Annotated[float, Meta(ge=-500, le=10_000)] = 0.0  # m AMSL


class Wall(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An upright wall along a poly-line of corner points [m, world]."""

    points: Annotated[list[tuple[Metres, Metres]], Meta(min_length=2)]
    height: Positive = 2.5  # m
    thickness: Positive = 0.1  # m
    colour: Colour = (0.85, 0.83, 0.78)


class Box(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    name: str
    centre: tuple[Metres, Metres, Metres]  # m, world
    size: tuple[Positive, Positive, Positive]  # m
    yaw: float = 0.0  # rad
    colour: Colour = (0.55, 0.4, 0.25)


class Cylinder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Upright, standing on its lower face."""

    name: str
    base: tuple[Metres, Metres, Metres]  # m, world
    radius: Positive  # m
    height: Positive  # m
    colour: Colour = (0.5, 0.5, 0.55)


class Field(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A level coloured patch on the ground, for eyes and cameras only: a meadow, a road, a floor."""

    area: Area  # m: x_min, y_min, x_max, y_max
    colour: Colour


class Wind(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Steady wind: velocity of the air, the way it blows to, ENU [m/s]."""

    steady: tuple[WindSpeed, WindSpeed, WindSpeed] = (0.0, 0.0, 0.0)


class WorldFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of world.yaml."""

    about: str
    origin: Origin
    floor: Area  # m: x_min, y_min, x_max, y_max of the drivable area
    walls: list[Wall] = []
    boxes: list[Box] = []
    cylinders: list[Cylinder] = []
    wind: Wind = Wind()
    magnetic_field: tuple[Tesla, Tesla, Tesla] = (0.0, 22.0e-6, -42.0e-6)  # T, ENU
    ground_colour: Colour = (0.36, 0.5, 0.24)
    fields: list[Field] = []


def load_world(worlds: Path, name: str) -> WorldFile:
    """Reads ``worlds/<name>/world.yaml``. Raises BadInput."""
    path = worlds / name / "world.yaml"
    if not path.is_file():
        known = [p.parent.name for p in worlds.glob("*/world.yaml")]
        raise BadInput(f"no world '{name}' in {worlds}; {nearest(name, known)}")
    world = load_yaml(path, WorldFile)
    place = Place(str(path))
    _check_area(world.floor, place.at("floor"))
    x_min, y_min, x_max, y_max = world.floor
    if (x_max - x_min) * (y_max - y_min) > LARGEST_FLOOR:
        raise BadInput(f"{place.at('floor')}: more than {LARGEST_FLOOR:g} m^2; it is only where ground vehicles drive")
    for i, field in enumerate(world.fields):
        _check_area(field.area, place.at("fields", i, "area"))
    for i, wall in enumerate(world.walls):
        if any(a == b for a, b in pairwise(wall.points)):
            raise BadInput(f"{place.at('walls', i)}: the same point twice in a row; take one away")
    _check_names(world, place)
    return world


def _check_area(area: tuple[float, float, float, float], place: Place) -> None:
    x_min, y_min, x_max, y_max = area
    if x_min >= x_max or y_min >= y_max:
        raise BadInput(f"{place}: nothing lies in it; give x_min, y_min, x_max, y_max with each minimum below its maximum")


def _check_names(world: WorldFile, place: Place) -> None:
    """What is touched is told by its name."""
    seen: set[str] = set()
    named = [("boxes", i, box.name) for i, box in enumerate(world.boxes)]
    for group, i, name in [*named, *(("cylinders", i, cylinder.name) for i, cylinder in enumerate(world.cylinders))]:
        if name in seen:
            raise BadInput(f"{place.at(group, i, 'name')}: '{name}' is given twice; each thing has a name of its own")
        seen.add(name)
