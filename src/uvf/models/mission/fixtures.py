"""What a mission sets up in its world: markers that are looked for, and chargers."""

from collections.abc import Sequence
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.world.file import Colour, Cylinder, Field, Positive, WorldFile
from uvf.models.world.terrain import relief
from uvf.models.yaml_data import BadInput, FileLocation

Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]

MARKER = "marker_"
"""Begins the names of markers in the world; their numbers follow, from 1."""
CHARGER_COLOUR = (0.1, 0.65, 0.45)


class MarkerFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A coloured post that vehicles look for. Only simulators and scores know where it stands."""

    x: Annotated[Metres, key("m", "East of the world's origin.")]
    y: Annotated[Metres, key("m", "North of the world's origin.")]
    radius: Annotated[Positive, key("m", "Radius.")] = 0.3
    height: Annotated[Positive, key("m", "Height above the ground there.")] = 1.0
    colour: Annotated[Colour, plain("Red, green, blue, each 0 to 1.")] = (1.0, 0.0, 0.85)


class ChargerFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A place on the floor on which a ground vehicle is charged while it stands there. Tasks know where it is."""

    x: Annotated[Metres, key("m", "East of the world's origin.")]
    y: Annotated[Metres, key("m", "North of the world's origin.")]
    radius: Annotated[Positive, key("m", "Distance from its middle within which it charges.")] = 0.3
    power: Annotated[Positive, key("W", "Power that it gives.")] = 100.0


def furnished(world: WorldFile, markers: Sequence[MarkerFile], chargers: Sequence[ChargerFile], place: FileLocation) -> WorldFile:
    """The world with what a mission sets up on its ground. Raises BadInput for what would stand beside the floor."""
    if not markers and not chargers:
        return world
    for i, marker in enumerate(markers):
        _check_place(world, (marker.x, marker.y), place.at("markers", i))
    for i, charger in enumerate(chargers):
        _check_place(world, (charger.x, charger.y), place.at("chargers", i))
    land = relief(world)
    posts = []
    for i, marker in enumerate(markers):
        ground = 0.0 if land is None else float(land.at(np.array(marker.x), np.array(marker.y))[0])
        base = (marker.x, marker.y, ground)
        posts.append(Cylinder(name=f"{MARKER}{i + 1}", base=base, radius=marker.radius, height=marker.height, colour=marker.colour))
    pads = [Field(area=(c.x - c.radius, c.y - c.radius, c.x + c.radius, c.y + c.radius), colour=CHARGER_COLOUR) for c in chargers]
    return msgspec.structs.replace(world, cylinders=[*world.cylinders, *posts], fields=[*pads, *world.fields])


def _check_place(world: WorldFile, point: tuple[float, float], place: FileLocation) -> None:
    x_min, y_min, x_max, y_max = world.floor
    if not (x_min <= point[0] <= x_max and y_min <= point[1] <= y_max):
        floor = f"x {x_min:g}..{x_max:g}, y {y_min:g}..{y_max:g}"
        raise BadInput(f"{place}: ({point[0]:g}, {point[1]:g}) is not on the floor: {floor}")
