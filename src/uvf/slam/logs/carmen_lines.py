"""The lines of a CARMEN log, one by one: what they hold, and what is wrong with those that cannot be read.

Formats: the header of CARMEN's logger (logger_io) and carmen.sourceforge.net/logger_playback.html.
"""

import warnings
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Triple = tuple[float, float, float]

STAMP = 3
"""Words at the end of each line: ipc stamp, host, logger stamp."""
FEWEST_BEAMS = 2
NOWHERE = 1e9
"""m: no place on Earth is so far from another one."""


class UnreadableLine(ValueError):
    """A line that cannot be used, and why."""


class LaserFan(NamedTuple):
    """Directions of beams as a ROBOTLASER line has them: bearing of the first beam and step [rad], largest range [m]."""

    start: float
    step: float
    range_max: float


class LaserRecord(NamedTuple):
    """A FLASER or ROBOTLASER line: stamp [s], ranges (n,) [m]; only the latter tells how its beams lie and where the laser was."""

    stamp: float
    ranges: Floats
    odom_from_base: Triple
    odom_from_laser: Triple | None = None
    fan: LaserFan | None = None


@dataclass
class Lines:
    """Contents of a CARMEN file, in its order."""

    sweeps: list[LaserRecord] = field(default_factory=list)
    odometry: list[tuple[float, float, float, float]] = field(default_factory=list)
    """stamp, x, y, yaw."""
    params: dict[str, str] = field(default_factory=dict)
    faults: dict[str, list[int]] = field(default_factory=dict)
    """Numbers of the lines that were left out, by reason."""


def read_lines(text: Iterable[str]) -> Lines:
    """Reads lines; those of kinds that are of no use here are skipped in silence, broken ones are counted."""
    lines = Lines()
    with warnings.catch_warnings():
        # numpy warns where text is no number and will raise later; both mean the same here.
        warnings.simplefilter("error", DeprecationWarning)
        for number, line in enumerate(text, 1):
            try:
                _take(line, lines)
            except (ValueError, DeprecationWarning) as error:
                reason = str(error) if isinstance(error, UnreadableLine) else "words where numbers belong"
                lines.faults.setdefault(reason, []).append(number)
    return lines


def _take(line: str, lines: Lines) -> None:
    kind, rest = (*line.split(maxsplit=1), "", "")[:2]
    if kind == "FLASER":
        lines.sweeps.append(_flaser(rest))
    elif kind == "ROBOTLASER1":
        lines.sweeps.append(_robotlaser(rest))
    elif kind == "ODOM":
        numbers, stamp = _numbers_and_stamp(rest)
        if len(numbers) < 3:
            raise UnreadableLine("odometry cut short")
        lines.odometry.append((stamp, *_triple(numbers[:3])))
    elif kind == "PARAM":
        words = rest.split()
        if len(words) >= 2:
            lines.params[words[0]] = words[1]


def _numbers_and_stamp(rest: str) -> tuple[Floats, float]:
    """The numbers before the stamp, and the ipc stamp [s]."""
    words = rest.rsplit(None, STAMP)
    if len(words) <= STAMP:
        raise UnreadableLine("cut short")
    stamp = float(words[1])
    if not isfinite(stamp):
        raise UnreadableLine("stamp is no number")
    return np.fromstring(words[0], sep=" "), stamp


def _flaser(rest: str) -> LaserRecord:
    """num_readings, ranges, laser x y theta, robot x y theta."""
    numbers, stamp = _numbers_and_stamp(rest)
    n = _count(numbers, 0)
    if len(numbers) != 1 + n + 6:
        raise UnreadableLine("not as many ranges as the line says")
    return LaserRecord(stamp, numbers[1 : 1 + n], _triple(numbers[n + 4 : n + 7]))


def _robotlaser(rest: str) -> LaserRecord:
    """type, start, field of view, resolution, max range, accuracy, remission mode, num_readings, ranges, [num_remissions,
    remissions,] laser x y theta, robot x y theta, tv, rv, forward and side safety distance[, turn axis]."""
    numbers, stamp = _numbers_and_stamp(rest)
    n = _count(numbers, 7)
    tail = numbers[8 + n :]
    if len(tail) > 10 and 0 <= tail[0] <= len(tail) and len(tail) in (1 + tail[0] + 10, 1 + tail[0] + 11):
        tail = tail[1 + int(tail[0]) :]
    if len(tail) not in (10, 11):
        raise UnreadableLine("not as many ranges as the line says")
    start, view, step = _triple(numbers[1:4])
    range_max = float(numbers[4])
    step = step if step > 0.0 else view / (n - 1)
    if not step > 0.0:
        raise UnreadableLine("beams that all point the same way")
    return LaserRecord(stamp, numbers[8 : 8 + n], _triple(tail[3:6]), _triple(tail[:3]), LaserFan(start, step, range_max))


def _count(numbers: Floats, place: int) -> int:
    """The number of readings, which stands at ``place``."""
    count = numbers[place] if len(numbers) > place else np.nan
    if not FEWEST_BEAMS <= count <= len(numbers):
        raise UnreadableLine("not as many ranges as the line says")
    return int(count)


def _triple(numbers: Floats) -> Triple:
    x, y, yaw = numbers.tolist()
    if not all(isfinite(v) and abs(v) < NOWHERE for v in (x, y, yaw)):
        raise UnreadableLine("a pose or a direction that cannot be")
    return x, y, yaw
