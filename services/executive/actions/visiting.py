"""Places shared out among a team of ground vehicles, so that the last one is visited early."""

from collections.abc import Sequence
from math import inf

import numpy as np

from schemas.messages import PreviewRequest, Vector3
from services.executive.actions.action import Failed, first_refusal
from services.executive.actions.driving import RouteAction
from services.executive.asking import AGAIN, PATIENCE, PendingRequest
from services.executive.interface import SOURCE
from services.executive.situation import TeamSituation
from uvf.planning.assignment import assign

Point = tuple[float, float]
Start = Point | None


class VisitAction:
    """A team visits places: each planner says how long each way would take, then each vehicle drives its tour."""

    def __init__(self, vehicles: Sequence[str], places: Sequence[Point]) -> None:
        self._vehicles, self._places = vehicles, places
        self._tickets: dict[tuple[str, Start, Point], PendingRequest] = {}
        self._begun = 0.0
        self._routes: list[RouteAction] | None = None
        self.reason = ""

    def begin(self, now: TeamSituation) -> None:
        """Begins with asking for all ways."""
        self._routes, self.reason, self._begun = None, "asks how long the ways are", now.t
        starts: tuple[Start, ...] = (None, *self._places)
        self._tickets = {
            (vehicle, start, goal): now.desk.ask("preview", vehicle, preview_request(start, goal), patience=0.0)
            for vehicle in self._vehicles
            for start in starts
            for goal in self._places
            if start != goal
        }

    def step(self, now: TeamSituation) -> bool:
        """Whether all places have been visited. Raises Failed where one cannot be reached by anybody, or a tour fails."""
        if self._routes is None:
            if not all(ticket.accepted or ticket.refused for ticket in self._tickets.values()):
                return False
            routes = self._shared_out(now)
            if routes is None:
                return False
            for route in routes:
                route.begin(now)
            self._routes = routes
        done = [route for route in self._routes if route.step(now)]
        self._routes = [route for route in self._routes if route not in done]
        self.reason = "; ".join(f"{route.vehicle}: {route.reason}" for route in self._routes)
        return not self._routes

    @property
    def refusal(self) -> str:
        """Why a vehicle does not drive its tour."""
        return first_refusal(self._routes or ())

    def stop(self, now: TeamSituation) -> None:
        """Asks no more."""
        for ticket in self._tickets.values():
            now.desk.drop(ticket)
        for route in self._routes or ():
            route.stop(now)

    def _shared_out(self, now: TeamSituation) -> list[RouteAction] | None:
        """None where nobody can go somewhere yet: at first a rover has no map. Raises Failed where that stays so."""
        to_goals = np.array([[self._time(vehicle, None, goal) for goal in self._places] for vehicle in self._vehicles])
        between = np.array(
            [[[self._time(vehicle, start, goal) for goal in self._places] for start in self._places] for vehicle in self._vehicles]
        )
        found = assign(to_goals, between)
        if found.unreachable:
            goal = self._places[found.unreachable[0]]
            refused = [(key, ticket) for key, ticket in self._tickets.items() if ticket.refused]
            if now.t - self._begun >= PATIENCE:
                why = "; ".join(f"{vehicle}: {ticket.reason}" for (vehicle, start, to), ticket in refused if start is None and to == goal)
                raise Failed(f"nobody can go to ({goal[0]:g}, {goal[1]:g}): {why}")
            for key, ticket in refused:
                self._tickets[key] = now.desk.ask("preview", ticket.vehicle, ticket.message, patience=0.0, due=now.t + AGAIN)
            return None
        tours = zip(self._vehicles, found.tours, strict=True)
        return [RouteAction(vehicle, [self._places[goal] for goal in tour], "waypoints") for vehicle, tour in tours if tour]

    def _time(self, vehicle: str, start: Start, goal: Point) -> float:
        """s; infinite where there is no way."""
        if start == goal:
            return 0.0
        ticket = self._tickets[vehicle, start, goal]
        return float(ticket.reply.duration) if ticket.accepted else inf


def preview_request(start: Start, goal: Point) -> PreviewRequest:
    """What the way from ``start`` to ``goal`` [m, world] would be like; from where the vehicle is, without a start."""
    request = PreviewRequest(position=Vector3(x=goal[0], y=goal[1]), source=SOURCE)
    if start is not None:
        request.start.CopyFrom(Vector3(x=start[0], y=start[1]))
    return request
