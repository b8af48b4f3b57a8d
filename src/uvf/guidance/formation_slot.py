"""Keeps an aircraft at its station behind a leader: along the leader's trail, some metres aside of it and above it."""

import math
from dataclasses import dataclass, replace

from uvf.control.cycle import Cycle, clip
from uvf.estimation.state import Estimate
from uvf.guidance.leader_track import LeaderTrack, TrackPoint
from uvf.guidance.vector_field import PathReference, Point
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

STRAYED = 100.0  # m, from the trail: any spot of it may be the nearest one
TRIM_LIMIT = 2.0  # m/s
CATCHING_UP = 5.0  # m/s, faster or slower than the leader
HASTE = 1.2  # more airspeed asked for per speed that is wanting over ground: the loops behind it take a second or two
TRIMS_WITHIN = 5.0  # m
SIDE_ACCELERATION = 1.2  # m/s^2, at most, for an offset to swing round
SIDE_TIME = 1.5  # s
SEEN_AHEAD = (0.0, 0.75, 1.5)  # s: a turn wants its airspeed before it begins
SLOW_MARGIN = 1.06  # of the airspeed with which the wing can just carry the turn
SIDE_SHARE = 0.5  # of the speeds that there are to spare, for an offset to swing round


@dataclass(frozen=True, slots=True)
class FormationSlot:
    """Place of a follower relative to its leader."""

    behind: float  # m, of the leader's way through the air
    right: float = 0.0  # m, aside of the trail
    above: float = 0.0  # m


@dataclass(frozen=True, slots=True)
class SlotSetpoint:
    """Path, height and airspeed that lead to the slot, and how far the aircraft is from it."""

    aim: PathReference
    height: float  # m
    climb: float  # m/s
    airspeed: float  # m/s
    late: float  # m over ground along the trail, behind the station
    distance: float  # m, from the station


class LateralOffset:
    """Lateral offset from the leader's track, swung round in corners no faster than airspeed can change.

    An offset that turned with the leader would want the wings of a formation to fly a corner at quite another speed. Where the
    leader turns faster, the offset keeps its direction for a while, so that the corner flown is the leader's, moved aside.
    """

    def __init__(self, right: float) -> None:
        self._right = right
        self._direction: float | None = None  # rad, of the course that the offset is at right angles to
        self._rate = 0.0  # rad/s

    def step(self, spot: TrackPoint, params: AirParams, dt: float) -> tuple[Point, Point]:
        """Offset [m] and its rate of change [m/s], north and east, after ``dt`` [s] beside ``spot``."""
        if self._direction is None or not self._right:
            self._direction, self._rate = spot.course, 0.0
        else:
            self._swing(spot, params, dt)
        c, s, r = math.cos(self._direction), math.sin(self._direction), self._right
        return (-s * r, c * r), (-c * r * self._rate, -s * r * self._rate)

    def _swing(self, spot: TrackPoint, params: AirParams, dt: float) -> None:
        assert self._direction is not None
        arm = abs(self._right)
        spare = min(params.max_airspeed - params.trim_airspeed, params.trim_airspeed - params.min_airspeed)
        jerk = SIDE_ACCELERATION / arm
        off = math.remainder(spot.course - self._direction, math.tau)
        back = math.copysign(min(abs(off) / SIDE_TIME, math.sqrt(2 * jerk * abs(off))), off)
        wanted = clip(spot.speed * spot.curvature + back, SIDE_SHARE * spare / arm)
        self._rate += clip(wanted - self._rate, jerk * dt)
        self._direction += self._rate * dt


def _slowest(trail: LeaderTrack, spot: TrackPoint, now: Estimate, params: AirParams) -> float:
    """m/s through the air, with which the wing carries the turns of the trail from ``spot`` on, at the bank that they need this fast."""
    sharpest = max(abs(trail.at(spot.t + ahead).curvature) for ahead in SEEN_AHEAD)
    bank = min(math.atan(sharpest * now.ground_speed**2 / GRAVITY), params.bank_limit)
    return max(params.min_airspeed, SLOW_MARGIN * Cycle(replace(now, roll=bank), params, 0.0).stalled)


def _airspeed(wanted: Point, now: Estimate) -> float:
    """m/s, that gives a velocity over ground [m/s] in the wind and in the gust that the aircraft is in."""
    v_north, v_east = now.ground_speed * math.cos(now.course), now.ground_speed * math.sin(now.course)
    gust = now.airspeed - math.hypot(v_north - now.wind_north, v_east - now.wind_east)
    haste = HASTE * (math.hypot(*wanted) - now.ground_speed)
    return math.hypot(wanted[0] - now.wind_north, wanted[1] - now.wind_east) + gust + haste


class SlotKeeping:
    """Follows the leader's track by its cross-track distance and curvature, and the slot on it by airspeed."""

    def __init__(self, station: FormationSlot) -> None:
        self.station = station
        self._boom = LateralOffset(station.right)
        self._trim = Integral(TRIM_LIMIT)
        self._offset: Point = (0.0, 0.0)
        self._spot: TrackPoint | None = None

    def step(self, trail: LeaderTrack, t: float, now: Estimate, params: AirParams, dt: float) -> SlotSetpoint:
        """The setpoint at ``t`` [s], ``dt`` [s] after the last, behind a leader who has been heard."""
        spot = self._spot = self._find(trail, now)
        self._offset, moves = self._boom.step(spot, params, dt)
        c, s = math.cos(spot.course), math.sin(spot.course)
        along, aside = moves[0] * c + moves[1] * s, moves[1] * c - moves[0] * s
        late = (t - self.station.behind / trail.pace - spot.t) * spot.speed
        moving = spot.speed * self.station.behind * trail.pace_rate / trail.pace**2
        speed = spot.speed + moving + along + self._catching_up(late, params, dt)
        airspeed = _airspeed((speed * c - aside * s, speed * s + aside * c), now)
        airspeed = min(max(airspeed, _slowest(trail, spot, now, params)), params.max_airspeed)
        height = spot.height + self.station.above
        aim = self._aim(trail, spot, (along, aside), now, params)
        return SlotSetpoint(aim, height, spot.climb, airspeed, late, math.hypot(late, aim.error, height - now.height))

    def _find(self, trail: LeaderTrack, now: Estimate) -> TrackPoint:
        """The spot that the aircraft is beside, less its offset."""
        here = (now.north - self._offset[0], now.east - self._offset[1])
        before = self._spot
        if before is not None and math.hypot(here[0] - before.north, here[1] - before.east) < STRAYED:
            return trail.nearest(here, before.t)
        return trail.nearest(here)

    def _catching_up(self, late: float, params: AirParams, dt: float) -> float:
        """m/s, faster than the leader."""
        if abs(late) < TRIMS_WITHIN:
            self._trim.step(params.follow_i * late, dt)
        return clip(params.follow_p * late, CATCHING_UP) + self._trim.value

    def _aim(self, trail: LeaderTrack, spot: TrackPoint, moves: Point, now: Estimate, params: AirParams) -> PathReference:
        here = (now.north - self._offset[0] - spot.north, now.east - self._offset[1] - spot.east)
        error = here[1] * math.cos(spot.course) - here[0] * math.sin(spot.course)
        speed = max(now.ground_speed, 5.0)
        # The offset moves with the aircraft: what is left of its speed follows the trail.
        share = (speed - moves[0]) / speed
        bend = trail.at(spot.t + params.lead_time).curvature
        return PathReference(error, spot.course + math.asin(clip(moves[1] / speed, 0.5)), bend * share, params.k_path, params.chi_inf)
