"""What places the sweeps of a vehicle in a map, drawn or given: from messages to readings, and back to frames."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Event, FrameTransform, LaserScan, MapFix
from services.slam.scan_reader import OtherScans, ScanReader
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.maths.se3 import planar
from uvf.models.vehicle.sensors import Lidar
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import planar_frame, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.slam.correction import toward
from uvf.slam.placing_params import PlacingParams
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

PATIENCE = 2.0  # s without a scan that has a place, until this is told


class PlacingService(Service):
    """Base of the services that publish the odometry frame's place in the map, without jumps."""

    hz = 10.0
    given_up = "the vehicle stands where it would drive by itself"
    params: PlacingParams
    purpose: ClassVar[str]
    """What scans without a place cannot be: the end of a sentence."""

    def __init__(self, vehicle: str, lidars: Sequence[Lidar], world_from_map: Pose2) -> None:
        """lidars: the one whose scans set the pace, then the others, whose newest scans go along with them."""
        self._vehicle = vehicle
        self._scans, self._others = ScanReader(vehicle, lidars[0]), OtherScans(vehicle, lidars[1:])
        self._world_from_map = world_from_map
        self._map_from_odom = self._published = self._odom_from_base = IDENTITY
        self._placeless_since: float | None = None
        self._told = False

    def _reading(self, scan: LaserScan, others: Sequence[LaserScan], frames: FrameBuffer) -> Reading | None:
        """A new scan with those of the other lidars; None where it has been seen. Raises FrameError."""
        self._odom_from_base = planar(frames.lookup(self._frame("odom"), self._frame("base_footprint")))
        self._others.hear(others, frames)
        reading = self._scans.read(scan, frames)
        return None if reading is None else replace(reading, others=self._others.about(reading.t))

    def _wait(self, t: float, reason: str) -> list[Event]:
        """A scan may be ahead of the frames for a moment; when it lasts, a person has to know why there is no map."""
        if self._placeless_since is None:
            self._placeless_since = t
        if self._told or t - self._placeless_since < PATIENCE:
            return []
        self._told = True
        return [Event(timestamp=stamp(t), severity=Event.WARNING, text=f"scans cannot be {self.purpose}", cause=reason, source=self.name)]

    def _frame(self, name: str) -> str:
        return f"{self._vehicle}/{name}"

    def _correction(self, t: float) -> FrameTransform:
        """Limited at the vehicle, not at the frames' origins, which may lie far away."""
        period = 1.0 / self.hz
        now = compose(self._published, self._odom_from_base)
        wanted = compose(self._map_from_odom, self._odom_from_base)
        limited = toward(now, wanted, self.params.correction_speed * period, self.params.correction_turn * period)
        self._published = compose(limited, inverse(self._odom_from_base))
        return self._transform(t, "map", "odom", self._published)

    def _transform(self, t: float, parent: str, child: str, parent_from_child: Pose2) -> FrameTransform:
        return planar_frame(t, parent if parent == "world" else self._frame(parent), self._frame(child), parent_from_child)


def fix_message(t: float, map_from_base: Pose2, covariance: Floats, quality: float) -> MapFix:
    """Pose in the map [m, rad], its covariance (3, 3) [m^2, rad^2] and match quality [-] as a message stamped ``t`` [s]."""
    x, y, yaw = map_from_base
    return MapFix(timestamp=stamp(t), x=x, y=y, yaw=yaw, covariance=covariance.ravel().tolist(), quality=quality)
