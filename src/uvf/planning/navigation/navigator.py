"""Navigate to a pose: plan, follow, watch the progress, and recover by the cause; every step is told with its reason."""

from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import chain
from math import hypot, inf
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.planning.local.controller import Drive
from uvf.planning.navigation.directive import Action, Directive, Report
from uvf.planning.navigation.failures import Attempt, Failure, Recovery, recoveries
from uvf.planning.navigation.progress import ProgressChecker, ProgressSettings
from uvf.planning.smoothing import length

Floats = NDArray[np.float64]

LONGEST = 12.0  # s that turning round or backing up may take
TOLD_AGAIN = 5.0  # s between two entries of the log about a blocked path: what moves blocks and frees it often


@dataclass(frozen=True)
class NavigationGoal:
    """Where to go: x, y [m, planning frame], and yaw [rad], None = any."""

    x: float
    y: float
    yaw: float | None = None
    tolerance: float = 0.25  # m from it that counts as there
    most_recoveries: int = 30  # in all
    via: tuple[tuple[float, float], ...] = ()
    """Places [m, planning frame] to pass on the way, in this order."""


@dataclass(frozen=True)
class Route:
    """A path (n, 2) [m] from the vehicle to the goal, or none and why."""

    path: Floats | None
    failure: Failure = Failure.NONE
    reason: str = ""
    """More than the failure's own words, where there is more to say."""


class RouteSource(Protocol):
    """Plans on what is known now."""

    def plan(self, pose: Pose2, goal: NavigationGoal) -> Route:
        """The best path to the goal."""
        ...

    def is_free(self, path: Floats) -> bool:
        """Whether nothing stands on a path (n, 2) [m] any more than when it was planned."""
        ...

    def has_room_to_turn(self, pose: Pose2) -> bool:
        """Whether no known obstacle is in the way of turning on the spot."""
        ...

    def reset(self) -> None:
        """Doubts what is remembered: what is seen now counts more."""
        ...


class Status(Enum):
    """Where a goal stands."""

    IDLE = "no goal"
    FOLLOWING = "following the path"
    RECOVERING = "recovering"
    REACHED = "goal reached"
    ABORTED = "goal given up"
    CANCELLED = "goal cancelled"


@dataclass(frozen=True)
class NavigatorSettings:
    """How patiently a goal is driven to."""

    yaw_goal_tolerance: float = 0.1  # rad
    replan_period: float = 1.0  # s
    passed: float = 0.35  # m from a place on the way that counts as passed
    recovered: float = 1.0  # m of the way by which it must have become shorter for recoveries to begin from the first again
    circumscribed_radius: float = 0.3  # m, of the footprint
    turning_radius: float = 0.0  # m, of the tightest circle; 0: it turns on the spot
    progress: ProgressSettings = field(default_factory=ProgressSettings)


@dataclass(frozen=True)
class Feedback:
    """What can be told of a goal: distance [m] and time [s] remaining, and what was tried."""

    status: Status
    distance_remaining: float
    time_remaining: float
    recoveries: int
    failure: Failure
    reason: str


class Navigator:
    """Drives to one goal after the other. ``log`` holds (t [s], text) of every step, for who wants to know why."""

    def __init__(self, source: RouteSource, settings: NavigatorSettings) -> None:
        self.settings = settings
        self.log: list[tuple[float, str]] = []
        self._source = source
        self._progress = ProgressChecker(settings.progress)
        self._goal: NavigationGoal | None = None
        self._status, self._failure, self._reason = Status.IDLE, Failure.NONE, ""
        self._directive = Directive(0)
        self._planned_at = -inf
        self._tried = 0
        self._count, self._begun_with = 0, inf
        self._begun_at: Pose2 | None = None
        self._until, self._waits = -inf, False
        self._speed, self._blocked_at = 0.0, -inf
        self._at: tuple[float, Pose2] | None = None

    def fit(self, settings: NavigatorSettings) -> None:
        """Is as patient as ``settings`` say from now on."""
        self.settings = settings
        self._progress.settings = settings.progress

    def replan(self) -> None:
        """Plans anew in the next step."""
        self._planned_at = -inf

    def start(self, t: float, goal: NavigationGoal) -> None:
        """Takes a goal at ``t`` [s]; the one before is preempted."""
        if not (np.isfinite((goal.x, goal.y, *chain.from_iterable(goal.via))).all() and (goal.yaw is None or np.isfinite(goal.yaw))):
            raise ValueError(f"goal: ({goal.x}, {goal.y}, {goal.yaw}); its coordinates must be finite [m, m, rad]")
        self._goal, self._status = self._within_reach(goal), Status.FOLLOWING
        self._failure, self._reason = Failure.NONE, ""
        self._tried, self._count, self._until = 0, 0, -inf
        self._begun_with, self._begun_at = inf, None
        self._planned_at, self._at = -inf, None
        self._progress.new_way(t)
        if self._directive.action != Action.FOLLOW:
            self._direct(Action.STOP)

    def lead_on(self, t: float, goal: NavigationGoal) -> None:
        """The goal that is being driven to has moved at ``t`` [s]: recoveries go on where they are."""
        self._goal, self._planned_at = self._within_reach(goal), -inf
        self._progress.new_way(t)

    def _within_reach(self, goal: NavigationGoal) -> NavigationGoal:
        """Who cannot turn on the spot comes to the place, heading anywhere."""
        return goal if self.settings.turning_radius == 0.0 else replace(goal, yaw=None)

    def cancel(self, t: float) -> None:
        """Gives the goal up because somebody asked for it; the vehicle stops."""
        if self.is_busy:
            self._end(t, Status.CANCELLED, Failure.CANCELLED, "")

    def pause(self, t: float, pose: Pose2) -> None:
        """The vehicle stands, or drives, because somebody else commands it: that is no lack of progress."""
        self._progress.reset(t, pose)
        if self._status == Status.RECOVERING:
            self._status, self._planned_at = Status.FOLLOWING, -inf

    @property
    def is_busy(self) -> bool:
        """Whether a goal is being driven to."""
        return self._status in (Status.FOLLOWING, Status.RECOVERING)

    @property
    def feedback(self) -> Feedback:
        """Of the last step."""
        left = length(self._directive.path) if self._directive.action == Action.FOLLOW else inf
        eta = left / self._speed if self._speed > 0.01 else inf
        return Feedback(self._status, left, eta, self._count, self._failure, self._reason or self._failure.value)

    def step(self, t: float, pose: Pose2, report: Report) -> Directive:
        """What to do at ``t`` [s], with the vehicle at ``pose`` and what its controller reports of the last directive."""
        self._measure(t, pose)
        if not self.is_busy or self._goal is None:
            return self._directive
        self._pass(pose)
        if self._is_reached(pose, self._goal):
            self._end(t, Status.REACHED, Failure.NONE, "")
        elif self._status == Status.RECOVERING:
            self._recover_on(t, pose, self._goal, report)
        if self._status == Status.FOLLOWING:
            self._follow(t, pose, self._goal, report)
        return self._directive

    def _pass(self, pose: Pose2) -> None:
        """Strikes off the places on the way that have been passed."""
        goal = self._goal
        if goal is not None and goal.via and hypot(pose[0] - goal.via[0][0], pose[1] - goal.via[0][1]) <= self.settings.passed:
            self._goal = replace(goal, via=goal.via[1:])

    def _follow(self, t: float, pose: Pose2, goal: NavigationGoal, report: Report) -> None:
        blocked = self._directive.action == Action.FOLLOW and not self._source.is_free(self._directive.path)
        if t - self._planned_at >= self.settings.replan_period or blocked or self._directive.action != Action.FOLLOW:
            route = self._plan(t, pose, goal)
            if route.path is None:
                self._fail(t, pose, route.failure, route.reason)
                return
            if self._directive.action != Action.FOLLOW:
                was_reset = self._directive.clear_beyond is not None
                self._progress.reset(t, pose, self.settings.progress.time_allowance_after_reset if was_reset else None)
            if blocked and t - self._blocked_at >= TOLD_AGAIN:
                self._blocked_at = t
                self._tell(t, "the path is blocked; another one is taken")
                self._progress.new_way(t)
            self._lead(route.path, goal.yaw)
        self._watch(t, pose, report)

    def _watch(self, t: float, pose: Pose2, report: Report) -> None:
        left = _remaining(self._directive.path, pose)
        self._progress.look(t, pose, left)
        begun = self._begun_at
        if (
            begun is not None
            and hypot(pose[0] - begun[0], pose[1] - begun[1]) >= self.settings.recovered
            and left <= self._begun_with - self.settings.recovered
        ):
            if self._tried:
                self._tell(t, "recovered: the vehicle gets on")
            self._tried, self._begun_with, self._begun_at = 0, inf, None
        if self._progress.is_standing(t):
            cause = {Drive.NO_VALID_CONTROL: Failure.NO_VALID_CONTROL, Drive.STOPPED: Failure.BLOCKED}
            self._fail(t, pose, cause.get(report.how, Failure.FAILED_TO_MAKE_PROGRESS), "")
        elif self._progress.is_oscillating(t):
            self._fail(t, pose, Failure.OSCILLATING, "")

    def _fail(self, t: float, pose: Pose2, failure: Failure, reason: str) -> None:
        """Something is in the way: the next recovery against it, or none is left."""
        self._failure, self._reason = failure, reason
        attempts = recoveries(failure, self.settings.circumscribed_radius, self.settings.turning_radius)
        if self._tried >= len(attempts) or (self._goal is not None and self._count >= self._goal.most_recoveries):
            self._end(t, Status.ABORTED, failure, reason)
            return
        attempt, self._tried = attempts[self._tried], self._tried + 1
        if attempt.recovery == Recovery.CLEARING_ROTATION and not self._source.has_room_to_turn(pose):
            self._tell(t, "no room to turn round")
            self._fail(t, pose, failure, reason)
            return
        self._count += 1
        if self._begun_at is None:
            self._begun_at = pose
            self._begun_with = _remaining(self._directive.path, pose) if self._directive.action == Action.FOLLOW else inf
        self._begin(t, attempt, failure, reason)

    def _begin(self, t: float, attempt: Attempt, failure: Failure, reason: str) -> None:
        self._tell(t, f"{attempt.recovery.value}, because {reason or failure.value}")
        self._status = Status.RECOVERING
        kind, amount = attempt.recovery, attempt.amount
        self._waits = kind == Recovery.WAIT
        if kind in (Recovery.CONSERVATIVE_RESET, Recovery.AGGRESSIVE_RESET):
            self._direct(Action.STOP, clear_beyond=amount)
            if kind == Recovery.AGGRESSIVE_RESET:
                self._source.reset()
            self._until = t + 0.5
        elif kind == Recovery.WAIT:
            self._direct(Action.STOP)
            self._until = t + amount
        else:
            self._direct(Action.SPIN if kind == Recovery.CLEARING_ROTATION else Action.BACK_UP, amount=amount)
            self._until = t + LONGEST

    def _recover_on(self, t: float, pose: Pose2, goal: NavigationGoal, report: Report) -> None:
        mine = report.number == self._directive.number
        if mine and report.impossible:
            self._tell(t, f"impossible to {self._directive.action.value}: an obstacle is in the way")
        elif self._waits:  # whatever stood in the way may leave before the time is over
            if t < self._until and (t - self._planned_at < self.settings.replan_period or self._plan(t, pose, goal).path is None):
                return
        elif not (t >= self._until or (mine and report.done)):
            return
        self._status, self._planned_at = Status.FOLLOWING, -inf

    def _plan(self, t: float, pose: Pose2, goal: NavigationGoal) -> Route:
        self._planned_at = t
        return self._source.plan(pose, goal)

    def _is_reached(self, pose: Pose2, goal: NavigationGoal) -> bool:
        if goal.via or hypot(pose[0] - goal.x, pose[1] - goal.y) > goal.tolerance:
            return False
        return goal.yaw is None or abs(wrap(pose[2] - goal.yaw)) <= self.settings.yaw_goal_tolerance

    def _end(self, t: float, status: Status, failure: Failure, reason: str) -> None:
        self._status, self._failure, self._reason = status, failure, reason
        self._direct(Action.STOP)

    def _direct(self, action: Action, amount: float = 0.0, clear_beyond: float | None = None) -> None:
        """A new directive."""
        self._directive = Directive(self._directive.number + 1, action, amount=amount, clear_beyond=clear_beyond)

    def _lead(self, path: Floats, heading: float | None) -> None:
        """The directive to follow a path; a newer path is no new directive."""
        number = self._directive.number + (self._directive.action != Action.FOLLOW)
        self._directive = Directive(number, Action.FOLLOW, path, heading)

    def _measure(self, t: float, pose: Pose2) -> None:
        """A smooth speed for the time remaining."""
        if self._at is not None and t > self._at[0]:
            dt = t - self._at[0]
            speed = hypot(pose[0] - self._at[1][0], pose[1] - self._at[1][1]) / dt
            self._speed += min(dt / 2.0, 1.0) * (speed - self._speed)
        self._at = t, pose

    def _tell(self, t: float, text: str) -> None:
        self.log.append((t, text))


def _remaining(path: Floats, pose: Pose2) -> float:
    """m along a path (n, 2) from the point that is nearest to the vehicle, and to that point."""
    if len(path) == 0:
        return inf
    distances = np.hypot(path[:, 0] - pose[0], path[:, 1] - pose[1])
    nearest = int(np.argmin(distances))
    return float(distances[nearest]) + length(path[nearest:])
