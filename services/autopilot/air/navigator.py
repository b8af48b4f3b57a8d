"""Flies a plan item by item: legs, the corners between them, orbits; and keeps count."""

import math
from collections.abc import Sequence

from services.autopilot.air import corners
from services.autopilot.air.guidance import Aim
from services.autopilot.air.params import AirParams
from services.autopilot.air.plan import NO_JUMPS, Item, Kind, Stop, next_stop
from services.autopilot.air.route import Circle, Leg, Level, Place, Turn
from services.autopilot.air.state import Estimate
from uvf.maths.geodesy import GRAVITY

REPLANNED = 1.0  # s, after which a corner ahead is planned for the wind known by then
SETTLED = 2.0  # s before a corner begins, from where on it stays as it is
LEAVING = 0.6  # of a leg, for the corner at its beginning at most; it needs more than that at its end
TIGHTEST_ORBIT = 0.6  # of the radius at turn_bank; smaller wishes are widened to that


class Navigator:
    """``index`` is the item flown towards, None before the start and after the end."""

    def __init__(self, items: Sequence[Item]) -> None:
        self.items = tuple(items)
        self.index: int | None = None
        self.reached = -1
        self.laps = 0
        self.speed = 0.0  # m/s, 0 = cruise
        self.finished = False
        self._jumps = NO_JUMPS
        self._piece: Leg | Turn | Circle | None = None
        self._planned = 0.0  # s ago
        self._bearing: float | None = None
        self._turned = 0.0  # rad, on the circle
        self._held = 0.0  # s, on the circle

    def jump_to(self, index: int) -> None:
        """Goes on with this item from wherever the aircraft is."""
        self._take(next_stop(self.items, index, self._jumps))
        self.finished = self.index is None
        self._piece = None

    def resume(self) -> None:
        """Starts, or goes on with the item that was left, from wherever the aircraft is."""
        self.jump_to(0 if self.index is None else self.index)

    def take_up(self, index: int | None, reached: int, laps: int, finished: bool) -> None:
        """Stands where another navigator of the same items has stood; jumps are counted anew."""
        self.index, self.reached, self.laps, self.finished = index, reached, laps, finished

    @property
    def returns_home(self) -> bool:
        return self.index is not None and self.items[self.index].kind is Kind.RETURN

    @property
    def target(self) -> Item | None:
        return self.items[self.index] if self.index is not None else None

    def step(self, now: Estimate, params: AirParams, dt: float) -> tuple[Aim, Level]:
        """Aim and height towards the current item; call it only while there is one that is not RETURN."""
        if self._piece is None:
            here = Place(now.north, now.east, now.height)
            self._piece = self._towards(here, None, now, params)
        self._replan(now, params, dt)
        self._advance(now, params, dt)
        piece = self._piece
        return piece.aim(now, params), piece.level(now)

    def _replan(self, now: Estimate, params: AirParams, dt: float) -> None:
        """The corner at the end of this leg, for the wind as it is known now."""
        self._planned += dt
        piece = self._piece
        if self._planned < REPLANNED or not isinstance(piece, Leg) or piece.exit is None:
            return
        self._planned = 0.0
        if piece.length - piece.exit.before - piece.progress((now.north, now.east)) > SETTLED * now.ground_speed:
            self._piece = self._towards(piece.start, piece.entry, now, params)

    def _advance(self, now: Estimate, params: AirParams, dt: float) -> None:
        """Changes to the next piece where this one ends; the last item stays aimed at."""
        piece, position = self._piece, (now.north, now.east)
        if isinstance(piece, Turn) and piece.is_flown(position):
            self._piece = piece.onto
        elif (isinstance(piece, Leg) and piece.is_flown(position)) or (isinstance(piece, Circle) and self._circled(piece, now, dt)):
            self._leave(piece, now, params)

    def _leave(self, piece: Leg | Circle, now: Estimate, params: AirParams) -> None:
        assert self.index is not None
        self.reached = self.index
        stop = next_stop(self.items, self.index + 1, self._jumps)
        self.laps += stop.laps
        if stop.index is None:
            self.finished = True
            return
        self._take(stop)
        if self.returns_home:
            return
        if isinstance(piece, Circle):
            self._piece = self._towards(Place(now.north, now.east, piece.centre.height), None, now, params)
            return
        onto = self._towards(piece.end, piece.exit, now, params)
        self._piece = Turn(piece.exit, piece, onto) if piece.exit is not None and isinstance(onto, Leg) else onto

    def _take(self, stop: Stop) -> None:
        self.index, self._jumps = stop.index, stop.jumps
        self.speed = stop.speed or self.speed
        self._bearing, self._turned, self._held = None, 0.0, 0.0

    def _towards(self, start: Place, entry: corners.Corner | None, now: Estimate, params: AirParams) -> Leg | Circle:
        """The piece from ``start`` to the current item, with the corner at its end when one follows."""
        assert self.index is not None
        item = self.items[self.index]
        if not item.flies_through:
            return Circle(item.place, self._orbit_radius(item, params))
        leg = Leg(start, item.place, entry)
        stop = next_stop(self.items, self.index + 1, self._jumps)
        if stop.index is None or not self.items[stop.index].flies_through:
            return leg
        after = Leg(item.place, self.items[stop.index].place)
        room = (leg.length - (entry.after if entry is not None else 0.0), LEAVING * after.length)
        wind = (now.wind_north, now.wind_east)
        flying = corners.Flying(self.speed or params.trim_airspeed, wind, params.turn_bank)
        return Leg(start, item.place, entry, corners.plan(item.place.point, (leg.course, after.course), flying, room))

    def _orbit_radius(self, item: Item, params: AirParams) -> float:
        wanted = item.radius or params.hold_radius
        tightest = TIGHTEST_ORBIT * params.trim_airspeed**2 / (GRAVITY * math.tan(params.turn_bank))
        return math.copysign(max(abs(wanted), tightest), wanted)

    def _circled(self, circle: Circle, now: Estimate, dt: float) -> bool:
        """Whether the turns or the time on this circle are complete; neither given = never."""
        assert self.index is not None
        item = self.items[self.index]
        if self._bearing is None and not circle.is_captured(now):
            return False
        bearing = circle.bearing(now)
        if self._bearing is not None:
            self._turned += abs(math.remainder(bearing - self._bearing, math.tau))
            self._held += dt
        self._bearing = bearing
        if item.kind is Kind.ORBIT:
            return item.turns > 0 and self._turned >= math.tau * item.turns
        return self._held >= item.hold
