"""The way of one vehicle to one marker: its planner tells on which side it can stop, and how long it takes to get there."""

from math import atan2, cos, inf, pi, sin

from services.executive.actions.visiting import preview_request
from services.executive.asking import PendingRequest
from services.executive.situation import FoundMarker, TeamSituation

Point = tuple[float, float]

SIDES = 8
"""Places about a marker at which a vehicle may stop."""


class MarkerApproach:
    """Asks for one side after the other, that on which the vehicle is first, until there is a way."""

    def __init__(self, vehicle: str, marker: FoundMarker, near: float, here: Point) -> None:
        """near [m]: how far from the marker it would stop; here [m, world]: where it is."""
        self.vehicle, self.marker, self.here = vehicle, marker, here
        self.aim = marker.place_for(vehicle)
        """Where the marker is taken to be [m, world]."""
        self.place: Point | None = None
        """Where it can stop [m, world]; None where it cannot, or nothing is known yet."""
        self.duration = inf
        """s, of the way there."""
        self._places = _about(self.aim, here, near)
        self._ticket: PendingRequest | None = None

    def step(self, now: TeamSituation) -> bool:
        """Whether it is known."""
        ticket = self._ticket
        if ticket is not None and ticket.accepted and 0.0 <= ticket.reply.duration < inf:
            self.place, self.duration, self._ticket = self._places[0], float(ticket.reply.duration), None
        elif ticket is not None and (ticket.accepted or ticket.refused):
            self._places, self._ticket = self._places[1:], None
        if self._ticket is None and self.place is None and self._places:
            self._ticket = now.desk.ask("preview", self.vehicle, preview_request(None, self._places[0]), patience=0.0)
        return self._ticket is None

    def drop(self, now: TeamSituation) -> None:
        """Asks no more."""
        now.desk.drop(self._ticket)


def _about(marker: Point, here: Point, near: float) -> list[Point]:
    """Places about a marker at which to stop, those on this side first."""
    side = atan2(here[1] - marker[1], here[0] - marker[0])
    turns = sorted((2 * pi * k / SIDES for k in range(SIDES)), key=lambda turn: min(turn, 2 * pi - turn))
    return [(marker[0] + near * cos(side + turn), marker[1] + near * sin(side + turn)) for turn in turns]
