"""Keeps an aircraft of a formation clear of the others: it climbs or sinks away from one that comes too near, and lets it go ahead."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from uvf.estimation.state import Estimate
from uvf.guidance.leader_track import LeaderReport
from uvf.models.vehicle.flight_params import AirParams

OLDEST = 1.0  # s, of a report that still counts
FORESEEN = 2.0  # s, that both are taken to fly straight on
CLEAR = 1.3  # of the least distance, that heights are moved apart to


@dataclass(frozen=True, slots=True)
class Threat:
    """Another aircraft that comes, or is, too near."""

    name: str
    distance: float  # m, at its nearest within ``FORESEEN``
    height: float  # m, of the other one now
    is_ahead: bool


def threat(t: float, now: Estimate, others: Mapping[str, LeaderReport], least: float) -> Threat | None:
    """The other aircraft that comes nearest, if nearer than ``least`` [m]; reports older than ``OLDEST`` at ``t`` [s] do not count."""
    found = [_meeting(t, now, other, report) for other, report in sorted(others.items()) if abs(t - report.t) <= OLDEST]
    near = [meeting for meeting in found if meeting.distance < least]
    return min(near, key=lambda meeting: meeting.distance, default=None)


def _meeting(t: float, now: Estimate, other: str, report: LeaderReport) -> Threat:
    age = t - report.t
    v_north, v_east = now.ground_speed * math.cos(now.course), now.ground_speed * math.sin(now.course)
    off = (
        report.north + age * report.v_north - now.north,
        report.east + age * report.v_east - now.east,
        report.height + age * report.climb - now.height,
    )
    closing = (report.v_north - v_north, report.v_east - v_east, report.climb - now.climb)
    square = sum(v * v for v in closing)
    when = min(max(-sum(x * v for x, v in zip(off, closing, strict=True)) / square, 0.0), FORESEEN) if square > 1e-6 else 0.0
    distance = math.hypot(*(x + when * v for x, v in zip(off, closing, strict=True)))
    return Threat(other, distance, report.height + age * report.climb, off[0] * v_north + off[1] * v_east > 0)


def evasion(found: Threat, name: str, wanted: tuple[float, float], params: AirParams) -> tuple[float, float]:
    """Height [m] and airspeed [m/s] of the aircraft ``name`` to evade a threat, instead of those wanted.

    The one that wants to be higher than the other is now goes up, else down; on one height the names decide, so that both do not go
    one way.
    """
    height, airspeed = wanted
    apart, climbs = CLEAR * params.follow_sep, (height, name) > (found.height, found.name)
    height = max(height, found.height + apart) if climbs else min(height, found.height - apart)
    return max(height, params.min_altitude), params.min_airspeed if found.is_ahead else airspeed
