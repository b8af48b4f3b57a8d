"""Directive, path, pose and the live scan -> velocity on ``cmd/planner``, ten times a second; never nearer to anything than allowed."""

from dataclasses import replace
from math import ceil, hypot, pi
from typing import Annotated, Literal

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import (
    CameraCalibration,
    CompressedImage,
    Contact,
    DriveCommand,
    Event,
    Grid,
    LaserScan,
    MovingObstacles,
    NavDirective,
    NavReport,
    NavStatus,
    Odometry,
    PoseInFrame,
    PosesInFrame,
    Range,
    Vector3,
)
from services.planner.directives import directive_of, report_message
from services.planner.masks import MaskReader
from services.planner.obstacle_sensors import ObstacleSensors, OtherReadings
from services.planner.team import Teammates
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import IDENTITY, Pose2, transform
from uvf.models.keys import key, plain
from uvf.models.params import Params
from uvf.models.vehicle.file import GroundBody
from uvf.planning.costmap.discs import coming, disc_points, unseen
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.local.controller import ControllerSettings, Drive, LocalController
from uvf.planning.local.goal_checker import GoalTolerances
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import Limits, LocalPlanner
from uvf.planning.local.planners import make_local_planner
from uvf.planning.local.window import WindowSettings
from uvf.planning.moving.tracks import MovingObjects
from uvf.planning.navigation.directive import Action, Directive
from uvf.planning.navigation.execution import Executor
from uvf.planning.smoothing import first_part
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, every, optional, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import cost_grid, pose2_of, seconds, stamp, wxyz, yaw_of
from uvf.runtime.messages.wheels import drive_command

Floats = NDArray[np.float64]
Positive = Annotated[float, Meta(gt=0)]

PERIOD = 0.1  # s
KEEP_OUT_REACH = 3.0  # m
TEAM_REACH = 3.0  # m
SCAN_MAX_AGE = 0.6  # s; without sight nothing moves
SIZE = 8.0  # m, side of the window in which obstacles are remembered
FARTHEST = 0.95 * SIZE / 2  # m
HORIZON, FARTHEST_HORIZON = 2.8, 7.0  # s that the local planner looks ahead; of a car, half a turn but no more than the longer one
REVERSE, SIDEWAYS = 0.5, 0.6  # of the speed forwards
LATERAL_ACCELERATION = 1.5  # m/s^2, beyond which wheels slide
COSTS_PERIOD = 0.5  # s between two costmaps that are told
EVENTS_EVERY = 10.0  # s between two events about what is ahead


class TrackerParams(Params, frozen=True):
    """Parameters of the path tracker."""

    local_planner: Annotated[
        Literal["mppi", "dwa", "trajectory_rollout", "regulated_pure_pursuit", "elastic_band", "vfh_plus", "pid"],
        plain("What chooses the velocity along the path."),
    ] = "mppi"
    speed: Annotated[Positive, key("m/s", "Speed on straight parts of the path.")] = 0.45
    turn_speed: Annotated[Positive, key("rad/s", "Turn rate on the spot.")] = 1.5
    deceleration: Annotated[Positive, key("m/s^2", "Deceleration that braking is planned with.")] = 0.5
    goal_tolerance: Annotated[Positive, key("m", "Distance at which the goal is reached.")] = 0.06
    margin: Annotated[Positive, key("m", "Distance kept from obstacles beyond the vehicle's outline.")] = 0.02


class TrackerService(Service):
    """Path tracker of one vehicle: the local controller under the planner's directives."""

    name = "tracker"
    hz = 1.0 / PERIOD
    given_up = "the vehicle stands where it would drive by itself"
    fixed_params = frozenset(("local_planner",))

    class Inputs(Reads):
        """Directive and path, poses, odometry, all that sees or feels obstacles, and masks drawn over the map."""

        directive: NavDirective = topic(topics.NAV_DIRECTIVE)
        path: PosesInFrame = topic(topics.PATH)
        pose: list[PoseInFrame] = every(topics.POSE)
        odometry: Odometry | None = optional(topics.ODOMETRY)
        scan: LaserScan = topic(topics.SCAN)
        other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
        depth: list[CompressedImage] = optional(every(topics.DEPTH))
        info: CameraCalibration | None = optional(topics.CAMERA_INFO)
        sonar: list[Range] = optional(every(topics.SONAR))
        contact: list[Contact] = optional(every(topics.CONTACT))
        range: list[Range] = optional(every(topics.RANGE))
        keep_out: Grid | None = optional(topics.KEEP_OUT)
        speed_map: Grid | None = optional(topics.SPEED_MAP)
        team: dict[str, PoseInFrame] = each_vehicle(optional(topics.POSE))
        team_nav: dict[str, NavStatus] = each_vehicle(optional(topics.NAV_STATUS))

    class Outputs(Writes):
        """Velocity command, report and events."""

        drive: DriveCommand | None = topic(topics.DRIVE.by("planner"))
        report: NavReport | None = topic(topics.NAV_REPORT)
        obstacles: MovingObstacles | None = topic(topics.OBSTACLES)
        costs: Grid | None = topic(topics.LOCAL_COSTS)
        events: list[Event] | None = topic(topics.EVENTS.by("tracker"))

    params: TrackerParams

    def __init__(self, name: str, vehicle: tuple[GroundBody, RobotFootprint], sensors: ObstacleSensors, params: TrackerParams) -> None:
        self.params = params
        body, footprint = vehicle
        self._team = Teammates(name, footprint.circumscribed_radius, IDENTITY)
        self._body, self._footprint = body, footprint
        self._sensors, self._placer = sensors, sensors.placer
        self._pose: Pose2 = IDENTITY
        self._velocity = Twist(0.0, 0.0)
        self._made_for = params, 1.0
        self._keep_out, self._speed_map = MaskReader(), MaskReader()
        self._executor = Executor(self._controller())
        self._told_at = self._complained_at = self._costs_told_at = -np.inf

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: what the directive says, slowed before obstacles that the scan shows."""
        for message in now.pose:
            self._pose = pose2_of(message.pose)
            self._placer.move(seconds(message.timestamp), self._pose, wxyz(message.pose.orientation))
        self._heed_params(self._share(now.speed_map))
        controller = self._executor.controller
        self._sensors.take(controller.age, OtherReadings(now.depth, now.info, now.sonar, now.contact, now.range), controller.hidden)
        if self._sensors.bump is not None:
            self._executor.draw_back(t, self._pose, self._sensors.bump)
        seen = [placed for scan in (now.scan, *now.other_scans) if (placed := self._placer.place(scan)) is not None]
        for placed in seen:
            self._sensors.see(placed)
            controller.see(placed.t, placed.pose, placed.eye, placed.points, placed.ranges, placed.lidar)
        if seen:
            if (mask := self._keep_out.take(now.keep_out)) is not None:
                controller.keep_out(mask.kept_out_near(self._pose[:2], KEEP_OUT_REACH))
            self._team.hear(now.team, now.team_nav, {})
            self._heed_team(controller, np.concatenate([transform(s.pose, s.points[s.ranges > 0.0]) for s in seen]))
        if t - self._placer.t > SCAN_MAX_AGE:
            return self.stale(t, ("scan",))
        if now.odometry is not None:
            moves, turns = now.odometry.linear_velocity, now.odometry.angular_velocity.z
            self._velocity = Twist(moves.x, turns, moves.y if self._body.drive.kinematics.goes_sideways else 0.0)
        self._velocity = self._executor.step(t, self._pose, self._velocity, _directive(now.directive, now.path))
        report = self._executor.report
        return self.Outputs(
            drive=drive_command(self._velocity, stamp(t)),
            report=report_message(t, report),
            obstacles=_moving(seen[0].t, controller.moving) if seen else None,
            costs=self._costs(t, controller),
            events=[*self._felt(t), *(self._obstacle(t) if report.how in (Drive.STOPPED, Drive.NO_VALID_CONTROL) else [])],
        )

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Zero velocity at ``t`` [s, simulation], without directive, path, pose or scan."""
        self._executor.controller.halt()
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t)))

    def _heed_team(self, controller: LocalController, shown: Floats) -> None:
        """Those that the lidar does not show (n, 2) [m, world] are obstacles; those that come nearer are stopped for in time."""
        team, here = self._team.present, self._pose[:2]
        controller.keep_out(disc_points(unseen(team, shown, here), here, TEAM_REACH))
        stops_within = 2.0 * PERIOD + hypot(self._velocity.linear, self._velocity.lateral) / self.params.deceleration
        controller.beware(disc_points(coming(team, self._team.velocities, stops_within), here, TEAM_REACH))

    def _share(self, grid: Grid | None) -> float:
        """Share [0..1] of the speed that is allowed where the vehicle is; nothing is said where nothing is drawn."""
        mask = self._speed_map.take(grid)
        percent = 0 if mask is None else int(mask.at(np.array((self._pose[:2],)))[0])
        return percent / 100.0 if 0 < percent < 100 else 1.0

    def _heed_params(self, share: float) -> None:
        """Takes other parameters, or another speed that is allowed, over without forgetting what was seen."""
        wanted = self.params, share
        if wanted == self._made_for:
            return
        self._made_for, old = wanted, self._executor.controller
        controller = self._controller()
        controller.layer, controller.hidden, controller.moving = old.layer, old.hidden, old.moving
        self._executor.controller = controller

    def _controller(self) -> LocalController:
        params, body = self.params, self._body
        speed, tightest = self._made_for[1] * min(params.speed, body.max_linear), body.drive.kinematics.turning_radius
        turn_rate = min(params.turn_speed, body.max_angular, *([speed / tightest] if tightest else []))
        limits = Limits(
            -REVERSE * speed,
            speed,
            turn_rate,
            body.max_linear_acceleration,
            body.max_angular_acceleration,
            LATERAL_ACCELERATION,
            turning_radius=tightest,
            side_speed=min(SIDEWAYS * speed, body.max_twist.lateral),
        )
        horizon = min(max(HORIZON, pi * tightest / speed), FARTHEST_HORIZON)
        settings = ControllerSettings(
            size=SIZE,
            obstacle_range=FARTHEST,
            inflation=Inflation(0.55, 4.0),
            margin=params.margin,
            stop_margin=params.margin / 2,
            window=WindowSettings(2.0 * speed * horizon + 2.0),
            period=PERIOD,
            delay=PERIOD / 2,
            reaction=2.0 * PERIOD,
            braking=params.deceleration,
            angular_braking=body.max_angular_acceleration,
            goal=GoalTolerances(params.goal_tolerance, 0.05),
            evasion=limits._replace(min_speed=-speed) if params.local_planner == "mppi" else None,
        )
        if params.local_planner == "mppi":
            steps = ceil(horizon / PERIOD)
            planner: LocalPlanner = Mppi(limits, self._footprint, MppiSettings(steps=steps, step=PERIOD, noise_memory=0.7))
        else:
            planner = make_local_planner(params.local_planner, limits, self._footprint)
        return LocalController(self._footprint, limits, planner, settings)

    def _costs(self, t: float, controller: LocalController) -> Grid | None:
        """For people to see."""
        if t - self._costs_told_at < COSTS_PERIOD:
            return None
        self._costs_told_at = t
        costs = controller.layer.costmap(self._footprint, controller.settings.inflation)
        return cost_grid(costs.values, costs.resolution, *costs.origin, "world", t)

    def _felt(self, t: float) -> list[Event]:
        """A touch, and what could not be read."""
        felt = self._sensors.bump
        bump = [_event(t, felt.text, felt.cause)] if felt is not None else []
        if not self._sensors.faults or t - self._complained_at < EVENTS_EVERY:
            return bump
        self._complained_at = t
        return [*bump, _event(t, "a depth picture is left out", self._sensors.faults[0], Event.WARNING)]

    def _obstacle(self, t: float) -> list[Event]:
        """What to tell; nothing while the last time is not long ago, for one obstacle blocks and frees the way often."""
        if t - self._told_at < EVENTS_EVERY:
            return []
        self._told_at = t
        return [_event(t, "obstacle ahead", "lidar")]


def _moving(t: float, found: MovingObjects) -> MovingObstacles:
    told = MovingObstacles(timestamp=stamp(t))
    for x, y, vx, vy, radius in found.moving().tolist():
        told.obstacles.add(position=Vector3(x=x, y=y), velocity=Vector3(x=vx, y=vy), radius=radius)
    return told


def _event(t: float, text: str, cause: str, severity: Event.Severity = Event.NOTICE) -> Event:
    return Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source="planner")


def _directive(message: NavDirective, path: PosesInFrame) -> Directive:
    """With the path where it is to be followed."""
    said = directive_of(message)
    if said.action != Action.FOLLOW:
        return said
    points = np.array([(p.position.x, p.position.y) for p in path.poses]).reshape(-1, 2)
    if said.until is None:
        return replace(said, path=points, heading=_final_heading(path))
    return replace(said, path=first_part(points, said.until))


def _final_heading(path: PosesInFrame) -> float | None:
    """rad, world; None when the last pose has no orientation."""
    if not path.poses or not path.poses[-1].HasField("orientation"):
        return None
    return yaw_of(path.poses[-1].orientation)
