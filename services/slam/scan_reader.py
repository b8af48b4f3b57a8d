"""Scans as readings: with the beams' places on the vehicle, straightened, and where the odometry had it."""

from collections.abc import Iterable, Sequence
from contextlib import suppress

import numpy as np

from schemas.messages import LaserScan
from uvf.maths.rotations import level_from, matrix
from uvf.maths.se3 import planar
from uvf.models.vehicle.sensors import Lidar
from uvf.runtime.messages.convert import seconds
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.runtime.messages.readings.scans import Shape, beams_of, is_usable, sees_nothing, shape_of
from uvf.sensors.fitted import sweeping_of
from uvf.slam.deskew import straightened
from uvf.slam.levelling import levelled
from uvf.slam.reading import Beams, Reading

TOGETHER = 0.3  # s between readings of two lidars that go into one keyframe
MOST_SHAPES = 16  # of scans, that are kept; more come from a lidar whose angles are never the same


class ScanReader:
    """One lidar's."""

    def __init__(self, vehicle: str, lidar: Lidar) -> None:
        self._odom, self._base = f"{vehicle}/odom", f"{vehicle}/base_footprint"
        self._limits, self._sweeping = (lidar.range_min, lidar.range_max), sweeping_of(lidar)
        self._beams: dict[Shape, Beams] = {}
        self._scan_time = -1.0
        self._ranges = np.zeros(0)
        self._waiting: LaserScan | None = None

    def read(self, scan: LaserScan, frames: FrameBuffer) -> Reading | None:
        """A new scan from where the lidar was at its last beam; None for one that has been seen. Raises FrameError.

        One that is ahead of the frames waits for the next call: of a quick lidar the newest scan always is.
        """
        try:
            return self._read(scan, frames)
        except FrameError:
            waited, self._waiting = self._waiting, scan
            if waited is None or waited is scan:
                raise
        return self._read(waited, frames)

    def _read(self, scan: LaserScan, frames: FrameBuffer) -> Reading | None:
        """Raises FrameError.

        Noise makes each scan another: one that is equal comes from a lidar that is frozen, whatever its stamp says, unless nothing
        came back at all.
        """
        taken_at = seconds(scan.timestamp)
        if taken_at <= self._scan_time or not is_usable(scan):
            return None
        if shape_of(scan) not in self._beams:
            if len(self._beams) == MOST_SHAPES:
                self._beams.clear()
            base_from_lidar = frames.lookup(self._base, scan.frame_id)
            self._beams[shape_of(scan)] = beams_of(scan, base_from_lidar, self._limits, self._sweeping)
        ranges = self._sweeping.in_order(np.array(scan.ranges))
        reading = straightened(
            ranges,
            self._beams[shape_of(scan)],
            taken_at,
            lambda times: np.array([planar(frames.lookup(self._odom, self._base, t)) for t in times.tolist()]),
        )
        level_from_base = level_from(frames.lookup(self._odom, self._base, reading.t).rotation)
        if level_from_base[1:3].any():
            reading = levelled(reading, matrix(level_from_base), float(frames.lookup(self._base, scan.frame_id).translation[2]))
        self._scan_time = taken_at
        frozen, self._ranges = np.array_equal(ranges, self._ranges) and not sees_nothing(scan), ranges
        return None if frozen else reading


class OtherScans:
    """The newest reading of each of a vehicle's further lidars."""

    def __init__(self, vehicle: str, lidars: Sequence[Lidar]) -> None:
        self._readers = {f"{vehicle}/{lidar.frame}": ScanReader(vehicle, lidar) for lidar in lidars}
        self._scans: dict[str, LaserScan] = {}
        self._newest: dict[str, Reading] = {}

    def hear(self, scans: Iterable[LaserScan], frames: FrameBuffer) -> None:
        """Takes what has come, and what has come before and was ahead of the frames."""
        self._scans |= {scan.frame_id: scan for scan in scans if scan.frame_id in self._readers}
        for frame, scan in self._scans.items():
            with suppress(FrameError):
                if (reading := self._readers[frame].read(scan, frames)) is not None:
                    self._newest[frame] = reading

    def about(self, t: float) -> tuple[Reading, ...]:
        """Those of about ``t`` [s]: of a lidar that is silent there is none."""
        return tuple(reading for reading in self._newest.values() if abs(reading.t - t) < TOGETHER)
