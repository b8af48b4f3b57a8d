"""Map, pose and job -> the path to drive, four times a second; plans anew only when the map or the job has changed."""

from math import hypot, inf, isinf, isnan
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from schemas import topics
from schemas.messages import (
    CancelRequest,
    Event,
    Fence,
    GoalRequest,
    Grid,
    Mission,
    MissionProgress,
    Mode,
    ModeRequest,
    NavStatus,
    Pose,
    PoseInFrame,
    PosesInFrame,
    RallyPoints,
    Reply,
    Vector3,
    VehicleStatus,
)
from services.planner.jobs import IDLE, Goal, Job, Orders, ReturnPoints, choose, home_of, mission_target, not_now
from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse, transform
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.exploration import Explorer, Patrol
from uvf.planning.frontiers import FrontierWeights
from uvf.planning.global_planner import GlobalPlanner, PlannedBody, PlannedPath
from uvf.planning.smoothing import length
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, optional, replies, request, topic
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import occupancy_cells, planar_pose, pose2_of, seconds, stamp
from uvf.runtime.messages.fences import fencing

Floats = NDArray[np.float64]
Point = tuple[float, float]
Positive = Annotated[float, Meta(gt=0)]

REPLAN_PERIOD = 2.0  # s, after which a path that failed is tried again
FRONTIER_VIEW = 0.4  # m from a frontier, from where it is seen well enough
TRIES = 3  # at a place of the mission or the way home, before the vehicle holds


class PlannerParams(Params, frozen=True):
    """Parameters of the planner."""

    margin: Annotated[Positive, key("m", "Distance kept from obstacles beyond the vehicle's radius.")] = 0.03
    inflation_radius: Annotated[Positive, key("m", "Distance from obstacles beyond which a path costs no more.")] = 0.55
    cost_scaling_factor: Annotated[Positive, key("1/m", "Rate at which the cost decays with the distance from an obstacle.")] = 6.0
    cost_travel_multiplier: Annotated[float, Meta(ge=0), key("", "Weight of costs beside length; 0: the shortest path.")] = 5.0
    goal_tolerance: Annotated[Positive, key("m", "Distance at which a goal is reached.")] = 0.12
    look_tolerance: Annotated[Positive, key("m", "Distance at which a frontier is reached; it only has to be seen.")] = 0.3
    wait_at_goal: Annotated[float, Meta(ge=0), key("s", "Time at an operator's goal, reached or cancelled, before the job continues.")] = (
        5.0
    )
    patience: Annotated[Positive, key("s", "Time without progress before the goal is given up.")] = 8.0
    min_frontier_size: Annotated[int, Meta(ge=1), key("cells", "Smallest frontier that is explored.")] = 6
    frontier_gain: Annotated[float, Meta(ge=0), key("cells", "Path length that a cell of frontier is worth.")] = 0.5


class PlannerService(Service):
    """Global planner of one vehicle. It plans in the map frame and publishes in the world frame."""

    name = "planner"
    hz = 4.0
    given_up = "the vehicle stands where it would drive by itself"

    class Inputs(Reads):
        """Pose, map, mission, and requests for goals."""

        pose: PoseInFrame = topic(topics.POSE)
        map: Grid = topic(topics.MAP)
        status: VehicleStatus | None = optional(topics.STATUS)
        mission: Mission | None = optional(topics.MISSION)
        progress: MissionProgress | None = optional(topics.PROGRESS)
        bounds: Fence | None = optional(topics.FENCE)
        rally: RallyPoints | None = optional(topics.RALLY)
        goal: list[GoalRequest] = request(topics.GOAL)
        cancel: list[CancelRequest] = request(topics.CANCEL)
        set_mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)

    class Outputs(Writes):
        """Path, status, and replies."""

        path: PosesInFrame | None = topic(topics.PATH)
        nav_status: NavStatus | None = topic(topics.NAV_STATUS)
        events: list[Event] | None = topic(topics.EVENTS.by("planner"))
        goal: list[Reply] = replies(topics.GOAL)
        cancel: list[Reply] = replies(topics.CANCEL)
        set_mode: list[ModeRequest] = call(topics.SET_MODE)

    class Recalls(Reads):
        """Latched status from which a restarted instance resumes."""

        nav_status: NavStatus | None = topic(topics.NAV_STATUS)

    params: PlannerParams

    def __init__(self, world_from_map: Pose2, radius: float, explores: bool, params: PlannerParams, sensor_offset: float = 0.0) -> None:
        """radius: the vehicle's [m]; sensor_offset: from its centre to the lidar that draws the map [m], in the plane."""
        self.params = params
        self._sensor_offset = sensor_offset
        self._world_from_map = world_from_map
        self._map_from_world = inverse(world_from_map)
        self._explores = explores
        self._return_points = ReturnPoints()
        self._radius = radius
        self._navigator = GlobalPlanner(self._body)
        self._explorer = Explorer(self._taste)
        self._patrol = Patrol()
        self._map_stamp = -1.0
        self._job: Job = IDLE
        self._goal: Goal | None = None
        self._target: Point | None = None
        self._plan = PlannedPath(None)
        self._planned_at = -np.inf
        self._ended_at: float | None = None
        """When a person's goal was reached or cancelled, as ``_ending`` says."""
        self._ending: NavStatus.State = NavStatus.REACHED
        self._is_there = False
        self._shut_in = False
        """Nothing can be planned from where the vehicle stands; told when it begins."""
        self._progress_at = 0.0
        self._progress_pose: Pose2 = IDENTITY
        self._tries = 0
        self._asks: list[ModeRequest] = []
        self._events: list[Event] = []
        self._bounds: Fence | None = None

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: chooses the job, plans anew where map or job have changed, and watches the progress."""
        here = compose(self._map_from_world, pose2_of(now.pose.pose))
        self._explorer.taste = self._taste
        self._bounds = now.bounds
        changed = self._navigator.fit(self._body) | self._take_map(now.map) | self._navigator.stand(here[:2])
        goal_replies = self._ask_all(t, here, now.goal, now.status)
        home = home_of(now.status) or self._world_from_map[:2]
        return_point = self._return_points.step(now.status, (now.pose.pose.position.x, now.pose.pose.position.y), home, now.rally)
        job = choose(now.status, self._goal, mission_target(now.mission, now.progress, home), Orders(return_point, self._explores))
        if job != self._job:
            self._begin(t, job)
            changed = True
        cancel_replies = [self._cancel(t, request) for request in now.cancel]
        failed = self._plan.path is None and t - self._planned_at >= REPLAN_PERIOD
        if self._ended_at is None and (changed or failed):
            self._replan(t, here)
        self._watch(t, here, now.status)
        events, self._events = self._events, []
        asks, self._asks = self._asks, []
        return self.Outputs(
            path=self._path(t),
            nav_status=self._nav_status(t, here),
            events=events,
            set_mode=asks,
            goal=goal_replies,
            cancel=cancel_replies,
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
        """Outputs at ``t`` [s, simulation] without a fresh pose or a map: no path, so that the tracker stops."""
        reason = f"waiting for {', '.join(missing)}"
        return self.Outputs(
            path=PosesInFrame(timestamp=stamp(t), frame_id="world"),
            nav_status=NavStatus(timestamp=stamp(t), state=NavStatus.IDLE, job=self._job.name, reason=reason),
        )

    @property
    def _body(self) -> PlannedBody:
        params = self.params
        footprint = RobotFootprint.circle(self._radius + params.margin)
        inflation = Inflation(params.inflation_radius, params.cost_scaling_factor)
        return PlannedBody(footprint, inflation, params.cost_travel_multiplier, self._sensor_offset)

    @property
    def _taste(self) -> FrontierWeights:
        return FrontierWeights(self.params.min_frontier_size, FRONTIER_VIEW, self.params.frontier_gain)

    def _take_map(self, grid: Grid) -> bool:
        taken_at = seconds(grid.timestamp)
        if taken_at == self._map_stamp:
            return False
        self._map_stamp = taken_at
        self._navigator.see(occupancy_cells(grid), (grid.cell_size.x, (grid.pose.position.x, grid.pose.position.y)))
        return True

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

    def _ask(self, here: Pose2, request: GoalRequest, status: VehicleStatus | None) -> Reply:
        wanted = (request.position.x, request.position.y)
        reason = not_now(status) or self._beyond(wanted) or self._navigator.refusal(here[:2], self._in_map(wanted))
        if isinf(request.yaw):
            reason = "the heading is infinite; give it in rad, or NaN for any"
        return Reply(accepted=not reason, reason=reason)

    def _beyond(self, wanted: Point) -> str:
        """Why a place lies too near to the fence, or outside of it; empty if it does not."""
        room = inf if self._bounds is None else fencing(self._bounds).region.at(wanted)
        if room < 0:
            return f"the goal is {-room:.1f} m outside of the fence"
        return f"the goal is {room:.2f} m from the fence, too near" if room < self._radius + self.params.margin else ""

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
        self._ended_at, self._ending = t, ending
        self._plan = PlannedPath(None, reason)

    def _begin(self, t: float, job: Job) -> None:
        if job.name != self._job.name:
            self._tell(t, f"job: {job.name}", "")
        self._job = job
        self._shut_in = False
        self._ended_at = None
        self._progress_at = t
        self._tries = 0
        self._explorer.goal = None

    def _replan(self, t: float, here: Pose2) -> None:
        self._planned_at = t
        if self._job == IDLE:
            self._target, self._plan = None, PlannedPath(None, "no job")
        elif self._job.target is not None:
            self._target = self._in_map(self._job.target)
            self._plan = self._navigator.plan(here[:2], self._target, self._job.allow_unknown)
        else:
            self._replan_exploring(t, here)

    def _replan_exploring(self, t: float, here: Pose2) -> None:
        ways, costs, reason = self._navigator.ways(here[:2]), self._navigator.costs, self._navigator.shut_in(here[:2])
        if reason and not self._shut_in:
            self._tell(t, "explore: nothing can be planned", reason, Event.WARNING)
        self._shut_in = bool(reason)
        if reason or ways is None or costs is None:
            self._target, self._plan = None, PlannedPath(None, reason)
            return
        frontier = self._explorer.choose(t, costs, ways)
        self._target = frontier or self._patrol.choose(here[:2], costs, ways)
        self._plan = self._navigator.plan(here[:2], self._target) if self._target else PlannedPath(None, "everything is explored")
        if self._target is not None and self._plan.path is None:
            self._done_with_target(t)

    def _done_with_target(self, t: float) -> None:
        """Another frontier or place of the patrol is to be chosen."""
        self._explorer.blacklist_goal(t)
        self._patrol.reached()

    def _watch(self, t: float, here: Pose2, status: VehicleStatus | None) -> None:
        """Has the goal been reached, or does the vehicle get nowhere?"""
        if self._ended_at is not None:
            if t - self._ended_at >= self.params.wait_at_goal:
                self._goal = None
            return
        if self._target is None:
            return
        self._is_there = self._is_near(here)
        if self._is_there:
            self._arrive(t, here)
            return
        last = self._progress_pose
        moved = hypot(here[0] - last[0], here[1] - last[1]) > 0.1 or abs(wrap(here[2] - last[2])) > 0.3
        held = status is None or status.command_source != "planner"
        if moved or held:
            self._progress_at, self._progress_pose = t, here
        elif t - self._progress_at > self.params.patience:
            self._give_up(t, self._plan.reason or "no progress")

    def _is_near(self, here: Pose2) -> bool:
        """Reached, in the place and in the wanted heading."""
        tolerance = self.params.look_tolerance if self._job.name == "explore" else self.params.goal_tolerance
        if self._target is None or not hypot(here[0] - self._target[0], here[1] - self._target[1]) <= tolerance:
            return False
        wanted = self._job.yaw
        return wanted is None or abs(np.sin((here[2] + self._world_from_map[2] - wanted) / 2)) < 0.05

    def _arrive(self, t: float, here: Pose2) -> None:
        if self._job.name == "goal":
            self._end(t, NavStatus.REACHED, "goal reached")
            self._tell(t, "goal reached", "")
        elif self._job.name == "explore":
            self._is_there = False
            self._done_with_target(t)
            self._replan(t, here)

    def _give_up(self, t: float, reason: str) -> None:
        self._progress_at = t
        if self._job.allow_unknown:
            self._try_again(t, reason)
            return
        self._tell(t, f"{self._job.name}: goal given up", reason, Event.WARNING)
        if self._job.name == "goal":
            self._goal = None
        else:
            self._done_with_target(t)
            self._planned_at = -np.inf
            self._plan = PlannedPath(None, reason)

    def _try_again(self, t: float, reason: str) -> None:
        """Neither a mission nor the way home may be left out; after some tries a person has to decide."""
        self._tries += 1
        if self._tries < TRIES:
            self._tell(t, f"{self._job.name}: trying again", reason, Event.WARNING)
            return
        self._tell(t, f"{self._job.name}: holding after {self._tries} tries", reason, Event.WARNING)
        self._tries = 0
        self._asks.append(ModeRequest(mode=Mode.MODE_HOLD, source="planner"))

    def _in_map(self, point: Point) -> Point:
        x, y, _ = compose(self._map_from_world, Pose2(point[0], point[1], 0.0))
        return (x, y)

    def _path(self, t: float) -> PosesInFrame:
        """The last pose has an orientation when a heading is wanted there; the others are the line's points."""
        message = PosesInFrame(timestamp=stamp(t), frame_id="world")
        if self._plan.path is not None:
            points = transform(self._world_from_map, self._plan.path).tolist()
            message.poses.extend(Pose(position=Vector3(x=x, y=y)) for x, y in points)
            if self._job.yaw is not None:
                message.poses[-1].CopyFrom(planar_pose(points[-1][0], points[-1][1], self._job.yaw))
        return message

    def _nav_status(self, t: float, here: Pose2) -> NavStatus:
        status = NavStatus(timestamp=stamp(t), job=self._job.name, reason=self._plan.reason, explored=self._explorer.explored)
        status.state = self._state()
        if self._target is not None:
            x, y, _ = compose(self._world_from_map, Pose2(self._target[0], self._target[1], 0.0))
            status.goal.x, status.goal.y = x, y
        if self._plan.path is not None:
            nearest = int(np.argmin(np.hypot(*(self._plan.path - np.array(here[:2])).T)))
            status.distance_left = length(self._plan.path[nearest:])
        return status

    def _state(self) -> NavStatus.State:
        if self._ended_at is not None:
            return self._ending
        if self._is_there:
            return NavStatus.REACHED
        if self._target is None:
            return NavStatus.BLOCKED if self._shut_in else NavStatus.IDLE
        return NavStatus.DRIVING if self._plan.path is not None else NavStatus.BLOCKED

    def _tell(self, t: float, text: str, cause: str, severity: Event.Severity = Event.NOTICE) -> None:
        self._events.append(Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source="planner"))
