"""Markers that are visited as they are found: who is free goes to the nearest one to which nobody goes."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, cos, dist, pi, sin

from schemas.messages import Mode
from services.executive.actions.action import EngageAction, Failed, first_refusal
from services.executive.actions.driving import GoalAction
from services.executive.actions.visiting import preview_request
from services.executive.asking import PendingRequest
from services.executive.situation import FoundMarker, TeamSituation

Point = tuple[float, float]

SIDES = 8
"""Places about a marker at which a vehicle may stop."""
SHUNNED = 20.0  # s, after which a marker that could not be reached is tried again: maps grow
MOVED = 0.5  # m that a marker may be elsewhere than was thought, before who goes there is sent anew
AWAY_FOR = 10.0  # s that all vehicles do something else, after which the task has failed


@dataclass
class _Visitor:
    """One vehicle, and the marker to which it goes."""

    engage: EngageAction
    is_engaged: bool = False
    marker: FoundMarker | None = None
    aim: Point = (0.0, 0.0)
    """Where the marker was taken to be."""
    places: list[Point] = field(default_factory=list)
    """Where it may stop, that have not been asked for yet."""
    ticket: PendingRequest | None = None
    goal: GoalAction | None = None
    shunned: list[tuple[FoundMarker, float]] = field(default_factory=list)
    """Markers that it could not reach, each until a time [s]."""
    lost: str = ""
    """Why it takes no part at all."""
    away_since: float | None = None
    """Since when [s] it does something else."""

    @property
    def takes_part(self) -> bool:
        """Whether it does what this task tells it."""
        return self.is_engaged and not self.lost and self.away_since is None

    @property
    def is_free(self) -> bool:
        """Whether it may be sent to a marker."""
        return self.takes_part and self.marker is None

    def drop(self, now: TeamSituation) -> None:
        """It goes to no marker any more."""
        now.desk.drop(self.ticket)
        if self.goal is not None:
            self.goal.stop(now)
        self.marker, self.ticket, self.goal, self.places = None, None, None, []


class VisitFoundAction:
    """Vehicles go to ``count`` markers that ``finders`` find; who has none to go to does its own job meanwhile.

    Who is taken over by somebody, or fails, leaves its marker to the others, and takes part again once it is back in mode Mission.
    """

    def __init__(self, vehicles: Sequence[str], finders: Sequence[str], count: int, near: float) -> None:
        self._vehicles, self._finders, self._count, self._near = vehicles, finders, count, near
        self._visitors: dict[str, _Visitor] = {}
        self._visited: list[FoundMarker] = []
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
            self._step_one(now, name, visitor)
            self._look_again(now, name, visitor, found)
            self._pass_by(now, name, visitor, found)
        self._share_out(now, found)
        self.reason = "; ".join([f"{len(self._visited)} of {self._count} visited, {len(found)} found", *self._headings(), *self._out()])
        if len(self._visited) >= self._count:
            self.stop(now)
            return True
        if all(v.lost or (v.away_since is not None and now.t - v.away_since >= AWAY_FOR) for v in self._visitors.values()):
            raise Failed("; ".join(self._out()))
        return False

    @property
    def refusal(self) -> str:
        """Why a vehicle takes no part."""
        return first_refusal(visitor.engage for visitor in self._visitors.values())

    def stop(self, now: TeamSituation) -> None:
        """Asks no more; who is under way to a marker stops."""
        for visitor in self._visitors.values():
            visitor.engage.stop(now)
            visitor.drop(now)

    def _step_one(self, now: TeamSituation, name: str, visitor: _Visitor) -> None:
        if visitor.lost or name not in now.now.status:  # a gap in what is heard of it says nothing
            return
        if not visitor.is_engaged:
            try:
                visitor.is_engaged = visitor.engage.step(now)
            except Failed as error:
                visitor.lost = str(error)
        elif now.mode(name) != Mode.MODE_MISSION or not now.is_armed(name):
            visitor.drop(now)
            visitor.away_since = now.t if visitor.away_since is None else visitor.away_since
        else:
            visitor.away_since = None
            if visitor.goal is not None and visitor.marker is not None:
                self._drive(now, visitor, visitor.goal, visitor.marker)
            elif visitor.marker is not None:
                self._ask(now, name, visitor, visitor.marker)

    def _look_again(self, now: TeamSituation, name: str, visitor: _Visitor, found: list[FoundMarker]) -> None:
        """Sends a vehicle anew that goes to a marker which it sees elsewhere than others have told."""
        going = visitor.marker
        seen = next((marker for marker in found if going is not None and marker.is_of(going)), None)
        here = now.place(name)
        if seen is not None and here is not None and dist(seen.place_for(name), visitor.aim) > MOVED:
            visitor.drop(now)
            self._send(name, visitor, seen, here[:2])

    def _pass_by(self, now: TeamSituation, name: str, visitor: _Visitor, found: list[FoundMarker]) -> None:
        """Who comes as near to a marker as it would stop has visited it, wherever it goes; nobody goes there any more."""
        here = now.place(name)
        if here is None or not visitor.takes_part:
            return
        for marker in found:
            if dist(here[:2], marker.place_for(name)) <= self._near and not any(marker.is_of(other) for other in self._visited):
                self._visited.append(marker)
                for other in self._visitors.values():
                    if other.marker is not None and marker.is_of(other.marker):
                        other.drop(now)

    def _headings(self) -> list[str]:
        going = [(name, visitor.marker.place) for name, visitor in self._visitors.items() if visitor.marker is not None]
        return [f"{name} goes to ({x:.0f}, {y:.0f})" for name, (x, y) in going]

    def _out(self) -> list[str]:
        """Why vehicles take no part now."""
        return [v.lost or f"{name} does something else" for name, v in self._visitors.items() if v.lost or v.away_since is not None]

    def _share_out(self, now: TeamSituation, found: list[FoundMarker]) -> None:
        """Markers to which nobody goes to those who are free, the shortest way first."""
        free = {name: place[:2] for name, v in self._visitors.items() if v.is_free and (place := now.place(name)) is not None}
        ways = sorted((dist(here, marker.place_for(name)), name, k) for name, here in free.items() for k, marker in enumerate(found))
        for _, name, k in ways:
            visitor, marker = self._visitors[name], found[k]
            visitor.shunned = [(other, until) for other, until in visitor.shunned if now.t < until]
            taken = [*self._visited, *(v.marker for v in self._visitors.values() if v.marker is not None)]
            left_out = [*taken, *(other for other, _ in visitor.shunned)]
            if visitor.marker is None and not any(marker.is_of(other) for other in left_out):
                self._send(name, visitor, marker, free[name])

    def _send(self, name: str, visitor: _Visitor, marker: FoundMarker, here: Point) -> None:
        visitor.marker, visitor.aim = marker, marker.place_for(name)
        visitor.places = self._about(visitor.aim, here)

    def _about(self, marker: Point, here: Point) -> list[Point]:
        """Places about a marker at which to stop, those on this side first."""
        side = atan2(here[1] - marker[1], here[0] - marker[0])
        turns = sorted((2 * pi * k / SIDES for k in range(SIDES)), key=lambda turn: min(turn, 2 * pi - turn))
        return [(marker[0] + self._near * cos(side + turn), marker[1] + self._near * sin(side + turn)) for turn in turns]

    def _ask(self, now: TeamSituation, name: str, visitor: _Visitor, marker: FoundMarker) -> None:
        """Asks for one place after the other, until there is a way."""
        ticket = visitor.ticket
        if ticket is None and not visitor.places:
            visitor.shunned.append((marker, now.t + SHUNNED))
            visitor.drop(now)
        elif ticket is None:
            visitor.ticket = now.desk.ask("preview", name, preview_request(None, visitor.places[0]), patience=0.0)
        elif ticket.accepted:
            visitor.goal, visitor.ticket = GoalAction(name, visitor.places[0], None), None
            visitor.goal.begin(now)
        elif ticket.refused:
            visitor.places, visitor.ticket = visitor.places[1:], None

    def _drive(self, now: TeamSituation, visitor: _Visitor, goal: GoalAction, marker: FoundMarker) -> None:
        try:
            there = goal.step(now)
        except Failed:
            visitor.shunned.append((marker, now.t + SHUNNED))
            visitor.drop(now)
            return
        if there:
            self._visited.append(marker)
            visitor.goal = None  # it is there: nothing is to be cancelled
            visitor.drop(now)
