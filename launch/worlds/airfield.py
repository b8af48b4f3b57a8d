"""Made-up airfields: a strip with its markings, a hangar, a windsock, and the magnetic field of the place."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip
from uvf.maths.rotations import from_euler, rotate
from uvf.models.world.earth_field import earth_field
from uvf.models.world.file import LARGEST_FLOOR, Area, Box, Colour, Look, Origin, Strip, Windsock, WorldFile

PLATE = "plate.obj"  # a square metre, level, seen from above
ABOVE, HIGHER = 0.02, 0.04  # m above the ground: asphalt, and paint on it
ASPHALT: Colour = (0.33, 0.33, 0.35)
PAINT: Colour = (0.92, 0.92, 0.92)
GRASS: Colour = (0.4, 0.52, 0.28)
HANGAR: Colour = (0.6, 0.6, 0.63)
BESIDE = 20.0  # m beside the strip that stay free
AROUND = 60.0  # m about the strip that belong to the floor
BARS, BAR_LENGTH = 4, 6.0  # of a threshold, to each side; m
DASH = 10.0  # m, of the centre line, and between two of them


class AirfieldPlan(NamedTuple):
    """What an airfield is made from: where it lies, length and width of its strip [m], and the course [rad] of one of its directions."""

    place: Origin
    length: float
    width: float
    course: float


def airfield(field: AirfieldPlan, about: str) -> WorldFile:
    """The world of an airfield; the strip's middle is the world's origin. It needs ``plate`` beside its file."""
    yaw = math.remainder(math.pi / 2 - field.course, math.tau)
    hangar, sock = _at(yaw, -0.1 * field.length, field.width / 2 + BESIDE + 8.0), _at(yaw, 0.0, -field.width / 2 - BESIDE)
    return WorldFile(
        about,
        field.place,
        _floor(field, yaw),
        boxes=[Box("hangar", (*hangar, 2.5), (16.0, 12.0, 5.0), (0.0, 0.0, yaw), HANGAR)],
        looks=[_plate(yaw, (0.0, 0.0), (field.length, field.width), ABOVE, ASPHALT), *_paint(field, yaw)],
        strips=[Strip("strip", (0.0, 0.0, 0.0), yaw, field.length, field.width)],
        windsocks=[Windsock("windsock", (*sock, 0.0))],
        magnetic_field=earth_field(field.place),
        ground_colour=GRASS,
    )


def write_plate(folder: Path) -> None:
    """Writes the file that asphalt and paint are made of."""
    corners = ("-0.5 -0.5", "0.5 -0.5", "0.5 0.5", "-0.5 0.5")
    lines = [*(f"v {corner} 0" for corner in corners), "f 1 2 3", "f 1 3 4"]
    (folder / PLATE).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _paint(field: AirfieldPlan, yaw: float) -> list[Look]:
    """Threshold bars, the centre line, and a mark to both sides of where the wheels are meant to touch."""
    made, half = [], field.length / 2
    for end in (-1.0, 1.0):
        for k in range(2 * BARS):
            across = (k + 0.5 - BARS) * 0.9 * field.width / (2 * BARS)
            made.append(_plate(yaw, (end * (half - 2.0 - BAR_LENGTH / 2), across), (BAR_LENGTH, 0.05 * field.width), HIGHER, PAINT))
        aim = _aim(field, end)
        made += [_plate(yaw, (aim, side * 0.3 * field.width), (4.0, 0.1 * field.width), HIGHER, PAINT) for side in (-1.0, 1.0)]
    dashes = max(int((field.length - 4 * BAR_LENGTH) // (2 * DASH)), 1)
    made += [_plate(yaw, (2 * DASH * (k - (dashes - 1) / 2), 0.0), (DASH, 0.25), HIGHER, PAINT) for k in range(dashes)]
    return made


def _aim(field: AirfieldPlan, end: float) -> float:
    """m along the strip of the point where the wheels are meant to touch, of those that come in over this end."""
    lane = LandingStrip(Place(0.0, 0.0, 0.0), 0.0, field.length, field.width).lane(0.0)
    return -end * lane.aim.north


def _plate(yaw: float, at: tuple[float, float], size: tuple[float, float], z: float, colour: Colour) -> Look:
    return Look(PLATE, (*_at(yaw, *at), z), (0.0, 0.0, yaw), (*size, 1.0), colour)


def _at(yaw: float, along: float, across: float) -> tuple[float, float]:
    """x, y [m, world] of a point by its place along the strip and to the left of it."""
    x, y, _ = rotate(from_euler(0.0, 0.0, yaw), np.array((along, across, 0.0)))
    return float(x), float(y)


def _floor(field: AirfieldPlan, yaw: float) -> Area:
    """A rectangle about the strip, or the middle of it."""
    half = [abs(math.cos(turn)) * field.length / 2 + abs(math.sin(turn)) * field.width / 2 + AROUND for turn in (yaw, yaw + math.pi / 2)]
    x, y = (min(side, math.sqrt(LARGEST_FLOOR) / 2) for side in half)
    return -x, -y, x, y
