"""A mission flown ahead of time: the plan follower and the lateral guidance that fly it, on an aircraft without inertia.

What comes out is the path that the autopilot means to fly, corners, curves and circles included, and when each item is passed.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.control.cycle import clip
from uvf.estimation.state import Estimate
from uvf.guidance.approach import orbit_radius
from uvf.guidance.flight_plan import OFF_PATH, ItemKind, PlanItem
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Place
from uvf.guidance.vector_field import LateralGuidance, Point
from uvf.maths.atmosphere import RHO0
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

Floats = NDArray[np.float64]

STEP = 0.2  # s
LONGEST = 1200.0  # s
MANY = 1000  # steps


@dataclass(frozen=True)
class MissionPreview:
    """A mission as it will be flown from its first item on."""

    points: Floats
    """(n, 3) m: north, east, height."""
    t: Floats
    """(n,) s from the start."""
    passed: tuple[tuple[int, float], ...]
    """(item, time [s] at which it is done)."""
    goes_on: bool
    """Whether it was cut: it repeats itself, circles without end, or is longer than ``LONGEST``."""

    @property
    def s(self) -> Floats:
        """Distance (n,) [m] over ground from the start."""
        if len(self.points) == 0:
            return np.zeros(0)
        return np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(self.points[:, :2], axis=0).T))))


def preview(items: Sequence[PlanItem], params: AirParams, wind: Point = (0.0, 0.0), start: Place | None = None) -> MissionPreview:
    """Flies the items once.

    wind: m/s north and east, the way it blows to; start: where the aircraft is, else the first place that the mission names.
    """
    flight = PreviewFlight(items, params, wind, start)
    while not flight.advance(MANY):
        pass
    return flight.so_far


class PreviewFlight:
    """A preview in the making, some steps at a time: on an aircraft that banks and climbs at once and has the airspeed asked of it.

    Arguments as of ``preview``.
    """

    def __init__(self, items: Sequence[PlanItem], params: AirParams, wind: Point = (0.0, 0.0), start: Place | None = None) -> None:
        places = [item.place for item in items if item.kind in (ItemKind.WAYPOINT, ItemKind.ORBIT)]
        begin = start or next(iter(places), Place(0.0, 0.0, 0.0))
        onward = next((p for p in places if math.hypot(p.north - begin.north, p.east - begin.east) > 1.0), begin)
        self._params = params
        self._wind = wind
        self._north, self._east, self._height = begin.north, begin.east, begin.height
        self._course = math.atan2(onward.east - begin.east, onward.north - begin.north)
        self._climb, self._bank, self._airspeed = 0.0, 0.0, params.trim_airspeed
        self._guidance = LateralGuidance()
        self._follower = PlanFollower(items)
        self._follower.resume()
        self._path = [(self._north, self._east, self._height)] if places else []
        self._passed: list[tuple[int, float]] = []
        self._item = self._follower.index
        self._circled = 0.0  # s
        self._over = not places

    @property
    def so_far(self) -> MissionPreview:
        """What has been flown by now."""
        path = np.array(self._path).reshape(-1, 3)
        t = np.arange(len(path), dtype=np.float64) * STEP
        return MissionPreview(path, t, tuple(self._passed), not (self._follower.finished or self._follower.index is None))

    def advance(self, steps: int) -> bool:
        """Flies on for so many steps at most; returns whether the mission is over."""
        for _ in range(steps):
            if self._over:
                break
            self._go_on()
        return self._over

    def _go_on(self) -> None:
        follower = self._follower
        if follower.index is not None and follower.items[follower.index].kind in OFF_PATH:
            follower.pass_item()
        elif follower.index is not None:
            self._step(follower)
            self._path.append((self._north, self._east, self._height))
        t = STEP * (len(self._path) - 1)
        if follower.index != self._item or follower.finished:
            self._passed += [(self._item, t)] if self._item is not None else []
            self._over = follower.finished or (follower.laps > 0 and self._item is not None and self._is_back(self._item))
            self._item, self._circled = follower.index, 0.0
        self._circled += STEP * self._circles_for_ever(follower)
        around = self._circled > 0 and self._circled * self._airspeed > math.tau * abs(self._radius(follower))
        self._over = self._over or follower.index is None or t > LONGEST or around

    def _is_back(self, item: int) -> bool:
        """Whether this item has been passed before: then the circuit is closed."""
        return [passed for passed, _ in self._passed].count(item) > 1

    def _radius(self, follower: PlanFollower) -> float:
        assert follower.index is not None
        return orbit_radius(follower.items[follower.index], self._params)

    def _circles_for_ever(self, follower: PlanFollower) -> bool:
        """Whether it is on a circle that does not end by itself."""
        item = follower.items[follower.index] if follower.index is not None else None
        if item is None or item.kind is not ItemKind.ORBIT or item.turns or item.to_altitude:
            return False
        away = math.hypot(self._north - item.place.north, self._east - item.place.east)
        return away < 1.2 * abs(self._radius(follower))

    def _step(self, follower: PlanFollower) -> None:
        now = self._estimate()
        aim, profile = follower.step(now, self._params, STEP)
        self._bank = self._guidance.bank(aim, now, self._params, STEP)
        self._airspeed = follower.speed or self._params.trim_airspeed
        climb = profile.climb + self._params.altitude_p * (profile.height - self._height)
        self._climb = min(max(climb, -self._params.sink_max), self._params.climb_max)
        turned = GRAVITY * math.tan(self._bank) / max(now.ground_speed, 1.0) * STEP
        middle = self._course + turned / 2
        self._north += now.ground_speed * math.cos(middle) * STEP
        self._east += now.ground_speed * math.sin(middle) * STEP
        self._height += self._climb * STEP
        self._course += turned

    def _estimate(self) -> Estimate:
        """Its own state, exactly known; the heading makes good the course in the wind."""
        north, east = self._wind
        across = -north * math.sin(self._course) + east * math.cos(self._course)
        along = north * math.cos(self._course) + east * math.sin(self._course)
        crab = math.asin(clip(across / self._airspeed, 0.95))
        speed = max(self._airspeed * math.cos(crab) + along, 1.0)
        return Estimate(
            north=self._north,
            east=self._east,
            height=self._height,
            ground_speed=speed,
            course=self._course,
            climb=self._climb,
            roll=self._bank,
            pitch=0.0,
            yaw=self._course - crab,
            p=0.0,
            q=0.0,
            r=0.0,
            airspeed=self._airspeed,
            density=RHO0,
            side_force=0.0,
            wind_north=north,
            wind_east=east,
            position_sigma=0.0,
            height_known=True,
        )


def places_passed(shown: MissionPreview) -> Iterator[tuple[int, float, float]]:
    """(item, distance [m] flown, height [m]) where each item is done."""
    s = shown.s
    for item, t in shown.passed:
        yield item, float(np.interp(t, shown.t, s)), float(np.interp(t, shown.t, shown.points[:, 2]))
