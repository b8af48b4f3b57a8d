"""Flies a plan item by item: legs, the corners between them, orbits; and keeps count."""

import math
from collections.abc import Sequence

from uvf.estimation.state import Estimate
from uvf.guidance.approach import Approach, laid_down
from uvf.guidance.camera_trigger import CameraTrigger
from uvf.guidance.corners import Corner
from uvf.guidance.flight_plan import NO_JUMPS, OFF_PATH, ItemKind, NextItem, PlanItem, following, next_stop
from uvf.guidance.route import AltitudeProfile, Circle, Curve, Leg, Place, Turn
from uvf.guidance.route_planning import PathStart, RoutePlanner
from uvf.guidance.vector_field import PathReference
from uvf.models.vehicle.flight_params import AirParams

Piece = Leg | Turn | Curve | Circle

REPLANNED = 1.0  # s, after which what comes at the end of a piece is planned for the wind known by then
SETTLED = 2.0  # s before that begins, from where on it stays as it is
KNOWN = 4.0  # s before a curve ends, from where on what follows it is known
ANOTHER_WIND = 1.0  # m/s, of change, for which curves are planned anew
LEVELLED = 2.0  # m, from the altitude that a circle is to reach


class PlanFollower:
    """Flies a mission. ``index`` is the item flown towards, None before the start and after the end."""

    def __init__(self, items: Sequence[PlanItem]) -> None:
        self.items = tuple(items)
        self.index: int | None = None
        self.reached = -1
        self.laps = 0
        self.speed = 0.0  # m/s, 0 = cruise
        self.finished = False
        self._jumps = NO_JUMPS
        self._piece: Piece | None = None
        self._planned = 0.0  # s ago
        self._wind = 0.0, 0.0  # m/s, of the latest plan
        self.camera = CameraTrigger()
        self.homes: list[PlanItem] = []
        """Passed, and not yet carried out: that is the pilot's."""
        self._bearing: float | None = None
        self._turned = 0.0  # rad, on the circle
        self._held = 0.0  # s, on the circle

    def jump_to(self, index: int) -> None:
        """Goes on with the item at ``index`` from wherever the aircraft is."""
        self.speed = self._speed_at(index)
        self._take(next_stop(self.items, index, self._jumps))
        self.finished = self.index is None
        self._piece = None

    def resume(self) -> None:
        """Starts, or goes on with the item that was left, from wherever the aircraft is."""
        self.jump_to(0 if self.index is None else self.index)

    def take_up(self, index: int | None, reached: int, laps: int, finished: bool) -> None:
        """Takes over the progress of another follower of the same items; jumps are counted anew."""
        self.index, self.reached, self.laps, self.finished = index, reached, laps, finished
        self.speed = self._speed_at(index or 0)

    def _speed_at(self, index: int) -> float:
        """m/s, that the items before this one ask for; 0 = cruise."""
        return next((item.speed for item in reversed(self.items[:index]) if item.kind is ItemKind.SPEED), 0.0)

    def pass_item(self) -> None:
        """Marks the current item, one that is not flown along legs and circles, as done."""
        assert self.index is not None
        self.reached = self.index
        stop = next_stop(self.items, self.index + 1, self._jumps)
        self.laps += stop.laps
        self._take(stop)
        self.finished, self._piece = self.index is None, None

    def approach(self, params: AirParams) -> Approach | None:
        """The approach that the mission prescribes for the landing that is the current item, if it does."""
        return laid_down(self.items, self.index, params) if self.index is not None else None

    @property
    def corner(self) -> tuple[int, bool] | None:
        """The waypoint at the end of this leg, if it is one to be rounded, and whether there is room for a corner round it."""
        piece = self._piece
        if not isinstance(piece, Leg) or piece.exit is None or self.index is None:
            return None
        then = following(self.items, self._stop).index
        is_drawn = then is not None and self.items[then].flies_through and self.items[then].course is None
        return (self.index, isinstance(piece.exit, Corner)) if is_drawn else None

    @property
    def returns_home(self) -> bool:
        """Whether the current item is a return."""
        return self.index is not None and self.items[self.index].kind is ItemKind.RETURN

    @property
    def _off_path(self) -> bool:
        return self.index is not None and self.items[self.index].kind in OFF_PATH

    @property
    def target(self) -> PlanItem | None:
        """The current item, None before the start and after the end."""
        return self.items[self.index] if self.index is not None else None

    def step(self, now: Estimate, params: AirParams, dt: float) -> tuple[PathReference, AltitudeProfile]:
        """Path reference and altitude profile towards the current item, ``dt`` [s] after the last step.

        Only while there is a current item that is flown along a path.
        """
        if self._piece is None:
            self._piece = self._from_here(now, params)
        self._replan(now, params, dt)
        self._advance(now, params, dt)
        self.camera.step((now.north, now.east))
        piece = self._piece
        return piece.aim(now, params), piece.level(now)

    def curve_ahead(self) -> list[Place]:
        """Places about every 10 m along what is left of a curve to the current item; empty on other pieces."""
        piece = self._piece
        if not isinstance(piece, Curve) or not piece.ends_at_item:
            return []
        count = max(int(piece.left / 10.0), 1)
        lengths = [piece.s + k * piece.left / count for k in range(count)]
        return [piece.place(s) for s in lengths]

    def _from_here(self, now: Estimate, params: AirParams, circle: Circle | None = None) -> Piece:
        """circle: that it leaves."""
        target = self.target
        turns = circle is not None or (target is not None and (target.course is not None or not target.flies_through))
        begin = PathStart(now.course, 1 / circle.radius if circle is not None else 0.0) if turns else None
        return self._planner(now, params).towards(self._stop, Place(now.north, now.east, now.height), begin)

    def _planner(self, now: Estimate, params: AirParams, speed: float | None = None) -> RoutePlanner:
        """speed: m/s, 0 = cruise, None = that of now."""
        self._wind = now.wind_north, now.wind_east
        return RoutePlanner(self.items, params, self._wind, (self.speed if speed is None else speed) or params.trim_airspeed)

    @property
    def _stop(self) -> NextItem:
        """Where it flies to now."""
        return NextItem(self.index, self._jumps, 0, None)

    def _replan(self, now: Estimate, params: AirParams, dt: float) -> None:
        """What comes at the end of this piece, for the wind as it is known now."""
        self._planned += dt
        piece, settled = self._piece, SETTLED * now.ground_speed
        if self._planned < REPLANNED:
            return
        self._planned = 0.0
        if isinstance(piece, Curve):
            self._replan_curve(piece, now, params)
        elif isinstance(piece, Leg) and piece.exit is not None:
            left = piece.length - piece.exit.before - piece.progress((now.north, now.east))
            if left > settled and (isinstance(piece.exit, Corner) or self._wind_turned(now)):
                self._piece = self._planner(now, params).with_exit(piece, self._stop)

    def _replan_curve(self, piece: Curve, now: Estimate, params: AirParams) -> None:
        """What follows is planned before it begins; a straight part of it is left for a new way when the wind is another."""
        if piece.onto is None and piece.left < KNOWN * now.ground_speed:
            stop = self._stop
            for _ in piece.passing[piece.passed :]:
                stop = following(self.items, stop)
            if stop.index is not None and self.items[stop.index].kind not in OFF_PATH:
                piece.onto = self._planner(now, params, stop.speed).towards(stop, piece.end, PathStart(float(piece.way.course[-1])))
        elif piece.left > SETTLED * now.ground_speed and self._wind_turned(now) and piece.is_straight and piece.ends_at_item:
            north, east, course = piece.here
            self._piece = self._planner(now, params).towards(self._stop, Place(north, east, piece.level(now).height), PathStart(course))

    def _wind_turned(self, now: Estimate) -> bool:
        return math.hypot(now.wind_north - self._wind[0], now.wind_east - self._wind[1]) > ANOTHER_WIND

    def _advance(self, now: Estimate, params: AirParams, dt: float) -> None:
        """Changes to the next piece where this one ends; the last item stays aimed at."""
        piece, position = self._piece, (now.north, now.east)
        if isinstance(piece, Curve):
            self._advance_curve(piece, now, params)
        elif isinstance(piece, Turn):
            self._piece = piece.onto if piece.is_flown(position) else piece
        elif isinstance(piece, Leg) and piece.is_flown(position):
            if isinstance(piece.exit, Curve):
                self._piece = piece.exit
            else:
                self._leave(piece, now, params)
        elif isinstance(piece, Circle) and self._circled(piece, now, dt):
            self._leave(piece, now, params)

    def _advance_curve(self, piece: Curve, now: Estimate, params: AirParams) -> None:
        piece.follow((now.north, now.east))
        if piece.passed < len(piece.passing) and piece.s >= piece.passing[piece.passed]:
            piece.passed += 1  # one in a cycle, so that each is told of
            self._pass()
            return
        if piece.left > 0:
            return
        onto = piece.onto or self._planner(now, params).towards(self._stop, piece.end, PathStart(float(piece.way.course[-1])))
        self._piece = self._planner(now, params).with_exit(onto, self._stop) if isinstance(onto, Leg) else onto

    def _pass(self) -> bool:
        """The current item is reached; whether another one follows."""
        assert self.index is not None
        self.reached = self.index
        stop = following(self.items, self._stop)
        self.laps += stop.laps
        if stop.index is None:
            self.camera.stop()
            self.finished = True
            return False
        self._take(stop)
        return True

    def _leave(self, piece: Leg | Circle, now: Estimate, params: AirParams) -> None:
        if not self._pass() or self._off_path:
            return
        if isinstance(piece, Circle):
            self._piece = self._from_here(now, params, piece)
            return
        onto = self._planner(now, params).towards(self._stop, piece.end, None, piece.exit)
        self._piece = Turn(piece.exit, piece, onto) if isinstance(piece.exit, Corner) and isinstance(onto, Leg) else onto

    def _take(self, stop: NextItem) -> None:
        self.index, self._jumps = stop.index, stop.jumps
        self.speed = self.speed if stop.speed is None else stop.speed
        self._bearing, self._turned, self._held = None, 0.0, 0.0
        for item in (self.items[k] for k in stop.deeds):
            if item.kind is ItemKind.SET_HOME:
                self.homes.append(item)
            else:
                self.camera.obey(item)

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
        if item.to_altitude:
            return abs(now.height - item.place.height) < LEVELLED
        if item.kind is ItemKind.ORBIT:
            return item.turns > 0 and self._turned >= math.tau * item.turns
        return self._held >= item.hold
