"""Places that vehicles go to: goals, routes, and vehicles that they follow."""

from collections.abc import Sequence
from math import hypot, nan

from schemas.messages import CancelRequest, FollowRequest, GoalRequest, NavStatus, RouteRequest, Vector3
from services.executive.actions.action import EngagedAction, Failed, RequestAction
from services.executive.asking import CANCEL
from services.executive.interface import SOURCE
from services.executive.situation import TeamSituation

Point = tuple[float, float]

KINDS = {"waypoints": RouteRequest.WAYPOINTS, "through": RouteRequest.THROUGH, "patrol": RouteRequest.PATROL}
SAME = 0.05  # m, that a goal may differ by and still be the same
TAKEN_WITHIN = 3.0  # s, after which a planner that has accepted a goal says so in its status
SAME_HEIGHT = 1.0  # m, likewise
LEVEL = 8.0  # m beside its height, within which an aircraft is at its goal
CIRCLING = 1.5  # radii of the circle that an aircraft holds on, within which it is at its goal


class ErrandAction(EngagedAction):
    """Base of what the planner of a ground vehicle is asked for and reports on."""

    request = "goal"
    jobs: tuple[str, ...] = ("goal",)

    def __init__(self, vehicle: str) -> None:
        super().__init__(vehicle)
        self._taken = False
        self._accepted_at: float | None = None

    def begin(self, now: TeamSituation) -> None:
        """Begins anew: the vehicle is armed and told where to go."""
        super().begin(now)
        self._taken = False
        self._accepted_at = None
        now.given_up.pop(self.vehicle, None)

    def stop(self, now: TeamSituation) -> None:
        """Cancels what the vehicle does for this task; what somebody else has told it since is theirs."""
        was_asked = self._accepted_at is not None or (self._ticket is not None and self._ticket.asked_at is not None)
        super().stop(now)
        status = now.now.nav.get(self.vehicle)
        told_else = self._taken and (status is None or status.job not in self.jobs or not self._is_ours(status))
        if was_asked and not told_else:
            now.desk.ask(CANCEL, self.vehicle, CancelRequest(source=SOURCE), patience=0.0)

    def _carry_out(self, now: TeamSituation) -> bool:
        """Whether the vehicle is there. Raises Failed when the planner has given it up, or does something else."""
        if self._accepted_at is None:
            if self._accepted(now, self._ticket or now.desk.ask(self.request, self.vehicle, self._message())):
                self._accepted_at, self._ticket = now.t, None
            return False
        return self._followed(now, self._accepted_at)

    def _followed(self, now: TeamSituation, since: float) -> bool:
        status = now.now.nav.get(self.vehicle)
        if status is None:
            self.reason = f"nothing is heard of {self.vehicle}'s planner"
            return False
        if status.job in self.jobs and self._is_ours(status):
            self._taken = True
            self.reason = status.reason or f"{status.distance_left:.1f} m left"
            return self._is_done(status)
        if self._taken or now.t - since > TAKEN_WITHIN:
            raise Failed(f"{self.vehicle}: {now.given_up.get(self.vehicle) or _instead(status)}")
        return False

    def _message(self) -> GoalRequest | RouteRequest | FollowRequest:
        raise NotImplementedError

    def _is_ours(self, status: NavStatus) -> bool:
        return True

    def _is_done(self, status: NavStatus) -> bool:
        return status.state == NavStatus.REACHED


def _instead(status: NavStatus) -> str:
    """What a vehicle does that was told so by somebody else."""
    if status.job == "goal":
        return f"somebody else has sent it to ({status.goal.x:g}, {status.goal.y:g})"
    if status.job == "follow":
        return f"somebody else has told it to follow {status.follow.vehicle}"
    return f"somebody else has told it: {status.job or 'nothing'}"


class GoalAction(ErrandAction):
    """A ground vehicle drives to a place."""

    def __init__(self, vehicle: str, point: Point, yaw: float | None) -> None:
        super().__init__(vehicle)
        self._point, self._yaw = point, yaw

    def _message(self) -> GoalRequest:
        x, y = self._point
        return GoalRequest(position=Vector3(x=x, y=y), yaw=nan if self._yaw is None else self._yaw, source=SOURCE)

    def _is_ours(self, status: NavStatus) -> bool:
        return abs(status.goal.x - self._point[0]) <= SAME and abs(status.goal.y - self._point[1]) <= SAME


class RouteAction(ErrandAction):
    """A ground vehicle drives to several places."""

    request = "route"

    def __init__(self, vehicle: str, places: Sequence[Point], kind: str) -> None:
        super().__init__(vehicle)
        self.jobs = (kind,)
        self._places, self._kind = places, kind

    def _message(self) -> RouteRequest:
        return RouteRequest(places=[Vector3(x=x, y=y) for x, y in self._places], kind=KINDS[self._kind], source=SOURCE)

    def _is_ours(self, status: NavStatus) -> bool:
        return len(status.route.places) == len(self._places)

    def _is_done(self, status: NavStatus) -> bool:
        last = self._kind == "through" or status.route_at == len(self._places) - 1
        return self._kind != "patrol" and last and status.state == NavStatus.REACHED


class FollowAction(ErrandAction):
    """A ground vehicle drives behind another one, until it is stopped."""

    request = "follow"
    jobs = ("follow",)

    def __init__(self, vehicle: str, leader: str, distance: float) -> None:
        super().__init__(vehicle)
        self._leader, self._distance = leader, distance

    def _message(self) -> FollowRequest:
        return FollowRequest(vehicle=self._leader, distance=self._distance, source=SOURCE)

    def _is_done(self, status: NavStatus) -> bool:
        return False


class FlyToAction(RequestAction):
    """An aircraft flies to a place and circles there."""

    def __init__(self, vehicle: str, place: tuple[float, float, float]) -> None:
        super().__init__(vehicle)
        self._place = place
        self._is_taken = False

    def begin(self, now: TeamSituation) -> None:
        """Begins with asking for it."""
        super().begin(now)
        self._is_taken = False

    def step(self, now: TeamSituation) -> bool:
        """Whether it circles there, at its height. Raises Failed when the goal is refused, or too low for it."""
        if not self._is_taken:
            x, y, z = self._place
            message = GoalRequest(position=Vector3(x=x, y=y, z=z), yaw=nan, source=SOURCE)
            self._is_taken = self._accepted(now, self._ticket or now.desk.ask("goal", self.vehicle, message))
            return False
        status, here = now.now.status.get(self.vehicle), now.place(self.vehicle)
        if status is None or here is None:
            return False
        x, y, z = self._place
        distance, climb = hypot(here[0] - x, here[1] - y), z - here[2]
        self.reason = f"{distance:.0f} m left, {abs(climb):.0f} m to {'climb' if climb > 0 else 'descend'}"
        if not status.HasField("circle"):
            return False
        circle = status.circle
        if abs(circle.centre.z - z) > SAME_HEIGHT and hypot(circle.centre.x - x, circle.centre.y - y) <= SAME_HEIGHT:
            raise Failed(f"{self.vehicle}: {z:g} m is too low for it; it holds at {circle.centre.z:.0f} m")
        return distance <= CIRCLING * abs(circle.radius) and abs(climb) <= LEVEL
