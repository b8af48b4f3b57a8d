"""Lidar scans, frames and a known map -> where the odometry frame lies in it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np

from schemas import topics
from schemas.messages import Event, FrameTransform, Grid, LaserScan, MapFix, PlaceRequest, PosesInFrame, RelocalizeRequest, Reply
from services.slam.placing_service import PlacingService, fix_message
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.vehicle.sensors import Lidar
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, every, frames, optional, replies, request, topic
from uvf.runtime.messages.convert import planar_pose, pose2_of, pose2_of_frame, stamp
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.runtime.messages.maps.grids import as_map, as_message
from uvf.slam.localization.known_map import KnownMap, of_grid
from uvf.slam.localization.localizer import HALF_SURE, Localizer, LocalizerState
from uvf.slam.localization.params import FilterParams
from uvf.slam.reading import Reading

POSITION_SIGMA, YAW_SIGMA = 0.3, 0.2  # m, rad, of a pose that is set without
PARTICLES_TOLD = 150
LEAST_SIGMA, MOST_SIGMA = 1e-4, 1000.0
"""m and rad: what is surer, or less sure than a whole map, is a mistake."""


@dataclass(frozen=True)
class LocalizationStart:
    """How localization begins. known: the map, in the map frame; None: it comes on map/known. anywhere: the vehicle's pose is unknown."""

    known: KnownMap | None
    anywhere: bool
    seed: int


class LocalizationService(PlacingService):
    """Takes the place of mapping where a map is given; its outputs are those of mapping, with the map as given."""

    name = "localization"
    purpose = "placed in the map"

    class Inputs(Reads):
        """Scans, frames, a known map, and requests."""

        scan: LaserScan = topic(topics.SCAN)
        other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
        frames: FrameBuffer = frames()
        known: Grid | None = optional(topics.KNOWN_MAP)
        pose: list[PlaceRequest] = request(topics.PLACE)
        relocalize: list[RelocalizeRequest] = request(topics.RELOCALIZE)

    class Outputs(Writes):
        """Frames, map, pose in the map, events and replies."""

        correction: FrameTransform | None = topic(topics.TF_MAP)
        placing: FrameTransform | None = topic(topics.TF_WORLD)
        map: Grid | None = topic(topics.MAP)
        fix: MapFix | None = topic(topics.MAP_POSE)
        particles: PosesInFrame | None = topic(topics.PARTICLES)
        events: list[Event] | None = topic(topics.EVENTS.by("localization"))
        pose: list[Reply] = replies(topics.PLACE)
        relocalize: list[Reply] = replies(topics.RELOCALIZE)

    class Recalls(Reads):
        """Latched messages from which a restarted instance resumes."""

        correction: FrameTransform | None = topic(topics.TF_MAP)
        fix: MapFix | None = topic(topics.MAP_POSE)

    params: FilterParams
    fixed_params = frozenset({"least_particles", "most_particles"})

    def __init__(
        self, vehicle: str, lidars: Sequence[Lidar], world_from_map: Pose2, params: FilterParams, beginning: LocalizationStart
    ) -> None:
        super().__init__(vehicle, lidars, world_from_map)
        self.params = params
        self._beginning = beginning
        self._localizer: Localizer | None = None
        self._start: Pose2 | None = None if beginning.anywhere else IDENTITY
        self._is_doubtful = False
        self._set_to: tuple[Pose2, float, float] | None = None
        self._map_told = False
        self._refused: Grid | None = None

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: localizes a new scan in the map, and publishes the odometry frame in it."""
        events = self._take_map(t, now.known)
        out = self.Outputs(
            pose=[self._placed(request) for request in now.pose],
            relocalize=[self._looked_for() for _ in now.relocalize],
            events=events,
        )
        try:
            reading = self._reading(now.scan, now.other_scans, now.frames)
            if self._localizer is not None and reading is not None:
                out.fix, told = self._look(t, self._localizer, reading)
                out.particles = self._particles(t, self._localizer)
                events += told
            self._placeless_since = None if self._localizer is not None else self._placeless_since
        except FrameError as error:
            events += self._wait(t, str(error))
            return out
        if self._localizer is None:
            events += self._wait(t, "there is no map on map/known, and the mission gives none under 'maps:'")
            return out
        out.correction = self._correction(t)
        if not self._map_told:
            self._map_told = True
            out.placing = self._transform(t, "world", "map", self._world_from_map)
            out.map = as_message(self._localizer.known.grid, self._frame("map"), t)
        return out

    def recall(self, left: Recalls) -> None:
        """Resumes at the last estimated pose, with the certainty it had."""
        if left.correction is not None:
            self._published = self._map_from_odom = self._start = pose2_of_frame(left.correction)
            self._is_doubtful = left.fix is not None and not left.fix.quality > HALF_SURE

    def _take_map(self, t: float, known: Grid | None) -> list[Event]:
        """The one of the mission, or the first on map/known that can be used; one that cannot is told of once."""
        if self._localizer is not None or (known is not None and known is self._refused):
            return []
        try:
            given = self._beginning.known
            if given is None and known is not None:
                given = of_grid(as_map(known), inverse(self._world_from_map), "map/known")
        except BadInput as error:
            self._refused = known
            return [self._event(t, Event.ERROR, "the map given is of no use", str(error))]
        if given is not None:
            self._localizer = Localizer(given, self.params, self._beginning.seed)
        return []

    def _look(self, t: float, localizer: Localizer, reading: Reading) -> tuple[MapFix, list[Event]]:
        if self._start is not None:
            begin = localizer.doubt if self._is_doubtful else localizer.set_pose
            begin(compose(self._start, reading.odom_from_base))
            self._start = None
        if self._set_to is not None:
            pose, position, yaw = self._set_to
            localizer.set_pose(pose, np.diag((position, position, yaw)) ** 2)
            self._set_to = None
        localizer.params = self.params
        before, jumps = localizer.state, localizer.is_fresh
        estimate = localizer.add(reading)
        self._map_from_odom = compose(estimate.map_from_base, inverse(reading.odom_from_base))
        if jumps or (before is not LocalizerState.TRACKING and localizer.state is LocalizerState.TRACKING):
            self._published = self._map_from_odom
        fix = fix_message(reading.t, estimate.map_from_base, estimate.covariance, estimate.quality)
        return fix, self._changed(t, before, localizer)

    def _particles(self, t: float, localizer: Localizer) -> PosesInFrame:
        """As many as a picture needs, evenly taken by weight (low variance: Thrun et al. 2005, table 4.4)."""
        poses, weights = localizer.filter.poses, localizer.filter.weights
        places = np.searchsorted(np.cumsum(weights), (np.arange(PARTICLES_TOLD) + 0.5) / PARTICLES_TOLD * weights.sum())
        taken = poses[np.minimum(places, len(poses) - 1)].tolist()
        return PosesInFrame(timestamp=stamp(t), frame_id=self._frame("map"), poses=[planar_pose(*pose) for pose in taken])

    def _changed(self, t: float, before: LocalizerState, localizer: Localizer) -> list[Event]:
        if localizer.state is before:
            return []
        if localizer.state is LocalizerState.TRACKING:
            x, y, yaw = compose(self._world_from_map, localizer.pose)
            where = f"at ({x:.2f}, {y:.2f}), {np.degrees(yaw):.0f} deg in the world"
            return [self._event(t, Event.INFO, "the vehicle is localized", where)]
        cause = f"scans fit the map to {100 * localizer.fit.share:.0f} % of what is usual; it is looked for in the whole map"
        return [self._event(t, Event.WARNING, "the vehicle is not where it was believed to be", cause)]

    def _placed(self, request: PlaceRequest) -> Reply:
        if self._localizer is None:
            return Reply(reason="there is no map yet")
        wanted = pose2_of(request.pose)
        sigmas = (request.position_sigma or POSITION_SIGMA, request.yaw_sigma or YAW_SIGMA)
        if not all(isfinite(v) for v in wanted) or not all(LEAST_SIGMA <= sigma <= MOST_SIGMA for sigma in sigmas):
            return Reply(reason=f"a pose of finite numbers is needed, with sigmas from {LEAST_SIGMA:g} to {MOST_SIGMA:g} m and rad")
        pose = compose(inverse(self._world_from_map), wanted)
        if not self._localizer.known.covers(pose):
            return Reply(reason=f"({wanted.x:.2f}, {wanted.y:.2f}) is outside the map")
        self._set_to, self._start = (pose, *sigmas), None
        return Reply(accepted=True)

    def _looked_for(self) -> Reply:
        if self._localizer is None:
            return Reply(reason="there is no map yet")
        self._start = self._set_to = None
        self._localizer.relocalize()
        return Reply(accepted=True)

    def _event(self, t: float, severity: Event.Severity, text: str, cause: str) -> Event:
        return Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source=self.name)
