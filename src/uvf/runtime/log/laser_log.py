"""Our own logs (MCAP): the scans of a ground vehicle, where they sit on it, and its odometry -> a LaserLog.

The odometry is the one that was published, wheels and IMU fused; nothing that a vehicle cannot know is read.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from google.protobuf.message import DecodeError
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import FrameTransforms, LaserScan, Odometry
from uvf.maths.se2_arrays import composed, interpolated, inverted
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.interface import Sample, matches
from uvf.runtime.log.reading import log_attachments, read_log
from uvf.runtime.log.replay import logged_site
from uvf.runtime.messages.convert import pose2_of, seconds
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.runtime.messages.readings.scans import Shape, beams_of, is_usable, shape_of
from uvf.sensors.fitted import sweeping_of
from uvf.sensors.sweeping import AT_ONCE, Sweeping
from uvf.slam.deskew import straightened
from uvf.slam.logs.jumps import without_jumps
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.logs.no_return import farthest_return
from uvf.slam.reading import Beams

Floats = NDArray[np.float64]

ENDING = ".mcap"
REACH = 0.1
"""s by which a scan may lie outside of the odometry's times: it is then taken to have been at the nearest end."""


@dataclass
class _Heard:
    """What a log has of one vehicle."""

    scans: list[LaserScan] = field(default_factory=list)
    odometry: list[tuple[float, float, float, float]] = field(default_factory=list)
    """t, x, y, yaw."""
    frames: FrameBuffer = field(default_factory=FrameBuffer)
    broken: int = 0

    def take(self, topic: Any, sample: Sample) -> None:
        try:
            message = topic.message.FromString(sample.payload)
        except DecodeError:
            self.broken += 1
            return
        if isinstance(message, LaserScan):
            self._take_if(is_usable(message), self.scans, message)
        elif isinstance(message, Odometry):
            pose = pose2_of(message.pose)
            self._take_if(all(map(isfinite, pose)), self.odometry, (seconds(message.timestamp), *pose))
        elif isinstance(message, FrameTransforms):
            self.frames.add(message, is_static=True)

    def _take_if(self, usable: bool, place: list[Any], what: Any) -> None:
        if usable:
            place.append(what)
        else:
            self.broken += 1


def samples_of(path: Path) -> Iterator[Sample]:
    """Messages of a log, or of all logs of a run's folder in order. Raises BadInput."""
    for log in _logs(path):
        yield from read_log(log)


def _logs(path: Path) -> list[Path]:
    return sorted(path.glob(f"*{ENDING}")) if path.is_dir() else [path]


def read_mcap(path: Path, vehicle: str | None = None) -> LaserLog:
    """Laser log of one vehicle, which needs a name where several have a lidar. path: a log or a run's folder. Raises BadInput."""
    heard: dict[str, _Heard] = {}
    wanted = (topics.SCAN, topics.ODOMETRY, topics.TF_STATIC)
    for sample in samples_of(path):
        for topic in wanted:
            if matches(topic.at("*"), sample.key):
                heard.setdefault(sample.key.split("/")[1], _Heard()).take(topic, sample)
    name = _chosen(path, [name for name, h in heard.items() if h.scans], vehicle)
    return _assembled(path, name, heard[name])


def _chosen(path: Path, with_scans: list[str], vehicle: str | None) -> str:
    if not with_scans:
        raise BadInput(f"log {path}: no scan in it: no vehicle of the run has a lidar")
    if vehicle is None and len(with_scans) > 1:
        raise BadInput(f"log {path}: several vehicles have scans; name one with --vehicle: {', '.join(sorted(with_scans))}")
    if vehicle is not None and vehicle not in with_scans:
        raise BadInput(f"log {path}: no scan of a vehicle '{vehicle}'; {nearest(vehicle, with_scans)}")
    return vehicle or with_scans[0]


def _assembled(path: Path, name: str, heard: _Heard) -> LaserLog:
    if not heard.odometry:
        raise BadInput(f"log {path}: no odometry of '{name}' in it")
    track = np.array(heard.odometry)
    track = track[np.unique(track[:, 0], return_index=True)[1]]
    track[:, 1:], leapt = without_jumps(track[:, 0], track[:, 1:])
    track[:, 3] = np.unwrap(track[:, 3])
    sweeping, unknown = _sweeping(path, name)
    scans = sorted(heard.scans, key=lambda s: seconds(s.timestamp))
    first = np.array([seconds(s.timestamp) for s in scans])
    usable = (first >= track[0, 0] - REACH) & (first + sweeping.duration <= track[-1, 0] + REACH)
    scans, first = [s for s, kept in zip(scans, usable, strict=True) if kept], first[usable]
    if not scans:
        raise BadInput(f"log {path}: the scans and the odometry of '{name}' are of different times")
    stamps = first + sweeping.duration
    track[:, 1:] = composed(inverted(interpolated(track, stamps[:1])[0]), track[:, 1:])
    track[:, 3] = np.unwrap(track[:, 3])
    beams = _beams(path, name, scans, (heard.frames, sweeping))
    readings = [
        straightened(sweeping.in_order(np.array(scan.ranges)), shape, t, lambda times: interpolated(track, times))
        for t, scan, shape in zip(first.tolist(), scans, beams, strict=True)
    ]
    counts = (
        (int((~usable).sum()), "scans without odometry are left out"),
        (heard.broken, "messages that cannot be read are left out"),
        (len(leapt), "leaps of the odometry are taken for standing still"),
    )
    notes = (*(f"log {path}: {count} {what}" for count, what in counts if count), *unknown)
    return LaserLog(f"{path.stem}-{name}", readings, stamps, OdometryTrack(track[:, 0], track[:, 1:]), notes)


def _sweeping(path: Path, name: str) -> tuple[Sweeping, tuple[str, ...]]:
    """As the vehicle's file in the log has it, and what is to be told; without such a file, all beams at once."""
    log = _logs(path)[0]
    if not log_attachments(log):
        return AT_ONCE, ()
    try:
        with logged_site(log) as site:
            lidar = site.members[name].file.sensors.lidar if name in site.members else None
            return (sweeping_of(lidar) if lidar is not None else AT_ONCE), ()
    except BadInput:
        return AT_ONCE, (f"log {path}: the files of the run in it cannot be read: all beams of a scan are taken to be of its stamp",)


def _beams(path: Path, name: str, scans: list[LaserScan], lidar: tuple[FrameBuffer, Sweeping]) -> list[Beams]:
    """For each scan; equal ones are one object. lidar: where it sits, and how it sweeps."""
    frames, sweeping = lidar
    limit = farthest_return([np.array(s.ranges) for s in scans])
    known: dict[Shape, Beams] = {}
    found = []
    for scan in scans:
        key = shape_of(scan)
        if key not in known:
            try:
                base_from_lidar = frames.lookup(f"{name}/base_footprint", scan.frame_id)
            except FrameError as error:
                raise BadInput(f"log {path}: where the lidar sits on '{name}' is not told: {error}") from error
            known[key] = beams_of(scan, base_from_lidar, (0.0, limit), sweeping)
        found.append(known[key])
    return found
