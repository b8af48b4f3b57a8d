import itertools
import math

import numpy as np
import pytest

from tests.planning.coverage.shapes import HOLE, SQUARE
from uvf.planning.coverage.field import make_field
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.mission import SurveyFlight, survey_mission
from uvf.planning.coverage.planner import plan_coverage
from uvf.planning.coverage.task import CoverageTask
from uvf.planning.coverage.vehicles import SurveyAircraft

FLIGHT = SurveyFlight(height=90.0, trigger=12.5, lead_in=40.0, lead_out=8.0)


def planned(holes=(), **task):
    aircraft = SurveyAircraft(GroundSpeed(25.0), 50.0, lead_in=55.0, lead_out=20.0)
    return plan_coverage(CoverageTask(make_field(SQUARE, holes), 20.0, **task), aircraft)


def test_each_swath_has_a_lead_in_on_its_course_and_its_pictures():
    plan = planned()
    items = survey_mission(plan, FLIGHT)
    assert [item.kind for item in items] == 10 * ["waypoint", "waypoint", "trigger_distance", "waypoint", "trigger_distance"]
    for k, (x0, y0, x1, y1) in enumerate(plan.swaths.tolist()):
        lead, begin, on, end, off = items[5 * k : 5 * k + 5]
        course = math.atan2(y1 - y0, x1 - x0)
        assert lead.course == pytest.approx(course, abs=1e-4)
        assert begin.course is None and end.course is None
        assert (begin.x, begin.y) == pytest.approx((x0, y0), abs=0.01)
        assert (begin.x - lead.x, begin.y - lead.y) == pytest.approx((40.0 * math.cos(course), 40.0 * math.sin(course)), abs=0.02)
        assert (end.x, end.y) == pytest.approx((x1 + 8.0 * math.cos(course), y1 + 8.0 * math.sin(course)), abs=0.02)
        assert (on.distance, off.distance) == (12.5, 0.0)
        assert {item.z for item in (lead, begin, end)} == {90.0}


def test_over_a_hole_the_camera_stops_and_nothing_turns():
    plan = planned([HOLE], direction=0.0)
    items = survey_mission(plan, FLIGHT)
    waypoints = [item for item in items if item.kind == "waypoint"]
    on = sum(item.kind == "trigger_distance" and item.distance > 0 for item in items)
    assert on == len(plan.swaths) > 10
    assert sum(item.course is not None for item in waypoints) == plan.turns + 1
    assert min(math.dist((a.x, a.y), (b.x, b.y)) for a, b in itertools.pairwise(waypoints)) > 1.0


def test_a_speed_is_set_first():
    items = survey_mission(planned(), SurveyFlight(90.0, 12.5, speed=22.0))
    assert items[0].kind == "speed" and items[0].speed == 22.0
    assert items[1].course is not None
    assert np.isfinite([item.x for item in items]).all()
