"""Lidar scans and frames -> the map, and where the odometry frame lies in it."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import Event, FrameTransform, Grid, LaserScan, MapFix, MappingRequest, MapSession, Odometry, Reply
from services.slam.odometry.messages import rate_sigmas
from services.slam.placing_service import PlacingService, fix_message
from services.slam.warm_up import warm_up
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.keys import key, plain
from uvf.models.vehicle.sensors import Lidar
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, every, frames, optional, replies, request, topic
from uvf.runtime.messages.convert import occupancy_grid, pose2_of_frame, stamp
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.slam.maps.session import MappingSession
from uvf.slam.maps.tiles import TileMap
from uvf.slam.method import Keyframe, SlamMethod
from uvf.slam.placing_params import PlacingParams, Positive
from uvf.slam.pose_graph.uncertainty import turned
from uvf.slam.reading import Reading
from uvf.slam.resumable import Noting, Resumable

Floats = NDArray[np.float64]

LEAP, LEAP_TURN = 0.3, 0.1  # m, rad: a correction that moves the vehicle by more is told


class MappingParams(PlacingParams, frozen=True):
    """Parameters of mapping."""

    method: Annotated[str, plain("SLAM method: `graph`, `rbpf`, `hector` or `odometry`.")] = "graph"
    resolution: Annotated[float, Meta(ge=0.02, le=0.2), key("m", "Cell size of the published map.")] = 0.05
    map_period: Annotated[Positive, key("s", "Time between publications of the map.")] = 1.0
    session_period: Annotated[Positive, key("s", "Time between publications of the session.")] = 10.0


MakeMethod = Callable[[str], SlamMethod]
_POOL = ThreadPoolExecutor(1, "slam-method")


class MappingService(PlacingService):
    """One map per vehicle, begun at the mission's start pose; ``correction`` is ``map_from_odom`` without jumps, ``fix`` is raw."""

    name = "mapping"
    purpose = "mapped"

    class Inputs(Reads):
        """Scans, frames, and how sure the odometry is."""

        scan: LaserScan = topic(topics.SCAN)
        other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
        frames: FrameBuffer = frames()
        odometry: Odometry | None = optional(topics.ODOMETRY)
        mapping: list[MappingRequest] = request(topics.MAPPING)

    class Outputs(Writes):
        """Frames, map, pose in the map, session and events."""

        correction: FrameTransform | None = topic(topics.TF_MAP)
        placing: FrameTransform | None = topic(topics.TF_WORLD)
        map: Grid | None = topic(topics.MAP)
        fix: MapFix | None = topic(topics.MAP_POSE)
        session: MapSession | None = topic(topics.MAP_SESSION)
        events: list[Event] | None = topic(topics.EVENTS.by("mapping"))
        mapping: list[Reply] = replies(topics.MAPPING)

    class Recalls(Reads):
        """Latched messages from which a restarted instance resumes."""

        session: MapSession | None = topic(topics.MAP_SESSION)
        correction: FrameTransform | None = topic(topics.TF_MAP)

    params: MappingParams
    fixed_params = frozenset({"resolution", "method"})

    def __init__(
        self,
        vehicle: str,
        lidars: Sequence[Lidar],
        world_from_map: Pose2,
        params: MappingParams,
        make: MakeMethod,
        left: MappingSession | None = None,
    ) -> None:
        """make: makes a method by its name; left: a session to go on with, in the vehicle's map frame."""
        self.params = params
        super().__init__(vehicle, lidars, world_from_map)
        self._make = make
        self._method = make(params.method)
        self._next: tuple[str, Future[SlamMethod]] | None = None
        """The method that is to begin another map, as soon as it is made."""
        self._held = False
        self._map = TileMap(params.resolution)
        self._map_from_first = IDENTITY
        self._begun_elsewhere = left is not None
        self._left = left
        self._placed = False
        self._map_time = self._session_time = -np.inf
        self._drawn = self._kept = self._noted = 0
        self._undrawn = False

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: adds a new scan to the map, and publishes the odometry frame in it."""
        out = self.Outputs(mapping=[self._asked(request) for request in now.mapping])
        events = self._begin_another(t)
        try:
            if (reading := self._reading(now.scan, now.other_scans, now.frames)) is not None:
                if now.odometry is not None:
                    reading = replace(reading, rate_sigmas=rate_sigmas(now.odometry))
                out.fix, told = (None, []) if self._held else self._look(t, reading)
                events += told
            self._placeless_since = None
        except FrameError as error:
            out.events = events + self._wait(t, str(error))
            return out
        out.correction = self._correction(t)
        if not self._placed:
            out.placing = self._transform(t, "world", "map", self._world_from_map)
            self._placed = True
        try:
            out.map = self._grid(t)
        except BadInput as error:
            events += self._cannot_draw(t, str(error))
        out.session, out.events = self._session(t), events + self._notes(t)
        return out

    def _asked(self, request: MappingRequest) -> Reply:
        if request.action == MappingRequest.BEGIN:
            name = request.method or self.params.method
            try:
                self._make(name)
            except BadInput as error:
                return Reply(reason=str(error))
            self._next = name, _POOL.submit(self._made, name)
        elif request.action not in (MappingRequest.HOLD, MappingRequest.GO_ON):
            return Reply(reason=f"there is no action {request.action}")
        self._held = request.action == MappingRequest.HOLD
        return Reply(accepted=True)

    def _made(self, name: str) -> SlamMethod:
        warm_up(self._make(name))
        return self._make(name)

    def _begin_another(self, t: float) -> list[Event]:
        """With the method that was asked for, where the vehicle is: its code may have to be compiled first, in another thread."""
        if self._next is None or not self._next[1].done():
            return []
        (name, made), self._next = self._next, None
        self._method, self._map = made.result(), TileMap(self.params.resolution)
        self.params = msgspec.structs.replace(self.params, method=name)
        self._left, self._begun_elsewhere, self._undrawn = None, True, False
        self._map_from_first = IDENTITY
        self._map_time = self._session_time = -np.inf
        self._drawn = self._kept = self._noted = 0
        return [
            Event(timestamp=stamp(t), severity=Event.NOTICE, text="another map is begun", cause=f"with method {name}", source="mapping")
        ]

    def recall(self, left: Recalls) -> None:
        """Resumes at the last pose, with the session published last if the method can; otherwise it begins a new map there."""
        if left.correction is None:
            return
        self._published = self._map_from_odom = pose2_of_frame(left.correction)
        self._begun_elsewhere = True
        if left.session is not None and isinstance(self._method, Resumable):
            with suppress(BadInput):
                self._left = MappingSession.decoded(left.session.data, "on the bus")

    def _look(self, t: float, reading: Reading) -> tuple[MapFix, list[Event]]:
        guess = compose(self._map_from_odom, reading.odom_from_base)
        if self._begun_elsewhere:
            self._begin(guess)
        estimate = self._method.add(reading)
        map_from_base = compose(self._map_from_first, estimate.map_from_base)
        self._map_from_odom = compose(map_from_base, inverse(reading.odom_from_base))
        moved = compose(inverse(guess), map_from_base)
        distance = float(np.hypot(moved[0], moved[1]))
        turn = turned(self._map_from_first.yaw)
        fix = fix_message(reading.t, map_from_base, turn @ estimate.covariance @ turn.T, estimate.quality)
        if distance <= LEAP and abs(moved[2]) <= LEAP_TURN:
            return fix, []
        cause = f"a place seen again moved the vehicle by {distance:.2f} m and {np.degrees(moved[2]):.1f} deg"
        event = Event(timestamp=stamp(t), severity=Event.INFO, text="map corrected", cause=cause, source="mapping")
        return fix, [event]

    def _begin(self, map_from_base: Pose2) -> None:
        """After a restart, with the first reading."""
        self._begun_elsewhere = False
        if self._left is not None and isinstance(self._method, Resumable):
            self._method.resume(self._left, map_from_base)
            self._left = None
        else:
            self._map_from_first = map_from_base

    def _keyframes_in_map(self) -> Iterator[Keyframe]:
        for keyframe in self._method.keyframes():
            yield Keyframe(compose(self._map_from_first, keyframe.map_from_base), keyframe.reading)

    def _grid(self, t: float) -> Grid | None:
        """Now and then, when there is a keyframe more."""
        count = self._method.keyframe_count()
        if count == self._drawn or t - self._map_time < self.params.map_period - 1e-9:
            return None
        self._map_time, self._drawn = t, count
        self._map.follow(self._keyframes_in_map())
        cells, (x, y) = self._map.cells()
        return occupancy_grid(cells, self._map.resolution, float(x), float(y), f"{self._vehicle}/map", t)

    def _cannot_draw(self, t: float, cause: str) -> list[Event]:
        """Told once; poses and session go on."""
        if self._undrawn:
            return []
        self._undrawn = True
        return [Event(timestamp=stamp(t), severity=Event.ERROR, text="the map cannot be drawn", cause=cause, source="mapping")]

    def _notes(self, t: float) -> list[Event]:
        """What the method tells of its limits, each once."""
        new = self._method.notes[self._noted :] if isinstance(self._method, Noting) else []
        self._noted += len(new)
        return [Event(timestamp=stamp(t), severity=Event.WARNING, text="mapping is limited", cause=note, source="mapping") for note in new]

    def _session(self, t: float) -> MapSession | None:
        """The same of what another could go on with."""
        count = self._method.keyframe_count()
        if count == self._kept or t - self._session_time < self.params.session_period - 1e-9:
            return None
        if not isinstance(self._method, Resumable):
            return None
        self._session_time, self._kept = t, count
        return MapSession(timestamp=stamp(t), data=self._method.session().encoded("on the bus"))
