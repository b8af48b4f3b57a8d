"""Map, pose and job -> what the tracker is to do, four times a second: a path to follow, or a recovery."""

from math import hypot, inf, isfinite, isinf, isnan

import numpy as np
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import (
    CameraCalibration,
    CancelRequest,
    CompressedImage,
    Contact,
    Event,
    Fence,
    GoalRequest,
    Grid,
    LaserScan,
    Mission,
    MissionProgress,
    Mode,
    ModeRequest,
    NavDirective,
    NavReport,
    NavStatus,
    PoseInFrame,
    PosesInFrame,
    PreviewReply,
    PreviewRequest,
    RallyPoints,
    Range,
    Reply,
    VehicleStatus,
)
from services.planner.directives import directive_message, path_message, report_of
from services.planner.exploration_goals import ExplorationGoals
from services.planner.goal_desk import GoalDesk
from services.planner.jobs import IDLE, Goal, Job, Orders, ReturnPoints, choose, home_of, mission_target, not_now
from services.planner.obstacle_sensors import OtherReadings
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planning_ground import PlanningGround
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.frontiers import FrontierWeights
from uvf.planning.global_planner import NO_PLACE, GlobalPlanner, PlannedBody
from uvf.planning.navigation.navigator import NavigationGoal, Navigator, NavigatorSettings, Status
from uvf.planning.navigation.progress import ProgressSettings
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, every, optional, replies, request, topic
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import stamp

Floats = NDArray[np.float64]
Point = tuple[float, float]

FRONTIER_VIEW = 0.4  # m from a frontier, from where it is seen well enough
EXPLORING_RECOVERIES = 2  # before another goal is chosen: there are more of them
AGAIN = 10.0  # s after which a place of the mission, or home, is tried again where nobody has changed the mode
PUSHED = 3.0  # times the tolerance from a place that was reached, from where it is driven to again
STATES = {
    Status.IDLE: NavStatus.IDLE,
    Status.FOLLOWING: NavStatus.DRIVING,
    Status.RECOVERING: NavStatus.RECOVERING,
    Status.REACHED: NavStatus.REACHED,
    Status.ABORTED: NavStatus.BLOCKED,
    Status.CANCELLED: NavStatus.CANCELLED,
}


class PlannerService(Service):
    """Global planner of one vehicle. It plans in the map frame and publishes in the world frame."""

    name = "planner"
    hz = 4.0
    given_up = "the vehicle stands where it would drive by itself"

    class Inputs(Reads):
        """Poses, map, all that sees or feels obstacles, the tracker's report, mission, and requests for goals."""

        pose: list[PoseInFrame] = every(topics.POSE)
        map: Grid = topic(topics.MAP)
        scan: LaserScan | None = optional(topics.SCAN)
        depth: list[CompressedImage] = optional(every(topics.DEPTH))
        info: CameraCalibration | None = optional(topics.CAMERA_INFO)
        sonar: list[Range] = optional(every(topics.SONAR))
        contact: list[Contact] = optional(every(topics.CONTACT))
        report: NavReport | None = optional(topics.NAV_REPORT)
        keep_out: Grid | None = optional(topics.KEEP_OUT)
        status: VehicleStatus | None = optional(topics.STATUS)
        mission: Mission | None = optional(topics.MISSION)
        progress: MissionProgress | None = optional(topics.PROGRESS)
        bounds: Fence | None = optional(topics.FENCE)
        rally: RallyPoints | None = optional(topics.RALLY)
        goal: list[GoalRequest] = request(topics.GOAL)
        cancel: list[CancelRequest] = request(topics.CANCEL)
        preview: list[PreviewRequest] = request(topics.PREVIEW)
        set_mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)

    class Outputs(Writes):
        """Directive and path, status, and replies."""

        directive: NavDirective | None = topic(topics.NAV_DIRECTIVE)
        path: PosesInFrame | None = topic(topics.PATH)
        nav_status: NavStatus | None = topic(topics.NAV_STATUS)
        events: list[Event] | None = topic(topics.EVENTS.by("planner"))
        goal: list[Reply] = replies(topics.GOAL)
        cancel: list[Reply] = replies(topics.CANCEL)
        preview: list[PreviewReply] = replies(topics.PREVIEW)
        set_mode: list[ModeRequest] = call(topics.SET_MODE)

    class Recalls(Reads):
        """Latched status from which a restarted instance resumes."""

        nav_status: NavStatus | None = topic(topics.NAV_STATUS)

    params: PlannerParams

    def __init__(self, world_from_map: Pose2, vehicle: PlannedVehicle, params: PlannerParams) -> None:
        self.params = params
        self._world_from_map = world_from_map
        self._vehicle, self._footprint = vehicle, vehicle.footprint
        self._planner = GlobalPlanner(self._body)
        self._ground = PlanningGround(self._planner, vehicle.sensors, world_from_map)
        self._navigator = Navigator(self._ground.routes, self._patience)
        self._exploration = ExplorationGoals(self._planner, self._taste)
        self._return_points = ReturnPoints()
        self._job: Job = IDLE
        self._goal: Goal | None = None
        self._target: Point | None = None
        self._reason = ""
        """Why there is nowhere to go."""
        self._ended_at: float | None = None
        """When a person's goal was reached or cancelled, as ``_ending`` says."""
        self._ending: NavStatus.State = NavStatus.REACHED
        self._try_at = inf
        """When a place that was given up is tried again."""
        self._told = 0
        self._asks: list[ModeRequest] = []
        self._events: list[Event] = []
        self._desk = GoalDesk(self._planner, world_from_map, vehicle.speed)

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: chooses the job and its place, plans, watches the progress, and recovers."""
        self._ground.move(now.pose)
        here, self._desk.bounds = self._ground.here, now.bounds
        if here is None:
            return self.stale(t, ("pose",))
        self._fit()
        self._ground.keep_out(now.keep_out)
        changed = self._ground.look(t, now.map, now.scan, OtherReadings(now.depth, now.info, now.sonar, now.contact))
        goal_replies = self._ask_all(t, here, now.goal, now.status)
        place = compose(self._world_from_map, here)[:2]
        home = home_of(now.status) or self._world_from_map[:2]
        return_point = self._return_points.step(now.status, place, home, now.rally)
        target = mission_target(now.mission, now.progress, home)
        job = choose(now.status, self._goal, target, Orders(return_point, self._vehicle.explores))
        if job != self._job:
            self._begin(t, job)
        cancel_replies = [self._cancel(t, request) for request in now.cancel]
        self._aim(t, here, changed)
        if now.status is None or now.status.command_source != "planner":
            self._navigator.pause(t, here)
        directive = self._navigator.step(t, here, report_of(now.report))
        self._ground.heed(directive)
        self._follow_up(t)
        self._tell_recoveries()
        events, self._events = self._events, []
        asks, self._asks = self._asks, []
        return self.Outputs(
            directive=directive_message(t, directive),
            path=path_message(t, directive, self._world_from_map),
            nav_status=self._nav_status(t),
            events=events,
            set_mode=asks,
            goal=goal_replies,
            cancel=cancel_replies,
            preview=self._desk.previews(here, now.preview),
        )

    def recall(self, left: Recalls) -> None:
        """Resumes a person's goal that was being driven to; its heading is not known any more."""
        if (
            left.nav_status is not None
            and left.nav_status.job == "goal"
            and left.nav_status.state not in (NavStatus.REACHED, NavStatus.CANCELLED)
        ):
            self._goal = Goal((left.nav_status.goal.x, left.nav_status.goal.y))

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Outputs at ``t`` [s, simulation] without a fresh pose or a map: the tracker is to stop."""
        reason = f"waiting for {', '.join(missing)}"
        return self.Outputs(
            directive=NavDirective(timestamp=stamp(t)),
            path=PosesInFrame(timestamp=stamp(t), frame_id="world"),
            nav_status=NavStatus(timestamp=stamp(t), state=NavStatus.IDLE, job=self._job.name, reason=reason),
        )

    @property
    def _body(self) -> PlannedBody:
        params = self.params
        inflation = Inflation(params.inflation_radius, params.cost_scaling_factor)
        offset = self._vehicle.sensors.placer.offset
        return PlannedBody(self._footprint.padded(params.margin), inflation, params.cost_travel_multiplier, offset)

    @property
    def _taste(self) -> FrontierWeights:
        return FrontierWeights(self.params.min_frontier_size, FRONTIER_VIEW, self.params.frontier_gain)

    @property
    def _patience(self) -> NavigatorSettings:
        progress = ProgressSettings(movement_time_allowance=self.params.patience)
        radius = self._footprint.circumscribed_radius
        return NavigatorSettings(replan_period=self.params.replan_period, circumscribed_radius=radius, progress=progress)

    def _fit(self) -> None:
        """Heeds the parameters."""
        self._exploration.explorer.taste = self._taste
        self._navigator.fit(self._patience)
        if self._planner.fit(self._body):
            self._navigator.replan()

    def _ask_all(self, t: float, here: Pose2, requests: list[GoalRequest], status: VehicleStatus | None) -> list[Reply]:
        """Of several goals in one step the last that can be driven to counts; only that one is told of."""
        replies = [self._ask(here, request, status) for request in requests]
        taken = [request for request, reply in zip(requests, replies, strict=True) if reply.accepted]
        if taken:
            last = taken[-1]
            self._goal = Goal((last.position.x, last.position.y), None if isnan(last.yaw) else last.yaw)
            self._job = IDLE  # asked for anew, the same place is a goal anew
            self._tell(t, f"goal ({last.position.x:.1f}, {last.position.y:.1f})", f"asked by {last.source or 'unknown'}")
        return replies

    def _ask(self, here: Pose2, wanted: GoalRequest, status: VehicleStatus | None) -> Reply:
        reason = not_now(status) or self._desk.refusal(here, wanted.position)
        if isinf(wanted.yaw):
            reason = "the heading is infinite; give it in rad, or NaN for any"
        return Reply(accepted=not reason, reason=reason)

    def _cancel(self, t: float, request: CancelRequest) -> Reply:
        """The vehicle stops; it stays as long as at a goal that was reached before its job goes on."""
        if self._goal is None or self._ended_at is not None:
            return Reply(accepted=False, reason="there is no goal to cancel")
        cause = f"asked by {request.source or 'unknown'}"
        self._tell(t, "goal cancelled", cause)
        if self._job.name == "goal":
            self._end(t, NavStatus.CANCELLED, f"goal cancelled, {cause}")
        else:
            self._goal = None
        return Reply(accepted=True)

    def _end(self, t: float, ending: NavStatus.State, reason: str) -> None:
        """A person's goal has come to its end; without a path the vehicle stands."""
        self._ended_at, self._ending, self._reason = t, ending, reason
        self._navigator.cancel(t)

    def _begin(self, t: float, job: Job) -> None:
        if job.name != self._job.name:
            self._tell(t, f"job: {job.name}", "")
        self._job, self._target, self._reason = job, None, ""
        self._exploration.begin()
        self._ended_at, self._try_at = None, inf

    def _aim(self, t: float, here: Pose2, changed: bool) -> None:
        """Where the job leads now."""
        if self._ended_at is not None:
            if t - self._ended_at >= self.params.wait_at_goal:
                self._goal = None
        elif self._job == IDLE:
            self._navigator.cancel(t)
            self._reason = "no job"
        elif self._job.target is None:
            if changed or self._target is None or not self._navigator.is_busy:
                self._aim_exploring(t, here)
        elif self._target is None or t >= self._try_at or self._is_pushed_away(here):
            self._try_at = inf
            self._go(t, self._desk.in_map(self._job.target), self.params.goal_tolerance)

    def _go(self, t: float, target: Point, tolerance: float) -> None:
        self._target, self._reason = target, ""
        if not (isfinite(target[0]) and isfinite(target[1])):
            self._navigator.cancel(t)
            self._reason = NO_PLACE
            return
        self._ground.routes.allow_unknown = self._job.allow_unknown
        yaw = None if self._job.yaw is None else wrap(self._job.yaw - self._world_from_map[2])
        most = EXPLORING_RECOVERIES if self._job.name == "explore" else NavigationGoal.most_recoveries
        self._navigator.start(t, NavigationGoal(*target, yaw, tolerance, most))

    def _is_pushed_away(self, here: Pose2) -> bool:
        """Whether the vehicle was where it should be, and is no longer."""
        if self._target is None or self._navigator.feedback.status != Status.REACHED:
            return False
        return hypot(here[0] - self._target[0], here[1] - self._target[1]) > PUSHED * self.params.goal_tolerance

    def _aim_exploring(self, t: float, here: Pose2) -> None:
        was_shut_in = self._exploration.is_shut_in
        target, reason = self._exploration.choose(t, here[:2])
        if self._exploration.is_shut_in and not was_shut_in:
            self._tell(t, "explore: nothing can be planned", reason, Event.WARNING)
        if target is None:
            self._navigator.cancel(t)
            self._target, self._reason = None, reason
        elif target != self._target or not self._navigator.is_busy:
            self._go(t, target, self.params.look_tolerance)

    def _follow_up(self, t: float) -> None:
        """What follows when the place is reached, or given up."""
        if self._target is None or self._ended_at is not None:
            return
        told = self._navigator.feedback
        if told.status == Status.REACHED and self._job.name == "goal":
            self._end(t, NavStatus.REACHED, "goal reached")
            self._tell(t, "goal reached", "")
        elif told.status == Status.ABORTED:
            self._give_up(t, told.reason)
        if self._job.name == "explore" and told.status in (Status.REACHED, Status.ABORTED):
            self._exploration.done(t)
            self._target = None

    def _give_up(self, t: float, reason: str) -> None:
        """A person's goal is over; neither a mission nor the way home may be left out, so there a person has to decide."""
        if self._job.allow_unknown and isinf(self._try_at):
            self._tell(t, f"{self._job.name}: holding", reason, Event.WARNING)
            self._asks.append(ModeRequest(mode=Mode.MODE_HOLD, source="planner"))
            self._try_at = t + AGAIN
        elif not self._job.allow_unknown:
            self._tell(t, f"{self._job.name}: goal given up", reason, Event.WARNING)
            self._goal = None

    def _tell_recoveries(self) -> None:
        log = self._navigator.log
        for at, text in log[self._told :]:
            self._tell(at, text, self._job.name)
        self._told = len(log)

    def _nav_status(self, t: float) -> NavStatus:
        told = self._navigator.feedback
        status = NavStatus(
            timestamp=stamp(t), job=self._job.name, reason=self._reason or told.reason, explored=self._exploration.explorer.explored
        )
        status.state, status.recoveries = self._state(told.status), told.recoveries
        if self._target is not None:
            x, y, _ = compose(self._world_from_map, Pose2(self._target[0], self._target[1], 0.0))
            status.goal.x, status.goal.y = x, y
        if isfinite(told.distance_remaining):
            status.distance_left = told.distance_remaining
        if isfinite(told.time_remaining):
            status.time_left = told.time_remaining
        return status

    def _state(self, status: Status) -> NavStatus.State:
        if self._ended_at is not None:
            return self._ending
        if self._target is None:
            return NavStatus.BLOCKED if self._exploration.is_shut_in else NavStatus.IDLE
        if self._reason:
            return NavStatus.BLOCKED
        return STATES[status]

    def _tell(self, t: float, text: str, cause: str, severity: Event.Severity = Event.NOTICE) -> None:
        self._events.append(Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source="planner"))
