"""A coverage plan as the mission of an aircraft: each swath entered level on its course, the camera triggered along it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.models.mission.file import Waypoint
from uvf.planning.coverage.plan import SWATH, TRANSIT, CoveragePlan
from uvf.planning.coverage.transits import moved

Floats = NDArray[np.float64]

DECIMALS = 2  # of metres
NEAR = 1.5  # m: waypoints nearer than that count as one


@dataclass(frozen=True)
class SurveyFlight:
    """How a plan is flown: ``height`` [m, world frame], ``speed`` [m/s] through the air, 0: cruise, and ``trigger`` [m] between pictures.

    lead_in, lead_out: [m], flown straight before and behind each swath, where the plan has the room.
    """

    height: float
    trigger: float
    speed: float = 0.0
    lead_in: float = 0.0
    lead_out: float = 0.0


def survey_mission(plan: CoveragePlan, flight: SurveyFlight) -> list[Waypoint]:
    """Mission items of the plan, world frame (east, north).

    Of each swath: where the lead-in begins, at the swath's course, so that a Dubins path leads there; where it begins itself (the camera
    starts); and where it or its lead-out ends (the camera stops). Between swaths on one line there is neither lead-in nor lead-out.
    """
    items = [] if flight.speed == 0.0 else [Waypoint(kind="speed", speed=flight.speed)]
    for index in np.flatnonzero(plan.kinds == SWATH).tolist():
        row = plan.segments[index]
        before, after = _straight(plan, index, -1), _straight(plan, index, 1)
        if before is not None and min(flight.lead_in, before) > NEAR:
            items.append(_waypoint(row, -min(flight.lead_in, before), flight.height, True))
        items.append(_waypoint(row, 0.0, flight.height, before is not None and min(flight.lead_in, before) <= NEAR))
        items.append(Waypoint(kind="trigger_distance", distance=round(flight.trigger, DECIMALS)))
        end = float(row[4]) + min(flight.lead_out, after or 0.0)
        items.append(_waypoint(row, end, flight.height, False))
        items.append(Waypoint(kind="trigger_distance", distance=0.0))
    return items


def _waypoint(swath: Floats, along: float, height: float, has_course: bool) -> Waypoint:
    x, y, angle = moved(swath[:3], 0.0, along).tolist()
    course = round(math.remainder(angle, math.tau), 5) if has_course else None
    return Waypoint(round(x, DECIMALS), round(y, DECIMALS), round(height, DECIMALS), course=course)


def _straight(plan: CoveragePlan, index: int, step: int) -> float | None:
    """Length [m] that is gone straight on before (step -1) or behind (step 1) a swath; None where that leads to another swath."""
    found, k, course = 0.0, index + step, plan.segments[index, 2]
    while 0 <= k < len(plan.segments) and plan.segments[k, 3] == 0.0 and math.cos(plan.segments[k, 2] - course) > 1.0 - 1e-9:
        if plan.kinds[k] != TRANSIT:
            return None
        found += float(plan.segments[k, 4])
        k += step
    return found
