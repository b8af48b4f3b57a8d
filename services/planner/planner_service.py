"""Map, pose and job -> what the tracker is to do, four times a second: a path to follow, or a recovery."""

from math import hypot, inf, isfinite, isinf

from schemas.messages import (
    CancelRequest,
    Event,
    Mode,
    ModeRequest,
    NavDirective,
    NavStatus,
    PosesInFrame,
    Reply,
)
from services.planner import interface
from services.planner.directives import directive_message, path_message, report_of
from services.planner.errands import ErrandBook
from services.planner.exploration_goals import ExplorationGoals
from services.planner.giving_way import GivingWay
from services.planner.goal_desk import GoalDesk
from services.planner.jobs import IDLE, Job, Orders, ReturnPoints, choose, home_of, mission_target
from services.planner.lent_maps import team_map
from services.planner.obstacle_sensors import OtherReadings
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planning_ground import PlanningGround
from services.planner.team import Teammates
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.terrain import TerrainLimits
from uvf.planning.frontiers import FrontierChoice, FrontierWeights
from uvf.planning.global_planner import NO_PLACE, GlobalPlanner, PlannedBody
from uvf.planning.navigation.directive import Directive
from uvf.planning.navigation.navigator import NavigationGoal, Navigator, NavigatorSettings, Status
from uvf.planning.navigation.progress import ProgressSettings
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp

Point = tuple[float, float]

FRONTIER_VIEW = 0.4  # m from a frontier, from where it is seen well enough
EXPLORING_RECOVERIES = 2  # before another goal is chosen: there are more of them
MOVED = 0.2  # m of the place behind who is followed, from which on the way there is planned anew
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

    Inputs = interface.Inputs
    Outputs = interface.Outputs
    Recalls = interface.Recalls
    params: PlannerParams

    def __init__(self, world_from_map: Pose2, vehicle: PlannedVehicle, params: PlannerParams) -> None:
        self.params = params
        self._world_from_map = world_from_map
        self._vehicle, self._footprint = vehicle, vehicle.footprint
        self._planner = GlobalPlanner(self._body)
        self._ground = PlanningGround(vehicle.name, self._planner, vehicle.sensors, world_from_map)
        self._navigator = Navigator(self._ground.routes, self._patience)
        self._exploration = ExplorationGoals(self._planner, self._taste)
        self._return_points = ReturnPoints()
        self._job: Job = IDLE
        self._target: Point | None = None
        self._reason = ""
        """Why there is nowhere to go."""
        self._ended_at: float | None = None
        """When a person's goal was reached or cancelled, as ``_ending`` says."""
        self._ending: NavStatus.State = NavStatus.REACHED
        self._try_at = inf
        """When a place that was given up is tried again."""
        self._told = 0
        self._team = Teammates(vehicle.name, self._footprint.circumscribed_radius, world_from_map)
        self._right = GivingWay(vehicle.name, self._footprint.circumscribed_radius, self._ground.routes)
        self._asks: list[ModeRequest] = []
        self._events: list[Event] = []
        self._desk = GoalDesk(self._planner, world_from_map, vehicle.speed)
        self._book = ErrandBook(self._desk)

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        """One cycle at ``t`` [s, simulation]: chooses the job and its place, plans, watches the progress, and recovers."""
        self._ground.move(now.pose)
        here, self._desk.bounds = self._ground.here, now.bounds
        if here is None:
            return self.stale(t, ("pose",))
        self._fit()
        self._ground.keep_out(now.keep_out)
        team = team_map(self._vehicle.name, now.team_place, now.team_map)
        if fault := self._ground.share(now.shared, TerrainLimits(self.params.max_step, self.params.max_slope), team):
            self._tell(t, "the map of another vehicle is left out", fault, Event.WARNING)
        readings = OtherReadings(now.depth, now.info, now.sonar, now.contact, now.range)
        changed = self._ground.look(t, now.map, now.scans, readings)
        self._team.hear(now.team, now.team_nav, now.team_path)
        self._book.team = self._team.places
        if self._ended_at is not None and t - self._ended_at >= self.params.wait_at_goal:
            self._go_on()
        goal_replies, goal = self._book.take_goals(here, now.goal, now.status)
        route_replies, route = self._book.take_routes(here, now.route, now.status)
        follow_replies, follow = self._book.take_follows(now.follow, now.status)
        for taken, asked in ((follow, now.follow), (goal, now.goal), (route, now.route)):
            self._tell_taken(t, taken, [request.source for request in asked])
        place = compose(self._world_from_map, here)[:2]
        home = home_of(now.status) or self._world_from_map[:2]
        return_point = self._return_points.step(now.status, place, home, now.rally)
        target = mission_target(now.mission, now.progress, home)
        job = choose(now.status, self._book.errand, target, Orders(return_point, self._vehicle.explores))
        if job != self._job:
            self._begin(t, job)
        cancel_replies = [self._cancel(t, request) for request in now.cancel]
        self._aim(t, here, changed)
        if now.status is None or now.status.command_source != "planner" or self._right.waits_for:
            self._navigator.pause(t, here)
        directive = self._navigator.step(t, here, report_of(now.report))
        directive = self._give_way(t, directive, here)
        self._ground.heed(directive)
        self._follow_up(t)
        self._tell_recoveries()
        events, self._events = self._events, []
        asks, self._asks = self._asks, []
        return self.Outputs(
            directive=directive_message(t, directive),
            path=path_message(t, directive, self._world_from_map),
            nav_status=self._nav_status(t),
            costmap=self._ground.costmap(t),
            events=events,
            set_mode=asks,
            goal=goal_replies,
            route=route_replies,
            follow=follow_replies,
            cancel=cancel_replies,
            preview=self._desk.previews(here, now.preview),
        )

    def recall(self, left: interface.Recalls) -> None:
        """Resumes a person's errand."""
        if left.nav_status is not None:
            self._book.resume(left.nav_status)

    def stale(self, t: float, missing: tuple[str, ...]) -> interface.Outputs:
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
        return PlannedBody(self._footprint.padded(params.margin), inflation, params.cost_travel_multiplier, offset, params.global_planner)

    @property
    def _taste(self) -> FrontierWeights:
        return FrontierWeights(
            self.params.min_frontier_size, FRONTIER_VIEW, self.params.frontier_gain, FrontierChoice(self.params.frontier_choice)
        )

    @property
    def _patience(self) -> NavigatorSettings:
        progress = ProgressSettings(movement_time_allowance=self.params.patience)
        radius = self._footprint.circumscribed_radius
        tightest = self._vehicle.turning_radius
        return NavigatorSettings(
            replan_period=self.params.replan_period, circumscribed_radius=radius, turning_radius=tightest, progress=progress
        )

    def _fit(self) -> None:
        """Heeds the parameters."""
        self._exploration.explorer.taste = self._taste
        self._navigator.fit(self._patience)
        if self._planner.fit(self._body):
            self._navigator.replan()

    def _give_way(self, t: float, directive: Directive, here: Pose2) -> Directive:
        """The directive as far as it may be followed now, for another vehicle comes through a passage that is too narrow for two."""
        waited_for = self._right.waits_for
        heeded = self._right.heed(directive, here, self._team)
        if self._right.waits_for not in ("", waited_for):
            self._tell(t, f"waits for {self._right.waits_for}", "it comes first through a narrow passage")
        return heeded

    def _tell_taken(self, t: float, what: str, sources: list[str]) -> None:
        """A new errand; asked for anew, the same one is begun anew."""
        if what:
            self._job = IDLE
            self._tell(t, what, f"asked by {sources[-1] or 'unknown'}")

    def _go_on(self) -> None:
        """A person's goal was reached, or cancelled, a while ago: what is left of the errand, or the job, is begun in this step."""
        if self._ending == NavStatus.REACHED:
            self._book.go_on(reached=True)
        else:
            self._book.drop()
        if self._book.errand is not None:
            self._job = IDLE

    def _cancel(self, t: float, request: CancelRequest) -> Reply:
        """The vehicle stops; it stays as long as at a goal that was reached before its job goes on."""
        if self._book.errand is None or (self._ended_at is not None and self._book.errand.after(reached=True) is None):
            return Reply(accepted=False, reason="there is no goal to cancel")
        cause = f"asked by {request.source or 'unknown'}"
        self._tell(t, "goal cancelled", cause)
        if self._job.is_errand:
            self._end(t, NavStatus.CANCELLED, f"goal cancelled, {cause}")
        else:
            self._book.drop()
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
            return
        if self._job == IDLE:
            self._navigator.cancel(t)
            self._reason = "no job"
        elif self._job.leader:
            self._aim_following(t, here)
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
        via = tuple(self._desk.in_map(point) for point in self._job.via)
        self._navigator.start(t, NavigationGoal(*target, yaw, tolerance, most, via))

    def _is_pushed_away(self, here: Pose2) -> bool:
        """Whether the vehicle was where it should be, and is no longer."""
        if self._target is None or self._navigator.feedback.status != Status.REACHED:
            return False
        return hypot(here[0] - self._target[0], here[1] - self._target[1]) > PUSHED * self.params.goal_tolerance

    def _aim_following(self, t: float, here: Pose2) -> None:
        """The place on the track of who is followed; near enough, or without hearing of them, the vehicle stands."""
        leader, track = self._job.leader, self._book.track
        place = self._book.team.get(leader)
        if place is not None:
            track.add(place)
        target = None if place is None else track.target(compose(self._world_from_map, here)[:2])
        if target is None:
            self._navigator.cancel(t)
            self._target, self._reason = None, f"nothing is heard of {leader}" if place is None else f"near enough to {leader}"
            return
        in_map, busy = self._desk.in_map(target), self._navigator.is_busy
        has_moved = self._target is None or hypot(in_map[0] - self._target[0], in_map[1] - self._target[1]) > MOVED
        if busy and self._target is not None:
            if has_moved:
                self._target = in_map
                self._navigator.lead_on(t, NavigationGoal(*in_map, None, self.params.goal_tolerance))
        elif self._navigator.feedback.status != Status.ABORTED or has_moved or t >= self._try_at:
            self._try_at = inf
            self._go(t, in_map, self.params.goal_tolerance)

    def _aim_exploring(self, t: float, here: Pose2) -> None:
        was_shut_in = self._exploration.is_shut_in
        target, reason = self._exploration.choose(t, here[:2], self._team.goals)
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
        if told.status == Status.REACHED and self._job.is_errand and not self._job.leader:
            self._end(t, NavStatus.REACHED, "goal reached")
            self._tell(t, "goal reached", "")
        elif told.status == Status.ABORTED and self._job.leader:
            # Who is followed goes on, and so does the place to go to: no place on its way is the last one.
            self._try_at = min(self._try_at, t + AGAIN)
        elif told.status == Status.ABORTED and self._job != IDLE:
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
            if self._job.is_errand:
                self._book.go_on(reached=False)
                self._job = IDLE

    def _tell_recoveries(self) -> None:
        log = self._navigator.log
        for at, text in log[self._told :]:
            self._tell(at, text, self._job.name)
        self._told = len(log)

    def _nav_status(self, t: float) -> NavStatus:
        told = self._navigator.feedback
        status = NavStatus(
            timestamp=stamp(t), job=self._job.name, reason=self._why or told.reason, explored=self._exploration.explorer.explored
        )
        status.state, status.recoveries = self._state(told.status), told.recoveries
        self._book.show(status)
        status.radius, status.waits_for = self._footprint.circumscribed_radius, self._right.waits_for
        if self._target is not None:
            x, y, _ = compose(self._world_from_map, Pose2(self._target[0], self._target[1], 0.0))
            status.goal.x, status.goal.y = x, y
        if isfinite(told.distance_remaining):
            status.distance_left = told.distance_remaining
        if isfinite(told.time_remaining):
            status.time_left = told.time_remaining
        return status

    @property
    def _why(self) -> str:
        return f"waits for {self._right.waits_for} at a narrow passage" if self._right.waits_for else self._reason

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
