"""What a mapping session has seen and worked out, in one file, so that mapping can go on later or elsewhere.

The file is an npz (a zip of arrays) with a header in JSON; it is checked as a whole before anything of it is used.
"""

import io
import json
import struct
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose
from uvf.models.whole_file import write_whole
from uvf.models.yaml_data import BadInput
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading

Floats = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]

FORMAT, VERSION = "uvf slam session", 2
"""Version 1 has no readings of further lidars."""
KINDS = ("odometry", "match", "loop")
"""What an edge comes from: wheels and IMU, a match of neighbours, a match after a loop."""
MOST_BYTES = 4 << 30
_TYPES: dict[str, Any] = {
    **{"stamps": np.float64, "lidar_of": np.int64, "poses": np.float64, "odometry": np.float64},
    **{"beam_counts": np.int64, "ranges": np.float32, "lidars": np.float64, "bearing_counts": np.int64, "bearings": np.float64},
    **{"aside": np.int64},
    **{"ends": np.int64, "measured": np.float64, "information": np.float64, "kinds": np.uint8, "enabled": np.bool_},
}
_EDGES = ("ends", "measured", "information", "kinds", "enabled")


_DAMAGED = (zipfile.BadZipFile, zlib.error, struct.error, ValueError, EOFError, RuntimeError, SyntaxError, MemoryError)
"""What zip, npy and JSON of a damaged file end in."""


@dataclass(frozen=True)
class Edges:
    """Measurements between keyframes, one row each.

    ends: (m, 2) keyframes i and j; measured: (m, 3) i_from_j [m, m, rad]; information: (m, 3, 3) inverse covariance of (x, y, yaw)
    of i_from_j; kinds: (m,) place in KINDS; enabled: (m,) whether it counts.
    """

    ends: NDArray[np.int64]
    measured: Floats
    information: Floats
    kinds: NDArray[np.uint8]
    enabled: NDArray[np.bool_]


NO_EDGES = Edges(np.zeros((0, 2), np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, np.uint8), np.zeros(0, np.bool_))


@dataclass(frozen=True)
class MappingSession:
    """A mapping session: keyframes in the order in which they were taken, and edges between them.

    method and parameters: what has made them, for the record.
    """

    keyframes: tuple[Keyframe, ...]
    edges: Edges
    method: str
    parameters: dict[str, Any]

    def moved(self, a_from_map: Pose2) -> "MappingSession":
        """The session with all poses in frame a."""
        return replace(self, keyframes=tuple(Keyframe(compose(a_from_map, k.map_from_base), k.reading) for k in self.keyframes))

    def save(self, path: Path) -> None:
        """Writes the session's file, ranges as float32. Raises BadInput, also for what ``load`` would refuse; what was there then stays."""
        write_whole(path, self.encoded(str(path)))

    def encoded(self, name: str) -> bytes:
        """The bytes of the session's file; name: for the message of BadInput."""
        arrays = _arrays(self)
        _check(arrays, name)
        header = {"format": FORMAT, "version": VERSION, "method": self.method, "parameters": self.parameters}
        buffer = io.BytesIO()
        np.savez_compressed(buffer, allow_pickle=False, header=np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays)
        return buffer.getvalue()

    @classmethod
    def load(cls, path: Path) -> "MappingSession":
        """Reads a session's file. Raises BadInput: none there, not a session, a later version, damaged, or numbers that make no sense."""
        try:
            data = path.read_bytes()
        except FileNotFoundError as error:
            raise BadInput(f"session {path}: no such file") from error
        except OSError as error:
            raise BadInput(f"session {path}: cannot be read: {error.strerror or error}") from error
        return cls.decoded(data, str(path))

    @classmethod
    def decoded(cls, data: bytes, name: str) -> "MappingSession":
        """The session in bytes that ``encoded`` has made. Raises BadInput as ``load`` does."""
        header, arrays = _read(io.BytesIO(data), name)
        _check(arrays, name)
        edges = Edges(*(arrays[name] for name in _EDGES))
        return cls(tuple(_keyframes(arrays)), edges, str(header.get("method", "")), dict(header.get("parameters", {})))


def _arrays(session: MappingSession) -> Arrays:
    """Rows of readings: first those of the keyframes, then those of further lidars; ``aside`` tells to which keyframe these belong."""
    own = [keyframe.reading for keyframe in session.keyframes]
    aside = [(k, other) for k, reading in enumerate(own) for other in reading.others]
    readings = [*own, *(other for _, other in aside)]
    lidars, lidar_of = _numbered(reading.beams for reading in readings)
    arrays = {
        "stamps": [reading.t for reading in readings],
        "lidar_of": lidar_of,
        "aside": [k for k, _ in aside],
        "poses": np.array([keyframe.map_from_base for keyframe in session.keyframes]).reshape(-1, 3),
        "odometry": np.array([reading.odom_from_base for reading in readings]).reshape(-1, 3),
        "beam_counts": [len(reading.ranges) for reading in readings],
        "ranges": np.concatenate([np.zeros(0), *(reading.ranges for reading in readings)]),
        "lidars": np.array([(*b.origin, b.range_min, b.range_max, b.duration) for b in lidars]).reshape(-1, 5),
        "bearing_counts": [len(b.bearings) for b in lidars],
        "bearings": np.concatenate([np.zeros(0), *(b.bearings for b in lidars)]),
        **{name: getattr(session.edges, name) for name in _EDGES},
    }
    return {name: np.asarray(values, dtype=_TYPES[name]) for name, values in arrays.items()}


def _numbered(all_beams: Iterable[Beams]) -> tuple[list[Beams], list[int]]:
    """The different ones, and which of them each is."""
    numbers: dict[tuple[Any, ...], int] = {}
    different: list[Beams] = []
    numbered: list[int] = []
    for beams in all_beams:
        key = (beams.origin, beams.range_min, beams.range_max, beams.duration, beams.bearings.tobytes())
        if key not in numbers:
            numbers[key] = len(different)
            different.append(beams)
        numbered.append(numbers[key])
    return different, numbered


def _keyframes(arrays: Arrays) -> Iterator[Keyframe]:
    bearings = np.split(arrays["bearings"], np.cumsum(arrays["bearing_counts"])[:-1])
    lidars = [Beams((x, y), b, low, high, t) for (x, y, low, high, t), b in zip(arrays["lidars"].tolist(), bearings, strict=False)]
    ranges = np.split(arrays["ranges"].astype(np.float64), np.cumsum(arrays["beam_counts"])[:-1])
    rows = zip(arrays["stamps"].tolist(), arrays["lidar_of"], arrays["odometry"].tolist(), ranges, strict=False)
    readings = [Reading(t, measured, lidars[lidar], Pose2(*odometry)) for t, lidar, odometry, measured in rows]
    aside: dict[int, list[Reading]] = {}
    for k, other in zip(arrays["aside"].tolist(), readings[len(arrays["poses"]) :], strict=True):
        aside.setdefault(k, []).append(other)
    for k, (pose, reading) in enumerate(zip(arrays["poses"].tolist(), readings, strict=False)):
        yield Keyframe(Pose2(*pose), replace(reading, others=tuple(aside.get(k, ()))))


def _read(data: io.BytesIO, path: str) -> tuple[dict[str, Any], Arrays]:
    try:
        with zipfile.ZipFile(data) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > MOST_BYTES:
                raise BadInput(f"session {path}: larger than {MOST_BYTES >> 30} GB when unpacked")
        data.seek(0)
        with np.load(data, allow_pickle=False) as file:
            header = json.loads(bytes(file["header"]))
            if not isinstance(header, dict) or header.get("format") != FORMAT:
                raise BadInput(f"session {path}: not a session of uvf slam")
            if header.get("version") not in (1, VERSION):
                raise BadInput(f"session {path}: version {header.get('version')}; this is read up to version {VERSION}: use a newer uvf")
            added = {"aside": np.zeros(0, np.int64)} if header["version"] == 1 else {}
            return header, {name: added[name] if name in added else file[name] for name in _TYPES}
    except KeyError as error:
        raise BadInput(f"session {path}: not a session of uvf slam, or damaged: {error.args[0]}") from error
    except _DAMAGED as error:
        raise BadInput(f"session {path}: not a session of uvf slam, or damaged: {_one_line(error)}") from error


def _check(a: Arrays, path: str) -> None:
    """Raises BadInput for the first thing that does not fit."""
    _check_shapes(a, path)
    for name in ("stamps", "poses", "odometry", "bearings", "measured", "information"):
        if not np.isfinite(a[name]).all():
            raise BadInput(f"session {path}: {name}: a number that is not finite, in row {int(np.argwhere(~np.isfinite(a[name]))[0][0])}")
    for name, count in (("lidar_of", len(a["lidars"])), ("ends", len(a["poses"])), ("aside", len(a["poses"])), ("kinds", len(KINDS))):
        wrong = a[name][(a[name] < 0) | (a[name] >= count)]
        if wrong.size:
            raise BadInput(f"session {path}: {name}: no number {int(wrong[0])}; there are {count}")
    unequal = np.flatnonzero(a["beam_counts"] != a["bearing_counts"][a["lidar_of"]])
    if len(unequal):
        count = a["beam_counts"][unequal[0]]
        raise BadInput(f"session {path}: keyframe {unequal[0]} has {count} ranges, not as many as its lidar has beams")


def _check_shapes(a: Arrays, path: str) -> None:
    for name, type_ in _TYPES.items():
        if a[name].dtype != type_:
            raise BadInput(f"session {path}: {name} is {a[name].dtype}, where {np.dtype(type_)} belongs")
    n, m, lidars = a["stamps"].size, a["kinds"].size, a["bearing_counts"].size
    shapes: dict[str, tuple[int, ...]] = {
        **dict.fromkeys(("stamps", "lidar_of", "beam_counts"), (n,)),
        **{"odometry": (n, 3), "poses": (n - a["aside"].size, 3), "aside": (a["aside"].size,)},
        **{"lidars": (lidars, 5), "bearing_counts": (lidars,), "ends": (m, 2), "measured": (m, 3), "information": (m, 3, 3)},
        **dict.fromkeys(("kinds", "enabled"), (m,)),
        **{"ranges": (int(a["beam_counts"].sum()),), "bearings": (int(a["bearing_counts"].sum()),)},
    }
    for name, shape in shapes.items():
        if a[name].shape != shape:
            raise BadInput(f"session {path}: {name} has shape {a[name].shape}, where {shape} belongs")
    for name in ("beam_counts", "bearing_counts"):
        if (a[name] < 0).any():
            raise BadInput(f"session {path}: {name} below zero")


def _one_line(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
