"""Lidar sweeps and frames of an aircraft -> heights of the ground below it, for itself and for those who drive there."""

from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from schemas import topics
from schemas.messages import Event, Grid, LaserScan, MapReply, MapRequest, NavStatus, PoseInFrame
from services.slam.waiting_beams import RayBundle, WaitingBeams
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.models.vehicle.sensors import Lidar
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, every, frames, optional, replies, request, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import scan_rays, seconds, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.maps.height_grids import heights_message, heights_of
from uvf.sensors.fitted import sweeping_of
from uvf.slam.elevation.elevation_map import Elevation, ElevationMap, MapFull
from uvf.slam.elevation.strip_adjustment import StripAdjustment

Floats = NDArray[np.float64]

LAYER = "heights"
LARGEST = 2.5  # m, of the radius that a vehicle may say it has
PASS = 5.0  # s, after which what is drawn is of an earlier pass
ABOUT = 0.6  # m about who drives, as far as it may have moved since it told where it is


class ElevationParams(Params, frozen=True):
    """Parameters of the elevation map."""

    resolution: Annotated[float, Meta(ge=0.05, le=10), key("m", "Side of a column.")] = 0.25
    gate: Annotated[float, Meta(gt=0, le=10), key("m", "Difference in height from which on a point belongs to another surface.")] = 0.25
    map_period: Annotated[float, Meta(gt=0), key("s", "Time between publications.")] = 10.0


class ElevationService(Service):
    """One elevation map per aircraft, in the world frame: sweeps are inserted from their estimated sensor poses."""

    name = "elevation"
    hz = 5.0

    class Inputs(Reads):
        """Scans, frames, who drives below, and requests."""

        scan: list[LaserScan] = optional(every(topics.SCAN))
        team: dict[str, PoseInFrame] = each_vehicle(topics.POSE)
        team_nav: dict[str, NavStatus] = each_vehicle(topics.NAV_STATUS)
        frames: FrameBuffer = frames()
        get: list[MapRequest] = request(topics.GET_MAP)

    class Outputs(Writes):
        """Heights, events and replies."""

        heights: Grid | None = topic(topics.HEIGHTS)
        events: list[Event] | None = topic(topics.EVENTS.by("elevation"))
        get: list[MapReply] = replies(topics.GET_MAP)

    class Recalls(Reads):
        """Latched map from which a restarted instance resumes."""

        heights: Grid | None = topic(topics.HEIGHTS)

    params: ElevationParams
    fixed_params = frozenset({"resolution", "gate"})

    def __init__(self, lidar: Lidar, params: ElevationParams) -> None:
        self.params = params
        self._lidar = lidar
        self._map = ElevationMap(params.resolution, params.gate)
        self._strips = StripAdjustment()
        self._waiting = WaitingBeams()
        self._changed = False
        self._published_at = float("-inf")
        self._told: set[str] = set()

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: inserts what has a place by now, publishes the map when it is due, and answers requests."""
        for sweep in now.scan:
            ranges, rays = scan_rays(sweep)
            ends = np.column_stack((rays * ranges[:, None], np.zeros(len(rays))))
            ends[(ranges < self._lidar.range_min) | (ranges > self._lidar.range_max)] = np.nan
            bundle = RayBundle(ends, self._lidar.range_max)
            self._waiting.take(sweeping_of(self._lidar).parts(len(sweep.ranges), seconds(sweep.timestamp)), sweep.frame_id, bundle)
        out = self.Outputs(events=self._insert(t, now.frames, _drivers(now)))
        if self._changed and t - self._published_at >= self.params.map_period - 1e-9:
            self._changed, self._published_at = False, t
            elevation = self._map.elevation()
            out.heights = None if elevation is None else _message(elevation, t)
        out.get = [self._found(t, request) for request in now.get]
        return out

    def recall(self, left: Recalls) -> None:
        """Resumes with the last map published; it begins anew where that is none."""
        if left.heights is None or left.heights.cell_size.x != self.params.resolution:
            return
        try:
            top, ground = heights_of(left.heights)
            corner = left.heights.pose.position
            self._map.resume(Elevation(top, ground, self.params.resolution, corner.x, corner.y))
        except (BadInput, MapFull):
            self._map = ElevationMap(self.params.resolution, self.params.gate)

    def _insert(self, t: float, frames: FrameBuffer, drivers: Floats) -> list[Event]:
        """drivers: (n, 3) x, y, radius [m, world] of what is no ground, for it drives there."""
        try:
            placed = list(self._waiting.in_world(t, frames))
            sweeps = [each.ends[~(cdist(each.ends[:, :2], drivers[:, :2]) < drivers[:, 2]).any(axis=1)] for each in placed]
            drawn = [self._map.surface(sweep, t - PASS) for sweep in sweeps]
            raises = self._strips.raises(t, [each.origin for each in placed], sweeps, drawn)
            for sweep, raised in zip(sweeps, raises, strict=True):
                self._map.insert(sweep, t, raised)
                self._changed = True
        except MapFull as error:
            self._waiting.clear()
            return self._tell(t, "the map of heights is full: it does not grow any more", f"{error}; set a larger 'resolution'")
        return self._tell(t, "scans cannot be mapped", self._waiting.lost) if self._waiting.lost else []

    def _found(self, t: float, request: MapRequest) -> MapReply:
        layer, area = request.layer or LAYER, tuple(request.area)
        if layer != LAYER:
            return MapReply(reason=f"no layer '{layer}'; {nearest(layer, [LAYER])}")
        if len(area) not in (0, 4):
            return MapReply(reason=f"an area of {len(area)} numbers; give x_min, y_min, x_max, y_max, or none")
        elevation = self._map.elevation()
        if elevation is not None and len(area) == 4:
            elevation = elevation.within(area)
        if elevation is None:
            return MapReply(reason="nothing is mapped there yet: fly over it, no higher than the lidar reaches")
        return MapReply(accepted=True, grid=_message(elevation, t))

    def _tell(self, t: float, text: str, cause: str) -> list[Event]:
        """Each kind of trouble once."""
        if text in self._told:
            return []
        self._told.add(text)
        return [Event(timestamp=stamp(t), severity=Event.WARNING, text=text, cause=cause, source=self.name)]


def _drivers(now: ElevationService.Inputs) -> Floats:
    """Ground vehicles (n, 3): x, y, and how far about them [m, world] scans show them; they alone have a planner."""
    found = [
        (now.team[name].pose.position.x, now.team[name].pose.position.y, min(max(said.radius, 0.0), LARGEST) + ABOUT)
        for name, said in sorted(now.team_nav.items())
        if name in now.team
    ]
    return np.array(found, dtype=np.float64).reshape(-1, 3)


def _message(elevation: Elevation, t: float) -> Grid:
    return heights_message(elevation.top, elevation.ground, elevation.resolution, (elevation.x, elevation.y), t)
