"""``worlds/<name>/world.yaml``: walls, obstacles, wind and where on Earth it is, as data."""

from itertools import pairwise
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.runtime.params import BadInput, load_yaml, nearest

Colour = tuple[float, float, float]
Positive = Annotated[float, Meta(gt=0)]


class Origin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where the world frame's origin lies (WGS84)."""

    latitude: Annotated[float, Meta(ge=-90, le=90)]  # deg
    longitude: Annotated[float, Meta(ge=-180, le=180)]  # deg
    altitude: float = 0.0  # m AMSL


class Wall(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An upright wall along a poly-line of corner points [m, world]."""

    points: Annotated[list[tuple[float, float]], Meta(min_length=2)]
    height: Positive = 2.5  # m
    thickness: Positive = 0.1  # m
    colour: Colour = (0.85, 0.83, 0.78)


class Box(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    name: str
    centre: tuple[float, float, float]  # m, world
    size: tuple[Positive, Positive, Positive]  # m
    yaw: float = 0.0  # rad
    colour: Colour = (0.55, 0.4, 0.25)


class Cylinder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Upright, standing on its lower face."""

    name: str
    base: tuple[float, float, float]  # m, world
    radius: Positive  # m
    height: Positive  # m
    colour: Colour = (0.5, 0.5, 0.55)


class Field(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A level coloured patch on the ground, for eyes and cameras only: a meadow, a road, a floor."""

    area: tuple[float, float, float, float]  # m: x_min, y_min, x_max, y_max
    colour: Colour


class Wind(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Steady wind: velocity of the air, the way it blows to, ENU [m/s]."""

    steady: tuple[float, float, float] = (0.0, 0.0, 0.0)


class WorldFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The whole of world.yaml."""

    about: str
    origin: Origin
    floor: tuple[float, float, float, float]  # m: x_min, y_min, x_max, y_max of the drivable area
    walls: list[Wall] = []
    boxes: list[Box] = []
    cylinders: list[Cylinder] = []
    wind: Wind = Wind()
    magnetic_field: tuple[float, float, float] = (0.0, 22.0e-6, -42.0e-6)  # T, ENU
    ground_colour: Colour = (0.36, 0.5, 0.24)
    fields: list[Field] = []


def load_world(worlds: Path, name: str) -> WorldFile:
    """Reads ``worlds/<name>/world.yaml``. Raises BadInput."""
    path = worlds / name / "world.yaml"
    if not path.is_file():
        known = [p.parent.name for p in worlds.glob("*/world.yaml")]
        raise BadInput(f"no world '{name}' in {worlds}; {nearest(name, known)}")
    world = load_yaml(path, WorldFile)
    for i, wall in enumerate(world.walls):
        if any(a == b for a, b in pairwise(wall.points)):
            raise BadInput(f"{path}: walls[{i}]: the same point twice in a row; take one away")
    return world
