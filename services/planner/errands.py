"""What persons ask a ground vehicle for: one errand at a time, and the newest one that can be driven counts."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import isfinite, isinf, isnan, nan
from typing import TypeVar

from schemas.messages import FollowRequest, GoalRequest, NavStatus, Reply, RouteRequest, Vector3, VehicleStatus
from services.planner.goal_desk import GoalDesk
from services.planner.jobs import Errand, Goal, not_now
from uvf.maths.se2 import Pose2
from uvf.planning.navigation.following import TrackBehind

Point = tuple[float, float]
R = TypeVar("R", GoalRequest, RouteRequest, FollowRequest)

KINDS = {RouteRequest.WAYPOINTS: "waypoints", RouteRequest.THROUGH: "through", RouteRequest.PATROL: "patrol"}
USUAL_DISTANCE, MOST_DISTANCE = 1.0, 20.0  # m behind who is followed
NOWHERE = (nan, nan)
NO_HEADING = "the heading is infinite; give it in rad, or NaN for any"


class ErrandBook:
    """One vehicle's."""

    def __init__(self, desk: GoalDesk) -> None:
        self._desk = desk
        self.errand: Errand | None = None
        self.route: RouteRequest | None = None
        """The route that it is, as it was asked for."""
        self.follow: FollowRequest | None = None
        """Who is followed, as it was asked for."""
        self.track = TrackBehind(USUAL_DISTANCE)
        """Of who is followed [m, world]."""
        self.team: dict[str, Point] = {}
        """Where the other vehicles are [m, world]."""

    def take_goals(self, here: Pose2, requests: list[GoalRequest], status: VehicleStatus | None) -> tuple[list[Reply], str]:
        """Replies, and what has been taken in words, "" for nothing; of several the last that can be driven to counts."""
        replies, taken = _answered(requests, lambda request: not_now(status) or self._goal_refusal(here, request))
        if taken is None:
            return replies, ""
        self.errand = Errand("goal", (Goal(_point(taken.position), None if isnan(taken.yaw) else taken.yaw),))
        self.route = self.follow = None
        return replies, f"goal ({taken.position.x:.1f}, {taken.position.y:.1f})"

    def take_routes(self, here: Pose2, requests: list[RouteRequest], status: VehicleStatus | None) -> tuple[list[Reply], str]:
        """As ``take_goals``."""
        replies, taken = _answered(requests, lambda request: not_now(status) or self._route_refusal(here, request))
        if taken is None:
            return replies, ""
        self.errand, self.route, self.follow = _errand(taken), taken, None
        return replies, f"{self.errand.name} of {len(taken.places)} places"

    def take_follows(self, requests: list[FollowRequest], status: VehicleStatus | None) -> tuple[list[Reply], str]:
        """As ``take_goals``."""
        replies, taken = _answered(requests, lambda request: not_now(status) or self._follow_refusal(request))
        if taken is None:
            return replies, ""
        self._begin_following(taken)
        return replies, f"follow {taken.vehicle}"

    def _begin_following(self, wanted: FollowRequest) -> None:
        self.errand = Errand("follow", (Goal(self.team.get(wanted.vehicle, NOWHERE)),), leader=wanted.vehicle)
        self.route, self.follow = None, wanted
        self.track = TrackBehind(wanted.distance or USUAL_DISTANCE)

    def go_on(self, reached: bool) -> None:
        """The place of the errand is reached, or given up: the next one is to be driven to, if there is one."""
        self.errand = None if self.errand is None else self.errand.after(reached)
        if self.errand is None:
            self.drop()

    def drop(self) -> None:
        """The errand is over."""
        self.errand = self.route = self.follow = None

    def show(self, status: NavStatus) -> None:
        """Tells of a route or who is followed, so that an instance that is started again can go on with it."""
        if self.errand is not None and self.route is not None:
            status.route.CopyFrom(self.route)
            status.route_at = self.errand.at
        if self.follow is not None:
            status.follow.CopyFrom(self.follow)

    def resume(self, status: NavStatus) -> None:
        """Goes on with what another instance was about; the heading of a single goal is not known any more."""
        if status.state == NavStatus.CANCELLED:
            return
        if status.job == "goal" and status.state != NavStatus.REACHED:
            self.errand = Errand("goal", (Goal((status.goal.x, status.goal.y)),))
        elif status.HasField("route") and status.route.places and status.route.kind in KINDS:
            errand = _errand(status.route)
            self.route = status.route
            self.errand = replace(errand, at=min(status.route_at, len(errand.goals) - 1))
        elif status.HasField("follow") and MOST_DISTANCE >= status.follow.distance >= 0.0:
            self._begin_following(status.follow)

    def _follow_refusal(self, wanted: FollowRequest) -> str:
        if wanted.vehicle not in self.team:
            return f"nothing is heard of a vehicle '{wanted.vehicle}' to follow; there are {', '.join(sorted(self.team)) or 'no others'}"
        if not 0.0 <= wanted.distance <= MOST_DISTANCE:
            return f"a distance of {wanted.distance:g} m; give one from 0, for {USUAL_DISTANCE:g} m, to {MOST_DISTANCE:g} m"
        return ""

    def _goal_refusal(self, here: Pose2, wanted: GoalRequest) -> str:
        return NO_HEADING if isinf(wanted.yaw) else self._desk.refusal(here[:2], wanted.position)

    def _route_refusal(self, here: Pose2, wanted: RouteRequest) -> str:
        if wanted.kind not in KINDS:
            return f"there is no kind {wanted.kind} of routes; give one of {', '.join(KINDS.values())}"
        if not wanted.places:
            return "the route has no places"
        if wanted.HasField("yaw") and not isfinite(wanted.yaw):
            return "the heading is no number; give it in rad, or leave it out for any"
        for k, place in enumerate(wanted.places, start=1):
            if reason := self._desk.refusal(here[:2], place):
                return f"place {k} of {len(wanted.places)}: {reason}"
        return ""


def _answered(requests: Sequence[R], refusal: Callable[[R], str]) -> tuple[list[Reply], R | None]:
    """A reply to each, and the last that is not refused."""
    reasons = [refusal(request) for request in requests]
    taken = [request for request, reason in zip(requests, reasons, strict=True) if not reason]
    return [Reply(accepted=not reason, reason=reason) for reason in reasons], taken[-1] if taken else None


def _errand(route: RouteRequest) -> Errand:
    yaw = route.yaw if route.HasField("yaw") else None
    *before, last = [_point(place) for place in route.places]
    if route.kind == RouteRequest.THROUGH:
        return Errand("through", (Goal(last, yaw),), via=tuple(before))
    goals = (*(Goal(point) for point in before), Goal(last, yaw))
    return Errand(KINDS[route.kind], goals, repeats=route.kind == RouteRequest.PATROL)


def _point(place: Vector3) -> Point:
    return place.x, place.y
