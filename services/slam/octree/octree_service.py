"""Depth pictures, lidar sweeps and frames -> a map in space, and what a ground vehicle needs of it."""

import re
from collections.abc import Callable
from contextlib import suppress
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import CameraCalibration, CompressedImage, Event, Grid, LaserScan, OctreeMap, OctreeSaveRequest, Reply
from services.slam.octree.beams import depth_beams, sweep_beams
from services.slam.octree.octree_messages import heights_of_columns, octree_from, octree_message, slice_message
from services.slam.waiting_beams import WaitingBeams
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.models.vehicle.sensors import Sensors
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, every, frames, optional, replies, request, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.sensors.fitted import sweeping_of
from uvf.sensors.sweeping import SweepSegment
from uvf.slam.octree.columns import columns_of
from uvf.slam.octree.files import to_bt
from uvf.slam.octree.leaves import TooLarge, leaves_of
from uvf.slam.octree.octree import Octree

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]
Height = Annotated[float, Meta(ge=-10000, le=10000)]

MESSAGE_MOST = 2_000_000  # bytes of the map's file in a message
COLUMNS_MOST = 1_000_000
MEMORY_MOST = 2_000_000_000  # bytes of the map
NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")


class OctreeParams(Params, frozen=True):
    """Parameters of the octree map."""

    resolution: Annotated[float, Meta(ge=0.01, le=10), key("m", "Side of a cell.")] = 0.1
    depth_reach: Annotated[Positive, key("m", "What a depth camera sees farther away counts as free space up to here.")] = 5.0
    lidar_reach: Annotated[Positive, key("m", "What a lidar sees farther away counts as free space up to here.")] = 30.0
    map_period: Annotated[Positive, key("s", "Time between publications.")] = 5.0
    slice_low: Annotated[Height, key("m", "Lower height of the slice that is published as an occupancy grid.")] = 0.05
    slice_high: Annotated[Height, key("m", "Upper height of that slice.")] = 0.5


class OctreeService(Service):
    """One octree map per vehicle, in the world frame: pictures and sweeps are inserted from their estimated sensor poses."""

    name = "octree"
    hz = 2.0

    class Inputs(Reads):
        """Depth pictures, scans, frames, and requests."""

        depth: list[CompressedImage] = optional(every(topics.DEPTH))
        info: CameraCalibration | None = optional(topics.CAMERA_INFO)
        scan: list[LaserScan] = optional(every(topics.SCAN))
        other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
        frames: FrameBuffer = frames()
        save: list[OctreeSaveRequest] = request(topics.SAVE_OCTREE)

    class Outputs(Writes):
        """Octree, slice and heights, events and replies."""

        map: OctreeMap | None = topic(topics.OCTREE)
        slice: Grid | None = topic(topics.SLICE)
        heights: Grid | None = topic(topics.HEIGHTS)
        events: list[Event] | None = topic(topics.EVENTS.by("octree"))
        save: list[Reply] = replies(topics.SAVE_OCTREE)

    class Recalls(Reads):
        """Latched map from which a restarted instance resumes."""

        map: OctreeMap | None = topic(topics.OCTREE)

    params: OctreeParams
    fixed_params = frozenset({"resolution"})

    def __init__(self, sensors: Sensors, keep: Callable[[str, bytes], str], params: OctreeParams) -> None:
        """keep: writes a file under a name and tells where; raises BadInput."""
        self.params = params
        self._sensors = sensors
        self._lidars = {lidar.frame: lidar for lidar in sensors.lidars}
        self._keep = keep
        self._octree = Octree(params.resolution)
        self._waiting = WaitingBeams()
        self._told: set[str] = set()
        self._changed = False
        self._published_at = float("-inf")

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: inserts what has a place by now, and publishes the map when it is due."""
        events = [*self._take(t, now.depth, now.info, [*now.scan, *now.other_scans]), *self._place(t, now.frames)]
        out = self.Outputs(events=events)
        if self._changed and t - self._published_at >= self.params.map_period - 1e-9:
            self._changed, self._published_at = False, t
            if self.params.slice_low > self.params.slice_high:
                events += self._tell(t, "the slice of the map is empty", "'slice_low' lies above 'slice_high'")
            try:
                self._draw(t, out)
            except TooLarge as error:
                events += self._tell(t, "the map is not published", f"{error}; set a larger 'resolution'")
        replies = [self._saved(request) for request in now.save]
        events += [self._event(t, Event.INFO, f"map written to {place}") for _, place in replies if place]
        out.save = [reply for reply, _ in replies]
        return out

    def recall(self, left: Recalls) -> None:
        """Resumes with the last map published, with the certainty that clamping allows."""
        if left.map is not None and left.map.resolution == self.params.resolution:
            with suppress(BadInput):  # it begins anew, as it would without a map
                self._octree = octree_from(left.map)
                self._changed = True

    def _take(self, t: float, depth: list[CompressedImage], info: CameraCalibration | None, scan: list[LaserScan]) -> list[Event]:
        """What has come joins those that wait for their place."""
        events: list[Event] = []
        if info is not None and (camera := self._sensors.camera) is not None:
            for picture in depth:
                try:
                    beams = depth_beams(picture, info, min(self.params.depth_reach, camera.far))
                except BadInput as error:
                    events += self._tell(t, "a depth picture is left out", str(error))
                else:
                    self._waiting.take([SweepSegment(seconds(picture.timestamp), slice(None))], picture.frame_id, beams)
        for sweep in scan:
            if (lidar := self._lidars.get(sweep.frame_id.rpartition("/")[2])) is not None:
                beams = sweep_beams(sweep, min(self.params.lidar_reach, lidar.range_max))
                self._waiting.take(sweeping_of(lidar).parts(len(sweep.ranges), seconds(sweep.timestamp)), sweep.frame_id, beams)
        return events

    def _place(self, t: float, frames: FrameBuffer) -> list[Event]:
        """Puts in what has a place by now; what has waited in vain is dropped."""
        if self._octree.memory > MEMORY_MOST:
            self._waiting.clear()
            full = f"it takes {MEMORY_MOST / 1e9:g} GB; set a larger 'resolution' or a shorter reach"
            return self._tell(t, "the map is full: nothing is put in any more", full)
        for origin, ends, reach in self._waiting.in_world(t, frames):
            self._octree.insert(origin, ends, reach)
            self._changed = True
        return self._tell(t, "pictures or scans cannot be mapped", self._waiting.lost) if self._waiting.lost else []

    def _draw(self, t: float, out: Outputs) -> None:
        """Raises TooLarge."""
        out.map = octree_message(self._octree, MESSAGE_MOST, t)
        columns = columns_of(self._octree, self.params.slice_low, self.params.slice_high, COLUMNS_MOST)
        if columns is not None:
            out.slice, out.heights = slice_message(columns, t), heights_of_columns(columns, t)

    def _saved(self, request: OctreeSaveRequest) -> tuple[Reply, str]:
        """The answer, and where the file is."""
        if not NAME.fullmatch(request.name):
            return Reply(accepted=False, reason=f"'{request.name}' is no name for a file: give letters, digits, - and _, 64 at most"), ""
        try:
            place = self._keep(request.name, to_bt(leaves_of(self._octree), self._octree.resolution))
        except (BadInput, TooLarge) as error:
            return Reply(accepted=False, reason=str(error)), ""
        return Reply(accepted=True), place

    def _tell(self, t: float, text: str, cause: str) -> list[Event]:
        """Each kind of trouble once."""
        if text in self._told:
            return []
        self._told.add(text)
        return [self._event(t, Event.WARNING, text, cause)]

    def _event(self, t: float, severity: Event.Severity, text: str, cause: str = "") -> Event:
        return Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source=self.name)
