"""Markers that are visited as they are found: who is free goes to the nearest one to which nobody goes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, cos, dist, pi, sin

from schemas.messages import Mode, PreviewRequest, Vector3
from services.executive.actions.action import EngageAction, Failed
from services.executive.actions.driving import GoalAction
from services.executive.asking import PendingRequest
from services.executive.interface import SOURCE
from services.executive.situation import SAME_MARKER, TeamSituation

Point = tuple[float, float]

SIDES = 8
"""Places about a marker at which a vehicle may stop."""
SHUNNED = 20.0  # s, after which a marker that could not be reached is tried again: maps grow


@dataclass
class _Visitor:
    """One vehicle, and the marker to which it goes."""

    engage: EngageAction
    is_engaged: bool = False
    marker: Point | None = None
    places: list[Point] = field(default_factory=list)
    """Where it may stop, that have not been asked for yet."""
    ticket: PendingRequest | None = None
    goal: GoalAction | None = None
    shunned: list[tuple[Point, float]] = field(default_factory=list)
    """Markers that it could not reach, each until a time [s]."""
    why_out: str = ""
    """Why it goes to no marker any more; "" while it does."""

    def drop(self) -> None:
        """It goes to no marker any more."""
        self.marker, self.ticket, self.goal, self.places = None, None, None, []


class VisitFoundAction:
    """Vehicles go to ``count`` markers that ``finders`` find; who has none to go to does its own job meanwhile."""

    def __init__(self, vehicles: Sequence[str], finders: Sequence[str], count: int, near: float) -> None:
        self._vehicles, self._finders, self._count, self._near = vehicles, finders, count, near
        self._visitors: dict[str, _Visitor] = {}
        self._visited: list[Point] = []
        self.reason = ""

    def begin(self, now: TeamSituation) -> None:
        """Begins with nothing visited."""
        self._visited = []
        self._visitors = {name: _Visitor(EngageAction(name, Mode.MODE_MISSION)) for name in self._vehicles}
        for visitor in self._visitors.values():
            visitor.engage.begin(now)

    def step(self, now: TeamSituation) -> bool:
        """Whether so many markers have been visited. Raises Failed when no vehicle is left that could."""
        found = now.found(self._finders)
        for name, visitor in self._visitors.items():
            if visitor.why_out:
                continue
            if not visitor.is_engaged:
                self._engage(now, visitor)
            elif now.mode(name) != Mode.MODE_MISSION or not now.is_armed(name):
                self._leave_out(now, visitor, f"{name} does something else")
            elif visitor.goal is not None:
                self._drive(now, visitor, visitor.goal)
            elif visitor.marker is not None:
                self._ask(now, name, visitor, visitor.marker)
        self._share_out(now, found)
        out = [visitor.why_out for visitor in self._visitors.values() if visitor.why_out]
        if len(out) == len(self._visitors):
            raise Failed("; ".join(out))
        heading = [f"{name} goes to ({v.marker[0]:.0f}, {v.marker[1]:.0f})" for name, v in self._visitors.items() if v.marker is not None]
        self.reason = "; ".join([f"{len(self._visited)} of {self._count} visited, {len(found)} found", *heading, *out])
        return len(self._visited) >= self._count

    def stop(self, now: TeamSituation) -> None:
        """Asks no more."""
        for visitor in self._visitors.values():
            visitor.engage.stop(now)
            now.desk.drop(visitor.ticket)
            if visitor.goal is not None:
                visitor.goal.stop(now)

    def _share_out(self, now: TeamSituation, found: list[Point]) -> None:
        """Markers to which nobody goes to those who are free, the shortest way first."""
        free = {name: place[:2] for name, v in self._visitors.items() if self._is_free(v) and (place := now.place(name)) is not None}
        ways = sorted((dist(here, marker), name, marker) for name, here in free.items() for marker in found)
        for _, name, marker in ways:
            visitor = self._visitors[name]
            taken = [*self._visited, *(v.marker for v in self._visitors.values() if v.marker is not None)]
            shunned = [point for point, until in visitor.shunned if now.t < until]
            if visitor.marker is None and all(dist(marker, other) > SAME_MARKER for other in (*taken, *shunned)):
                visitor.marker, visitor.places = marker, self._about(marker, free[name])

    @staticmethod
    def _is_free(visitor: _Visitor) -> bool:
        return visitor.is_engaged and not visitor.why_out and visitor.marker is None

    @staticmethod
    def _engage(now: TeamSituation, visitor: _Visitor) -> None:
        try:
            visitor.is_engaged = visitor.engage.step(now)
        except Failed as error:
            visitor.why_out = str(error)

    @staticmethod
    def _leave_out(now: TeamSituation, visitor: _Visitor, why: str) -> None:
        """Somebody else has taken over, or the vehicle has failed: its marker is for the others."""
        if visitor.goal is not None:
            visitor.goal.stop(now)
        now.desk.drop(visitor.ticket)
        visitor.drop()
        visitor.why_out = why

    def _about(self, marker: Point, here: Point) -> list[Point]:
        """Places about a marker at which to stop, those on this side first."""
        side = atan2(here[1] - marker[1], here[0] - marker[0])
        turns = sorted((2 * pi * k / SIDES for k in range(SIDES)), key=lambda turn: min(turn, 2 * pi - turn))
        return [(marker[0] + self._near * cos(side + turn), marker[1] + self._near * sin(side + turn)) for turn in turns]

    def _ask(self, now: TeamSituation, name: str, visitor: _Visitor, marker: Point) -> None:
        """Asks for one place after the other, until there is a way."""
        ticket = visitor.ticket
        if ticket is None and not visitor.places:
            visitor.shunned.append((marker, now.t + SHUNNED))
            visitor.drop()
        elif ticket is None:
            x, y = visitor.places[0]
            request = PreviewRequest(position=Vector3(x=x, y=y), source=SOURCE)
            visitor.ticket = now.desk.ask("preview", name, request, patience=0.0)
        elif ticket.accepted:
            visitor.goal, visitor.ticket = GoalAction(name, visitor.places[0], None), None
            visitor.goal.begin(now)
        elif ticket.refused:
            visitor.places, visitor.ticket = visitor.places[1:], None

    def _drive(self, now: TeamSituation, visitor: _Visitor, goal: GoalAction) -> None:
        marker = visitor.marker
        assert marker is not None
        try:
            there = goal.step(now)
        except Failed:
            visitor.shunned.append((marker, now.t + SHUNNED))
            goal.stop(now)
            visitor.drop()
            return
        if there:
            self._visited.append(marker)
            visitor.drop()
