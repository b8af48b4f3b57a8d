"""The worlds of DynaBARN (Nair et al. 2022) from ``barn/dynabarn.json``: moving discs in an arena of 20 x 20 m with three walls.

The robot comes in through the open side at x = 10 m. As in Gazebo the discs follow Catmull-Rom splines.
"""

from pathlib import Path

import msgspec
import numpy as np

from benchmarks.planning.barn.movers import Interpolation, Track, movers_of
from benchmarks.planning.barn.worlds import World, barn_file
from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput

START = Pose2(11.0, 0.0, np.pi)
GOAL = (-9.0, 0.0)
WALLS = np.array(((-10.0, 0.0, 0.5, 20.0), (0.0, 10.0, 20.0, 0.5), (0.0, -10.0, 20.0, 0.5)))
"""Boxes: x, y of the middle, sizes along x and y [m]."""


class _Obstacle(msgspec.Struct, frozen=True):
    radius: float
    period: float
    keyframes: list[tuple[float, float, float]]


class _DynamicWorld(msgspec.Struct, frozen=True):
    difficulty: str
    obstacles: list[_Obstacle]


def _file(data: Path | None) -> tuple[Path, dict[int, _DynamicWorld]]:
    path = barn_file(data, "dynabarn.json")
    try:
        return path, msgspec.json.decode(path.read_bytes(), type=dict[int, _DynamicWorld])
    except msgspec.DecodeError as error:
        raise BadInput(f"{path}: {error}") from error


def dynamic_names(data: Path | None) -> dict[int, str]:
    """Names, difficulty and number, of the dynamic worlds that the folder holds, by number. Raises BadInput."""
    path, worlds = _file(data)
    if not worlds:
        raise BadInput(f"{path}: it holds no world")
    return {number: f"{world.difficulty}_{number}" for number, world in worlds.items()}


def dynamic_world(data: Path | None, number: int, interpolation: Interpolation = "catmull-rom") -> World:
    """The dynamic world of this number. Raises BadInput."""
    path, worlds = _file(data)
    if number not in worlds:
        raise BadInput(f"{path}: it holds no world {number}")
    world = worlds[number]
    tracks = [Track(o.radius, o.period, np.array(o.keyframes, dtype=np.float64)) for o in world.obstacles]
    try:
        movers = movers_of(tracks, interpolation)
    except ValueError as error:
        raise BadInput(f"{path}: world {number}, {error}") from error
    return World(f"{world.difficulty}_{number}", START, GOAL, np.zeros((0, 3)), WALLS, movers)
