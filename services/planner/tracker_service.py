"""Path, pose and the live scan -> velocity on ``cmd/planner``, 20 times a second; never nearer to anything than allowed."""

from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import DriveCommand, Event, LaserScan, PoseInFrame, PosesInFrame
from uvf.maths.se2 import IDENTITY, Pose2, PoseHistory, inverse, transform
from uvf.maths.se3 import Transform, from_above
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.models.vehicle.file import GroundBody
from uvf.planning.collision_check import safe_share
from uvf.planning.pure_pursuit import PathTracker, SpeedLimits
from uvf.runtime.contract.declaration import Reads, Writes, every, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import pose2_of, scan_rays, seconds, stamp, yaw_of
from uvf.sensors.sweeping import AT_ONCE, Sweeping

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]

HISTORY = 100  # poses kept, 2 s: a sweep may take one
SCAN_MAX_AGE = 0.6  # s; without sight nothing moves
NEAR = 1.2  # m, points farther away cannot be reached before the next scan
REACTION = 0.3  # s, from sight to the wheels
EVENTS_EVERY = 10.0  # s between two events about what is ahead


class TrackerParams(Params, frozen=True):
    """Parameters of the path tracker."""

    speed: Annotated[Positive, key("m/s", "Speed on straight parts of the path.")] = 0.45
    turn_speed: Annotated[Positive, key("rad/s", "Turn rate on the spot.")] = 1.5
    deceleration: Annotated[Positive, key("m/s^2", "Deceleration that braking is planned with.")] = 0.5
    goal_tolerance: Annotated[Positive, key("m", "Distance at which the goal is reached.")] = 0.06
    margin: Annotated[Positive, key("m", "Distance kept from obstacles beyond the vehicle's radius.")] = 0.02
    patience: Annotated[Positive, key("s", "Time blocked before the vehicle backs off.")] = 1.5
    back_off: Annotated[Positive, key("m/s", "Speed of backing off.")] = 0.1


class TrackerService(Service):
    """Path tracker of one vehicle."""

    name = "tracker"
    hz = 20.0
    given_up = "the vehicle stands where it would drive by itself"

    class Inputs(Reads):
        """Path, poses, and the lidar's scan."""

        path: PosesInFrame = topic(topics.PATH)
        pose: list[PoseInFrame] = every(topics.POSE)
        scan: LaserScan = topic(topics.SCAN)

    class Outputs(Writes):
        """Velocity command and events."""

        drive: DriveCommand | None = topic(topics.DRIVE.by("planner"))
        events: list[Event] | None = topic(topics.EVENTS.by("tracker"))

    params: TrackerParams

    def __init__(self, body: GroundBody, base_from_lidar: Transform, params: TrackerParams, sweeping: Sweeping = AT_ONCE) -> None:
        self.params = params
        self._body = body
        self._base_from_lidar = base_from_lidar
        self._sweeping = sweeping
        self._tracker = PathTracker(self._pace)
        self._history = PoseHistory(HISTORY)
        self._pose: Pose2 = IDENTITY
        self._scan_time = -np.inf
        self._seen: Floats = np.zeros((0, 2))
        """(n, 2) m, world frame: the last scan's points near the vehicle."""
        self._blocked_since: float | None = None
        self._told_at = -np.inf

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: the velocity along the path, slowed before obstacles that the scan shows."""
        for message in now.pose:
            self._pose = pose2_of(message.pose)
            self._history.add(seconds(message.timestamp), self._pose)
        self._look(now.scan)
        self._tracker.pace = self._pace
        if t - self._scan_time > SCAN_MAX_AGE:
            return self.stale(t, ("scan",))
        around = transform(inverse(self._pose), self._seen)
        room = float(np.hypot(*around.T).min(initial=np.inf)) - self._keep
        wanted = self._tracker.follow(self._pose, _points(now.path), _final_heading(now.path), room)
        velocity, events = self._made_safe(t, wanted, around)
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=velocity[0], angular=velocity[1]), events=events)

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Zero velocity at ``t`` [s, simulation], without path, pose or scan."""
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t)))

    @property
    def _keep(self) -> float:
        """m to keep from the vehicle's centre to everything."""
        return self._body.radius + self.params.margin

    @property
    def _pace(self) -> SpeedLimits:
        speeds = min(self.params.speed, self._body.max_linear), min(self.params.turn_speed, self._body.max_angular)
        return SpeedLimits(*speeds, self.params.deceleration, self.params.goal_tolerance)

    def _look(self, scan: LaserScan) -> None:
        """Keeps the points of a new scan where they were seen, so that they stay while the vehicle moves on."""
        taken_at = self._sweeping.end(seconds(scan.timestamp))
        if taken_at <= self._scan_time:
            return
        ranges, rays = scan_rays(scan)
        near, seen = (ranges > 0.0) & (ranges < NEAR), []
        for at, beams in self._sweeping.parts(len(scan.ranges), seconds(scan.timestamp)):
            if (world_from_base := self._history.at(at)) is None:
                return
            points = (rays[beams] * ranges[beams, None])[near[beams]]
            seen.append(transform(world_from_base, from_above(self._base_from_lidar, points)))
        self._scan_time, self._seen = taken_at, np.concatenate(seen)

    def _made_safe(self, t: float, wanted: tuple[float, float], around: Floats) -> tuple[tuple[float, float], list[Event]]:
        """The wanted velocity, slowed so that it ends before anything; backwards a little when that stays zero."""
        brake = (REACTION, self.params.deceleration)
        share = safe_share(around, wanted, self._keep, brake)
        if share > 0.0:
            self._blocked_since = None
            return (share * wanted[0], share * wanted[1]), []
        if self._blocked_since is None:
            self._blocked_since = t
            return (0.0, 0.0), self._obstacle(t)
        back = (-self.params.back_off, 0.0)
        if t - self._blocked_since > self.params.patience and safe_share(around, back, self._keep, brake) > 0.0:
            return back, []
        return (0.0, wanted[1]), []

    def _obstacle(self, t: float) -> list[Event]:
        """What to tell; nothing while the last time is not long ago, for one obstacle blocks and frees the way often."""
        if t - self._told_at < EVENTS_EVERY:
            return []
        self._told_at = t
        return [Event(timestamp=stamp(t), severity=Event.NOTICE, text="obstacle ahead", cause="lidar", source="planner")]


def _points(path: PosesInFrame) -> Floats:
    return np.array([(p.position.x, p.position.y) for p in path.poses]).reshape(-1, 2)


def _final_heading(path: PosesInFrame) -> float | None:
    """rad, world; None when the last pose has no orientation."""
    if not path.poses or not path.poses[-1].HasField("orientation"):
        return None
    return yaw_of(path.poses[-1].orientation)
