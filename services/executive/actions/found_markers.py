"""Markers that are visited as they are found, shared out so that the last one is visited early."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import dist, inf
from statistics import median

import numpy as np

from schemas.messages import Mode
from services.executive.actions.action import EngageAction, Failed, first_refusal
from services.executive.actions.approaching import MarkerApproach
from services.executive.actions.driving import GoalAction
from services.executive.situation import FoundMarker, TeamSituation
from uvf.planning.assignment import assign

Point = tuple[float, float]

SHUNNED = 10.0  # s, after which a marker that could not be reached is tried again: maps grow
AGAIN = 3.0  # s, after which it is asked again who goes where, while somebody is free
LOOKED_AT = 12
"""Markers that a vehicle's planner is asked for at once, the nearest ones."""
PACE = 2.0  # s/m, while no planner has told how long a way takes
MOVED = 0.5  # m that a marker may be elsewhere than was thought, before who goes there is sent anew
AWAY_FOR = 10.0  # s that all vehicles do something else, after which the task has failed


@dataclass
class _Visitor:
    """One vehicle, and the marker to which it goes."""

    engage: EngageAction
    is_engaged: bool = False
    way: MarkerApproach | None = None
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
        return self.takes_part and self.way is None

    def goes_to(self, marker: FoundMarker) -> bool:
        """Whether it is on its way to a marker."""
        return self.way is not None and marker.is_of(self.way.marker)

    def shun(self, marker: FoundMarker, t: float) -> None:
        """It could not reach a marker at ``t`` [s]; what it shuns no more is forgotten."""
        self.shunned = [(other, until) for other, until in self.shunned if t < until] + [(marker, t + SHUNNED)]

    def shuns(self, marker: FoundMarker, t: float) -> bool:
        """Whether it could not reach a marker a short while ago."""
        return any(t < until and marker.is_of(other) for other, until in self.shunned)

    def send(self, now: TeamSituation, way: MarkerApproach, place: Point) -> None:
        """It goes to a marker, and stops at ``place``."""
        self.way, self.goal = way, GoalAction(way.vehicle, place, None)
        self.goal.begin(now)

    def drop(self, now: TeamSituation) -> None:
        """It goes to no marker any more."""
        if self.goal is not None:
            self.goal.stop(now)
        self.way, self.goal = None, None


class VisitFoundAction:
    """Vehicles go to ``count`` markers that ``finders`` find; who has none to go to does its own job meanwhile.

    Who is taken over by somebody, or fails, leaves its marker to the others, and takes part again once it is back in mode Mission.
    """

    def __init__(self, vehicles: Sequence[str], finders: Sequence[str], count: int, near: float) -> None:
        self._vehicles, self._finders, self._count, self._near = vehicles, finders, count, near
        self._visitors: dict[str, _Visitor] = {}
        self._visited: list[FoundMarker] = []
        self._ways: list[MarkerApproach] = []
        """Those that are being asked for."""
        self._again = 0.0
        self.reason = ""

    def begin(self, now: TeamSituation) -> None:
        """Begins with nothing visited."""
        self._visited, self._ways, self._again = [], [], 0.0
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
        for way in self._ways:
            way.drop(now)
        self._ways = []
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
            if visitor.goal is not None and visitor.way is not None:
                self._drive(now, visitor, visitor.goal, visitor.way.marker)

    def _look_again(self, now: TeamSituation, name: str, visitor: _Visitor, found: list[FoundMarker]) -> None:
        """Who sees the marker to which it goes elsewhere than others have told is sent anew."""
        seen = next((marker for marker in found if visitor.goes_to(marker)), None)
        if seen is not None and visitor.way is not None and dist(seen.place_for(name), visitor.way.aim) > MOVED:
            visitor.drop(now)

    def _pass_by(self, now: TeamSituation, name: str, visitor: _Visitor, found: list[FoundMarker]) -> None:
        """Who comes as near to a marker as it would stop has visited it, wherever it goes; nobody goes there any more."""
        here = now.place(name)
        if here is None or not visitor.takes_part:
            return
        for marker in found:
            if dist(here[:2], marker.place_for(name)) <= self._near and not self._is_visited(marker):
                self._visited.append(marker)
                for other in self._visitors.values():
                    if other.goes_to(marker):
                        other.drop(now)

    def _headings(self) -> list[str]:
        going = [(name, visitor.way.marker.place) for name, visitor in self._visitors.items() if visitor.way is not None]
        return [f"{name} goes to ({x:.0f}, {y:.0f})" for name, (x, y) in going]

    def _out(self) -> list[str]:
        """Why vehicles take no part now."""
        return [v.lost or f"{name} does something else" for name, v in self._visitors.items() if v.lost or v.away_since is not None]

    def _share_out(self, now: TeamSituation, found: list[FoundMarker]) -> None:
        """Asks the planners of who is free for the ways to markers to which nobody goes, and then sends each to the first of its own."""
        wanted = [way for way in self._ways if self._visitors[way.vehicle].is_free and self._is_open(way.marker)]
        for way in self._ways:
            if way not in wanted:
                way.drop(now)
        self._ways = wanted
        if not self._ways and now.t >= self._again:
            self._ways = self._new_ways(now, [marker for marker in found if self._is_open(marker)])
        known = [way.step(now) for way in self._ways]
        if self._ways and all(known):
            self._again = now.t if self._send(now) else now.t + AGAIN
            self._ways = []

    def _is_visited(self, marker: FoundMarker) -> bool:
        return any(marker.is_of(other) for other in self._visited)

    def _is_open(self, marker: FoundMarker) -> bool:
        """Whether nobody has been there, and nobody goes there."""
        return not self._is_visited(marker) and not any(visitor.goes_to(marker) for visitor in self._visitors.values())

    def _new_ways(self, now: TeamSituation, markers: list[FoundMarker]) -> list[MarkerApproach]:
        ways = []
        for name, visitor in self._visitors.items():
            here = now.place(name)
            if visitor.is_free and here is not None:
                new = [MarkerApproach(name, marker, self._near, here[:2]) for marker in markers if not visitor.shuns(marker, now.t)]
                ways += sorted(new, key=lambda way: dist(way.here, way.aim))[:LOOKED_AT]
        return ways

    def _send(self, now: TeamSituation) -> bool:
        """By tours over all that is open, of who is under way, too, from where it goes: it may be sooner there than who is free.

        Returns whether anybody was sent.
        """
        markers: list[FoundMarker] = []
        for way in self._ways:
            if way.place is None:
                self._visitors[way.vehicle].shun(way.marker, now.t)
            elif not any(way.marker.is_of(other) for other in markers):
                markers.append(way.marker)
        if not markers:
            return False
        names = [name for name, visitor in self._visitors.items() if visitor.takes_part and now.place(name) is not None]
        asked = [(way, dist(way.here, way.place)) for way in self._ways if way.place is not None]
        pace = median([way.duration / length for way, length in asked if length > self._near] or [PACE])
        between = pace * np.array([[dist(a.place, b.place) for b in markers] for a in markers])
        to_markers = np.array([[self._time(now, name, marker, pace) for marker in markers] for name in names])
        sent = False
        for name, tour in zip(names, assign(to_markers, between).tours, strict=True):
            first = self._way(name, markers[tour[0]]) if tour else None
            if first is not None and first.place is not None:
                self._visitors[name].send(now, first, first.place)
                sent = True
        return sent

    def _way(self, name: str, marker: FoundMarker) -> MarkerApproach | None:
        return next((way for way in self._ways if way.vehicle == name and marker.is_of(way.marker)), None)

    def _time(self, now: TeamSituation, name: str, marker: FoundMarker, pace: float) -> float:
        """s until a vehicle could be at a marker."""
        under_way, here = self._visitors[name].way, now.place(name)
        if under_way is not None and here is not None:
            return pace * (dist(here[:2], under_way.aim) + dist(under_way.aim, marker.place))
        way = self._way(name, marker)
        return way.duration if way is not None else inf

    def _drive(self, now: TeamSituation, visitor: _Visitor, goal: GoalAction, marker: FoundMarker) -> None:
        try:
            there = goal.step(now)
        except Failed:
            visitor.shun(marker, now.t)
            visitor.drop(now)
            return
        if there:
            self._visited.append(marker)
            visitor.goal = None  # it is there: nothing is to be cancelled
            visitor.drop(now)
