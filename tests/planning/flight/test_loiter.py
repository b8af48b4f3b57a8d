"""Loiter patterns: helices of the aircraft's own climb, clear all round at every height."""

import math

import numpy as np
import pytest

from uvf.maths.zones import Disc, Region
from uvf.planning.flight import Airspace, FlightLimits, box, cylinder, plan_loiter
from uvf.planning.flight.loiter import exits

LIMITS = FlightLimits(radius=40.0, climb=0.15, sink=0.1, aside=8.0, above=6.0)
BEGIN = (100.0, -50.0, 60.0, 0.7)


@pytest.mark.parametrize("height", [60.0, 95.0, 300.0, 20.0])
def test_the_helix_begins_on_course_and_climbs_as_steeply_as_it_may(height):
    pattern = plan_loiter(Airspace(), LIMITS, BEGIN, height, 70.0)
    found = pattern.sampled(0.5)
    assert found[0] == pytest.approx(BEGIN) and found[-1, 2] == pytest.approx(height)
    steps = np.hypot(*np.diff(found[:, :2], axis=0).T)
    steepest = math.tan(LIMITS.climb if height > 60.0 else LIMITS.sink)
    assert steps.sum() == pytest.approx(abs(height - 60.0) / steepest, rel=1e-3, abs=1e-9)
    assert np.hypot(*(found[:, :2] - pattern.centre).T) == pytest.approx(np.full(len(found), 70.0))
    heading = np.arctan2(*np.diff(found[:, :2], axis=0).T[::-1])
    assert np.cos(heading - found[:-1, 3] if len(steps) else np.zeros(1)) == pytest.approx(1.0, abs=1e-3)
    assert pattern.turns == pytest.approx(pattern.length / (2 * math.pi * 70.0))


def test_it_turns_to_the_side_on_which_there_is_room():
    left, right = cylinder((0.0, 120.0), 30.0, 0.0, 90.0), cylinder((0.0, -120.0), 30.0, 0.0, 90.0)
    begin = (0.0, 0.0, 60.0, 0.0)
    assert plan_loiter(Airspace((left,)), LIMITS, begin, 60.0, 60.0).radius < 0
    assert plan_loiter(Airspace((right,)), LIMITS, begin, 60.0, 60.0).radius > 0
    assert plan_loiter(Airspace((left, right)), LIMITS, (0.0, 0.0, 97.0, 0.0), 150.0, 60.0) is not None


def test_what_stands_within_the_circle_does_not_matter_and_what_is_on_the_way_up_does():
    begin, pole = (0.0, 0.0, 60.0, 0.0), cylinder((0.0, 60.0), 20.0, 0.0, 500.0)
    assert plan_loiter(Airspace((pole,)), LIMITS, begin, 200.0, 60.0).radius > 0
    slab = box((-500, -500), (500, 500), 120.0, 140.0)
    assert plan_loiter(Airspace((slab,)), LIMITS, begin, 110.0, 60.0) is not None
    assert plan_loiter(Airspace((slab,)), LIMITS, begin, 200.0, 60.0) is None


def test_a_fence_is_kept_within():
    fence = Region((Disc((0.0, 0.0), 90.0),))
    assert plan_loiter(Airspace(fence=fence), LIMITS, (0.0, -60.0, 60.0, 0.0), 60.0, 60.0) is not None
    assert plan_loiter(Airspace(fence=fence), LIMITS, (0.0, 60.0, 60.0, 0.0), 60.0, 60.0).radius < 0
    assert plan_loiter(Airspace(fence=fence), LIMITS, (40.0, 0.0, 60.0, 0.0), 60.0, 60.0) is None


def test_exits_lie_on_the_circle_along_its_tangent():
    pattern = plan_loiter(Airspace(), LIMITS, BEGIN, 80.0, 50.0)
    for x, y, height, course in exits(pattern, 7):
        away = np.array((x, y)) - pattern.centre
        assert height == 80.0 and np.hypot(*away) == pytest.approx(50.0)
        assert away @ (math.cos(course), math.sin(course)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("begin", "height", "radius", "why"),
    [
        (BEGIN, math.nan, 50.0, "finite numbers"),
        ((0.0, math.inf, 0.0, 0.0), 10.0, 50.0, "finite numbers"),
        (BEGIN, 80.0, 30.0, "a loiter radius of 30 m; the aircraft turns with 40 m or more"),
        (BEGIN, 80.0, math.nan, "a loiter radius of nan m"),
        (BEGIN, 80.0, math.inf, "a loiter radius of inf m"),
    ],
)
def test_what_makes_no_sense_is_refused(begin, height, radius, why):
    with pytest.raises(ValueError, match=why):
        plan_loiter(Airspace(), LIMITS, begin, height, radius)


def test_spacing_that_makes_no_sense_is_refused():
    with pytest.raises(ValueError, match="a spacing of 0 m"):
        plan_loiter(Airspace(), LIMITS, BEGIN, 80.0, 50.0).sampled(0.0)
