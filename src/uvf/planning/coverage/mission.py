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
    """Mission items of the plan, world frame (east, north): all waypoints have courses, so that the turns between are Dubins paths.

    Of each swath: where the lead-in begins, where it begins itself (the camera starts), and where it or its lead-out ends (it stops).
    """
    items = [] if flight.speed == 0.0 else [Waypoint(kind="speed", speed=flight.speed)]
    for index in np.flatnonzero(plan.kinds == SWATH):
        row = plan.segments[index]
        before = min(flight.lead_in, _straight(plan, int(index), -1))
        after = min(flight.lead_out, _straight(plan, int(index), 1))
        if before > NEAR:
            items.append(_waypoint(row, -before, flight.height))
        items.append(_waypoint(row, 0.0, flight.height))
        items.append(Waypoint(kind="trigger_distance", distance=round(flight.trigger, DECIMALS)))
        end = float(row[4]) + (after if after > NEAR else 0.0)
        items.append(_waypoint(row, end, flight.height))
        items.append(Waypoint(kind="trigger_distance", distance=0.0))
    return items


def _waypoint(swath: Floats, along: float, height: float) -> Waypoint:
    x, y, course = moved(swath[:3], 0.0, along).tolist()
    return Waypoint(round(x, DECIMALS), round(y, DECIMALS), round(height, DECIMALS), course=round(math.remainder(course, math.tau), 5))


def _straight(plan: CoveragePlan, index: int, step: int) -> float:
    """Length [m] that is gone straight on before (step -1) or behind (step 1) a swath; half of it where another swath begins there."""
    found, k, course = 0.0, index + step, plan.segments[index, 2]
    while 0 <= k < len(plan.segments) and plan.segments[k, 3] == 0.0 and math.cos(plan.segments[k, 2] - course) > 1.0 - 1e-9:
        if plan.kinds[k] != TRANSIT:
            return found / 2
        found += float(plan.segments[k, 4])
        k += step
    return found
