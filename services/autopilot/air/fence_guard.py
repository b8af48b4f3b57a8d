"""Keeps an aircraft within its fence: the latest turn that still gets away in time is flown, whatever was asked for.

The turn to either side is predicted through the air with the roll into it and the wind (a runtime assurance as in automatic ground
collision avoidance, Swihart et al., IEEE AES Magazine 26(5), 2011): as long as one of them keeps its distance, nothing is done.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Breach, Fence
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import tightest
from uvf.guidance.route import Circle, Place
from uvf.guidance.vector_field import turn_radius
from uvf.maths.geodesy import GRAVITY
from uvf.models.mission.fence import ACTIONS, OPEN, FenceAction, Fencing, near_home
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.plans.fences import fencing

Floats = NDArray[np.float64]

REACTION = 0.2  # s, until the bank begins to change
STEP = 0.2  # s, of the prediction
ROLL_RATE = 1.2  # rad/s, into the turn
TURNED = 1.2 * math.pi  # rad, after which no turn comes nearer any more
AWAY = 0.5  # of a turn's radius: so far off again it has turned away
SLACK = 3.0  # m, beyond the margin, from where on it is let go
PULL = 4.0  # m/s^2, with which a climb or a descent is ended


@dataclass(frozen=True, slots=True)
class Outlook:
    """How it stands with the fence. m; inf without one or far from it."""

    clearance: float = math.inf  # of the aircraft now
    least: float = math.inf  # of the better turn that could be begun now
    side: float = 1.0  # of that turn, positive right
    height_room: float = math.inf  # to floor or ceiling, where climb or descent can be ended
    low: bool = False  # the floor is the nearer one

    @property
    def breached(self) -> bool:
        """Whether the aircraft is outside."""
        return self.clearance < 0 or self.height_room < 0

    @property
    def breach(self) -> Breach:
        """What of the fence it is outside of."""
        if self.clearance < 0:
            return Breach.BREACH_EDGE
        if self.height_room >= 0:
            return Breach.BREACH_NONE
        return Breach.BREACH_FLOOR if self.low else Breach.BREACH_CEILING

    def spare(self, params: AirParams) -> float:
        """Distance [m] beyond what is kept; negative: it has to turn away, or to end its climb or descent."""
        return min(self.least - params.fence_margin, self.height_room - 0.5 * params.fence_height)


class FenceGuard:
    """Steers only for a fence whose action is not just to warn."""

    def __init__(self) -> None:
        self.fencing: Fencing = OPEN
        self.outlook = Outlook()
        self.grounds = False
        """On the ground, or about to be: it is not turned away, and the floor does not count until it has been above it again."""
        self._side = 0.0
        self._above_floor = False

    def take(self, fencing: Fencing) -> None:
        """Another fence from now on."""
        self.fencing, self.outlook, self._side, self._above_floor = fencing, Outlook(), 0.0, False

    def look(self, now: Estimate, params: AirParams) -> Outlook:
        """Once a cycle, before it is steered."""
        clearance = self.fencing.region.at((now.east, now.north))
        radius = _radius(now, params)
        reach = 2 * radius + now.ground_speed * (REACTION + 2.0) + params.fence_margin
        sides = {side: self._least(now, params, side) for side in (1.0, -1.0)} if clearance < reach else {1.0: math.inf}
        side = max(sides, key=lambda s: sides[s])
        if self._side and self._side in sides and sides[self._side] > sides[side] - SLACK:
            side = self._side  # two turns that are about as good do not take turns
        above, below = self._height_rooms(now)
        self.outlook = Outlook(clearance, sides[side], side, min(above, below), below < above)
        return self.outlook

    @property
    def evades(self) -> bool:
        """Whether it is turning away from the fence now."""
        return self._side != 0.0

    def bank(self, wanted: float, now: Estimate, params: AirParams) -> float:
        """rad: what was asked for, or into the turn that gets away."""
        least, margin = self.outlook.least, params.fence_margin
        if not self.fencing.steers or self.grounds:
            return wanted
        if self.outlook.clearance < -margin and self._leads_away(now):
            self._side = 0.0  # far outside, of a fence that has just been set: on its way back it is let go
        elif not self._side and least < margin:
            self._side = self.outlook.side
        elif self._side and least > margin + SLACK and self._leads_away(now):
            self._side = 0.0
        elif self._side:
            self._side = self.outlook.side
        if not self._side:
            return wanted
        return self._side * (params.turn_bank if least > 0.5 * margin else params.bank_limit)

    def level(self, wanted: float | None, now: Estimate, params: AirParams) -> float | None:
        """The height asked for [m, world], between floor and ceiling; where a climb rate is held, only near to one of them."""
        if not self.fencing.steers or (wanted is None and self.outlook.height_room > params.fence_height):
            return wanted
        height = now.height if wanted is None else wanted
        return clamped(height, self.fencing, params) if self._above_floor else min(height, self.fencing.ceiling - params.fence_height)

    def _leads_away(self, now: Estimate) -> bool:
        ahead = (now.east + 2 * now.ground_speed * math.sin(now.course), now.north + 2 * now.ground_speed * math.cos(now.course))
        return self.fencing.region.at(ahead) >= self.outlook.clearance

    def _least(self, now: Estimate, params: AirParams, side: float) -> float:
        """m, the least clearance of the turn to ``side`` until it has got away."""
        room = self.fencing.region.clearance(turn(now, side * params.turn_bank))
        lowest = np.minimum.accumulate(room)
        away = np.flatnonzero(room > lowest + AWAY * _radius(now, params))
        return float(lowest[away[0]] if len(away) else lowest[-1])

    def _height_rooms(self, now: Estimate) -> tuple[float, float]:
        """m, to ceiling and floor, where the climb or descent of now would end; the floor counts once it has been above it."""
        fence = self.fencing
        self._above_floor = not self.grounds and (self._above_floor or now.height > fence.floor)
        end = now.height + now.climb * REACTION + now.climb * abs(now.climb) / (2 * PULL)
        floor = fence.floor if self._above_floor else -math.inf
        return fence.ceiling - max(end, now.height), min(end, now.height) - floor


def _radius(now: Estimate, params: AirParams) -> float:
    return turn_radius(max(now.airspeed, 0.7 * params.trim_airspeed), params.turn_bank)


def turn(now: Estimate, bank: float) -> Floats:
    """(n, 2) m east and north, from now on, of a turn with this bank [rad] in the wind of now."""
    vn, ve = now.ground_speed * math.cos(now.course) - now.wind_north, now.ground_speed * math.sin(now.course) - now.wind_east
    speed, azimuth, roll = max(math.hypot(vn, ve), 1.0), math.atan2(ve, vn), now.roll
    north, east, turned, points = now.north, now.east, 0.0, [(now.east, now.north)]
    wait = REACTION
    while turned < TURNED and len(points) < 400:
        if wait <= 0:
            roll += min(max(bank - roll, -ROLL_RATE * STEP), ROLL_RATE * STEP)
        wait -= STEP
        rate = GRAVITY / speed * math.tan(roll)
        azimuth += 0.5 * rate * STEP
        north += STEP * (speed * math.cos(azimuth) + now.wind_north)
        east += STEP * (speed * math.sin(azimuth) + now.wind_east)
        azimuth += 0.5 * rate * STEP
        turned += rate * STEP * math.copysign(1.0, bank)
        points.append((east, north))
    return np.array(points)


def clamped(height: float, fencing: Fencing, params: AirParams) -> float:
    """``height`` [m, world] between floor and ceiling, the margins kept as far as there is room for both."""
    low, high = fencing.floor + params.fence_height, fencing.ceiling - params.fence_height
    return 0.5 * (low + high) if low > high else min(max(height, low), high)


def kept(wanted: AltitudeAirspeedSetpoint, guard: FenceGuard, now: Estimate, params: AirParams) -> AltitudeAirspeedSetpoint:
    """What was asked for, within the fence."""
    height = guard.level(wanted.height, now, params)
    climb = wanted.climb if height == wanted.height else 0.0
    return replace(wanted, bank=guard.bank(wanted.bank, now, params), height=height, climb=climb)


def circle_within(fencing: Fencing, near: Place, radius: float, params: AirParams) -> Circle | None:
    """The nearest circle of ``radius`` [m] that lies within the fence with its margin; None if there is no room."""
    needed = radius + params.fence_margin
    (east, north), room = fencing.region.roomiest((near.east, near.north), needed)
    if room < needed:
        return None
    return Circle(Place(north, east, clamped(near.height, fencing, params)), radius)


HEIGHT_NEEDED = 3  # fence_height, between floor and ceiling


class FenceInForce:
    """Worked out anew when the plan, home or a parameter is another one."""

    def __init__(self) -> None:
        self._fence = Fence()
        self._of: tuple[object, ...] = ()
        self._found = fencing(self._fence)

    def of(self, fence: Fence, home: Place | None, params: AirParams) -> Fencing:
        """The same object as long as nothing changes."""
        of = home, params.max_distance, params.max_height, params.fence_action, too_small(params)
        if fence is not self._fence or of != self._of:
            self._fence, self._of, self._found = fence, of, in_force(fence, home, params)
        return self._found


def in_force(fence: Fence, home: Place | None, params: AirParams) -> Fencing:
    """A fence that is disabled keeps out of nothing, home's neither."""
    plan = fencing(fence)
    if fence.disabled:
        return plan
    if params.fence_action != "plan":
        plan = replace(plan, action=ACTIONS[params.fence_action])
    if home is None:
        return plan
    found = near_home(plan, (home.east, home.north), params.max_distance)
    if params.max_height:
        found = replace(found, ceiling=min(found.ceiling, home.height + params.max_height))
    return replace(found, action=FenceAction.WARN) if too_small(params) else found


def too_small(params: AirParams) -> str:
    """Why the fence about home cannot be kept, and is only told of; empty if it can."""
    room, height = tightest(params) + params.fence_margin, HEIGHT_NEEDED * params.fence_height
    if 0 < params.max_distance < room:
        return f"max_distance of {params.max_distance:.0f} m leaves no room to circle: {room:.0f} m are needed"
    if 0 < params.max_height < height:
        return f"max_height of {params.max_height:.0f} m is too low: {height:.0f} m are needed"
    return ""
