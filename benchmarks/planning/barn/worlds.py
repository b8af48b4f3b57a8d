"""The worlds of the BARN challenge (Perille et al. 2020): what stands in them, start, goal, and which of them are wanted.

Static worlds are cylinders of 0.075 m in ``barn/barn_worlds.npz`` with path lengths in ``barn/worlds.csv``.
"""

import csv
import re
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.movers import NO_MOVERS, Movers
from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput, listed, nearest

Floats = NDArray[np.float64]

RADIUS = 0.075  # m, of a cylinder; cells of the path are twice as wide
START = Pose2(-2.25, 3.0, np.pi / 2)
GOAL = (-2.25, 13.0)
TOP_SPEED = 2.0  # m/s, of which the optimal time counts


@dataclass(frozen=True)
class World:
    """A world: discs (n, 3) x, y, radius [m] and boxes (m, 4) x, y of the middle, sizes along x and y [m] stand, movers move.

    optimal_time: s, path length at the top speed, None where no score is counted; path: (k, 2) [m] the organisers', if any.
    """

    name: str
    start: Pose2
    goal: tuple[float, float]
    discs: Floats
    boxes: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    movers: Movers = NO_MOVERS
    optimal_time: float | None = None
    path: Floats | None = None


def barn_file(data: Path | None, name: str) -> Path:
    """The file ``barn/name`` below the folder of data. Raises BadInput."""
    if data is None:
        raise BadInput("bench nav needs worlds: name the folder above barn/ with --data")
    path = data / "barn" / name
    if not path.is_file():
        raise BadInput(f"bench nav needs worlds: there is no file {path}; name the folder above barn/ with --data")
    return path


def static_names(data: Path | None) -> dict[int, str]:
    """Names of the static worlds that the folder holds, by number. Raises BadInput."""
    path = barn_file(data, "barn_worlds.npz")
    try:
        with np.load(path, allow_pickle=False) as file:
            numbers = sorted(int(found[1]) for key in file.files if (found := re.fullmatch(r"world_(\d+)", key)))
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, AttributeError) as error:
        raise BadInput(f"{path}: not an archive of numpy arrays ({error})") from error
    if not numbers:
        raise BadInput(f"{path}: it holds no array world_NUMBER")
    return {number: f"world_{number}" for number in numbers}


def static_world(data: Path | None, number: int) -> World:
    """The static world of this number. Raises BadInput."""
    path = barn_file(data, "barn_worlds.npz")
    centres = _points(path, f"world_{number}")
    if centres is None:
        raise BadInput(f"{path}: it holds no array world_{number}")
    cells = _points(path, f"path_{number}")
    way = None if cells is None else cells * 2 * RADIUS + np.array((-61 * RADIUS, RADIUS + 5.0))
    discs = np.column_stack((centres, np.full(len(centres), RADIUS)))
    length = _path_lengths(barn_file(data, "worlds.csv")).get(number)
    if length is None:
        raise BadInput(f"{barn_file(data, 'worlds.csv')}: no row for world {number}; its path length is needed for the score")
    return World(f"world_{number}", START, GOAL, discs, optimal_time=length / TOP_SPEED, path=way)


def _points(path: Path, key: str) -> Floats | None:
    """(n, 2), None where the archive has no such array."""
    try:
        with np.load(path, allow_pickle=False) as file:
            found: Floats | None = file[key] if key in file.files else None
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise BadInput(f"{path}: {key} cannot be read ({error})") from error
    if found is None:
        return None
    if found.ndim != 2 or found.shape[1] != 2 or found.dtype.kind not in "fiu" or not np.isfinite(found).all():
        raise BadInput(f"{path}: {key} is {found.dtype} {found.shape}; it must be (n, 2) finite numbers")
    return found.astype(np.float64)


def _path_lengths(path: Path) -> dict[int, float]:
    """m by number of the world."""
    lengths: dict[int, float] = {}
    with path.open(encoding="utf-8", newline="") as file:
        for line, row in enumerate(csv.DictReader(file), 2):
            try:
                lengths[int(row["world"])] = length = float(row["path_length_m"])
            except (KeyError, ValueError, TypeError) as error:
                raise BadInput(f"{path}:{line}: needs a whole number in column world and a number in path_length_m ({error!r})") from error
            if not 0.0 < length < np.inf:
                raise BadInput(f"{path}:{line}: path_length_m is {length}; it must be above 0 m")
    return lengths


def chosen(wanted: str | None, names: Mapping[int, str]) -> list[int]:
    """Numbers of the worlds that ``wanted`` names, in rising order, of those that there are; None stands for all.

    Parts are separated by commas: a number, a range FIRST:BEYOND or FIRST:BEYOND:STEP of numbers, a name, or a pattern of names as
    ``easy_*``. A range takes what there is of it. Raises BadInput for a part that names nothing.
    """
    if wanted is None:
        return sorted(names)
    found: set[int] = set()
    for part in (part.strip() for part in wanted.split(",")):
        numbers = _numbers(part, names)
        if not numbers:
            raise BadInput(f"--worlds {part}: there is no such world; {_there_are(part, names)}")
        found |= numbers
    return sorted(found)


def _numbers(part: str, names: Mapping[int, str]) -> set[int]:
    if part.isdecimal():
        return {int(part)} & names.keys()
    if ends := re.fullmatch(r"(\d*):(\d*)(?::(\d+))?", part):
        first, beyond, step = int(ends[1] or 0), int(ends[2] or max(names) + 1), int(ends[3] or 1)
        return {n for n in names if first <= n < beyond and step > 0 and (n - first) % step == 0}
    return {n for n, name in names.items() if fnmatchcase(name, part)}


def _there_are(part: str, names: Mapping[int, str]) -> str:
    if re.fullmatch(r"[\d:]+", part):
        return f"numbers are {listed(str(n) for n in sorted(names))}"
    return nearest(part, names.values())
