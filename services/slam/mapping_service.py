"""Lidar scans and frames -> the map, and where the odometry frame lies in it."""

from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.convert import occupancy_cells, occupancy_grid, quaternion, scan_rays, seconds, stamp, yaw_of
from schemas.messages import Event, FrameTransform, Grid, LaserScan, Vector3
from services.slam.mapper import Mapper, Scan, toward
from uvf.maths.planar import IDENTITY, Pose2, compose, inverse
from uvf.maths.rotations import from_euler
from uvf.maths.transforms import Transform, from_above, planar
from uvf.runtime.frames import FrameBuffer, FrameError
from uvf.runtime.service import Outputs, Params, Service, frames
from uvf.runtime.vehicle_file import Lidar

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]

PATIENCE = 2.0  # s without a scan that has a place, until this is told
NO_RETURN_REACH = 0.9
"""Part of the lidar's range that a beam without a return counts as free."""


class MappingParams(Params, frozen=True):
    resolution: Annotated[float, Meta(ge=0.02, le=0.2)] = 0.05  # m
    insert_distance: Positive = 0.1  # m driven between scans that go into the map
    insert_turn: Positive = 0.1  # rad turned, the same
    map_period: Positive = 1.0  # s between publications of the map
    correction_speed: Positive = 0.1  # m/s, how fast the published correction follows the matched one
    correction_turn: Positive = 0.1  # rad/s


class MappingService(Service):
    """One map per vehicle, begun at the mission's start pose; ``correction`` is ``map_from_odom`` without jumps."""

    name = "mapping"
    hz = 10.0
    inputs = {"scan": topics.SCAN, "frames": frames()}
    outputs = {"correction": topics.TF_MAP, "placing": topics.TF_WORLD, "map": topics.MAP, "events": topics.EVENTS.by("mapping")}
    recalls = {"map": topics.MAP, "correction": topics.TF_MAP}
    params: MappingParams
    fixed_params = frozenset({"resolution"})

    def __init__(self, vehicle: str, lidar: Lidar, world_from_map: Pose2, params: MappingParams) -> None:
        self.params = params
        self._vehicle = vehicle
        self._lidar = lidar
        self._world_from_map = world_from_map
        self._mapper = Mapper(params.resolution, params.insert_distance, params.insert_turn)
        self._odom_from_base: Pose2 = IDENTITY
        self._published: Pose2 = IDENTITY
        self._scan_time = -1.0
        self._placeless_since: float | None = None
        self._told = False
        self._map_time = -np.inf
        self._changed = False
        self._placed = False

    def step(self, t: float, scan: LaserScan, frames: FrameBuffer) -> Outputs:
        self._mapper.insert_distance, self._mapper.insert_turn = self.params.insert_distance, self.params.insert_turn
        try:
            self._odom_from_base = planar(frames.lookup(self._frame("odom"), self._frame("base_footprint")))
            self._look(scan, frames)
            self._placeless_since = None
        except FrameError as error:
            return {"events": self._wait(t, str(error))}
        outputs: dict[str, FrameTransform | Grid] = {"correction": self._correction(t)}
        if not self._placed:
            outputs["placing"] = self._transform(t, "world", "map", self._world_from_map)
            self._placed = True
        if self._changed and t - self._map_time >= self.params.map_period - 1e-9:
            outputs["map"] = self._map(t)
            self._changed, self._map_time = False, t
        return outputs

    def _look(self, scan: LaserScan, frames: FrameBuffer) -> None:
        """Takes in a new scan from where the lidar has been when it was taken. Raises FrameError."""
        taken_at = seconds(scan.timestamp)
        if taken_at <= self._scan_time:
            return
        odom_from_base = planar(frames.lookup(self._frame("odom"), self._frame("base_footprint"), taken_at))
        base_from_lidar = frames.lookup(self._frame("base_footprint"), scan.frame_id)
        self._scan_time = taken_at
        self._changed |= self._mapper.add(odom_from_base, self._in_base(base_from_lidar, scan))

    def _wait(self, t: float, reason: str) -> list[Event]:
        """A scan may be ahead of the frames for a moment; when it lasts, a person has to know why there is no map."""
        if self._placeless_since is None:
            self._placeless_since = t
        if self._told or t - self._placeless_since < PATIENCE:
            return []
        self._told = True
        return [Event(timestamp=stamp(t), severity=Event.WARNING, text="scans cannot be mapped", cause=reason, source="mapping")]

    def _frame(self, name: str) -> str:
        return f"{self._vehicle}/{name}"

    def recall(self, map: Grid | None = None, correction: FrameTransform | None = None) -> None:
        """Goes on with the last map published; the next scan finds its place in it."""
        if map is None or correction is None or map.cell_size.x != self.params.resolution:
            return
        self._mapper.occupancy.restore(occupancy_cells(map), np.array((map.pose.position.x, map.pose.position.y)))
        shift = correction.translation
        self._published = self._mapper.map_from_odom = Pose2(shift.x, shift.y, yaw_of(correction.rotation))

    def _in_base(self, base_from_lidar: Transform, scan: LaserScan) -> Scan:
        """A range beyond the lidar's own is no return (REP-117): the map shall not grow to where nobody can see."""
        ranges, rays = scan_rays(scan)
        hit = (ranges > 0.0) & (ranges <= self._lidar.range_max)
        hits = from_above(base_from_lidar, rays[hit] * ranges[hit, None])
        open_ends = from_above(base_from_lidar, rays[~hit] * (NO_RETURN_REACH * self._lidar.range_max))
        x, y, _ = base_from_lidar.translation
        return Scan(hits, open_ends, (float(x), float(y)))

    def _correction(self, t: float) -> FrameTransform:
        """Limited at the vehicle, not at the frames' origins, which may lie far away."""
        period = 1.0 / self.hz
        now = compose(self._published, self._odom_from_base)
        wanted = compose(self._mapper.map_from_odom, self._odom_from_base)
        limited = toward(now, wanted, self.params.correction_speed * period, self.params.correction_turn * period)
        self._published = compose(limited, inverse(self._odom_from_base))
        return self._transform(t, "map", "odom", self._published)

    def _transform(self, t: float, parent: str, child: str, parent_from_child: Pose2) -> FrameTransform:
        x, y, heading = parent_from_child
        return FrameTransform(
            timestamp=stamp(t),
            parent_frame_id=parent if parent == "world" else f"{self._vehicle}/{parent}",
            child_frame_id=f"{self._vehicle}/{child}",
            translation=Vector3(x=x, y=y),
            rotation=quaternion(from_euler(0.0, 0.0, heading)),
        )

    def _map(self, t: float) -> Grid:
        occupancy = self._mapper.occupancy
        x, y = occupancy.origin
        return occupancy_grid(occupancy.cells(), occupancy.resolution, float(x), float(y), f"{self._vehicle}/map", t)
