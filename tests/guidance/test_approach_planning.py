import math
from dataclasses import replace

import numpy as np
import pytest

from uvf.guidance.approach import approach_fault, laid_down
from uvf.guidance.approach_planning import ApproachSite, plan_approach
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip
from uvf.guidance.vector_field import turn_radius
from uvf.models.vehicle.flight_params import AirParams

STRIP = LandingStrip(Place(0.0, 0.0, 0.0), math.pi / 2, 300.0, 12.0)  # from west to east
PARAMS = AirParams()


def flat(places):
    return np.zeros(len(places))


def wall(north, east, height, size=40.0):
    """A block [m] over flat ground."""

    def tops(places):
        inside = (np.abs(places[:, 0] - north) < size) & (np.abs(places[:, 1] - east) < size)
        return np.where(inside, height, 0.0)

    return tops


@pytest.mark.parametrize(("wind", "course"), [((0.0, -6.0), 90.0), ((0.0, 6.0), 270.0), ((4.0, -2.0), 90.0)])
def test_it_lands_against_the_wind_and_the_mission_means_the_same(wind, course):
    found = plan_approach(ApproachSite(STRIP, wind, flat), PARAMS)
    assert found.why == ""
    assert math.degrees(found.approach.course) % 360 == pytest.approx(course)
    assert abs(found.approach.radius) >= turn_radius(PARAMS.trim_airspeed + math.hypot(*wind), PARAMS.turn_bank)
    same = laid_down(found.items, 1, PARAMS)
    assert same.length == pytest.approx(found.approach.length) and same.height == pytest.approx(found.approach.height)
    assert math.cos(same.course - found.approach.course) == pytest.approx(1.0)
    assert approach_fault(found.items, 1, PARAMS) == ""


def test_a_hill_beside_the_final_approach_moves_the_circle_to_the_other_side():
    calm = plan_approach(ApproachSite(STRIP, (0.0, -5.0), flat), PARAMS)
    there = calm.circle
    moved = plan_approach(ApproachSite(STRIP, (0.0, -5.0), wall(2 * there.north, there.east, 200.0, 50.0)), PARAMS)
    assert moved.why == ""
    assert math.copysign(1.0, moved.approach.radius) == -math.copysign(1.0, calm.approach.radius)


def test_a_tree_before_the_strip_makes_the_glide_steeper_and_a_tower_turns_it_round():
    tree = plan_approach(ApproachSite(STRIP, (0.0, -1.0), wall(0.0, -400.0, 14.0, 20.0)), PARAMS)
    assert tree.approach.slope > math.tan(PARAMS.glide_slope)
    aim = tree.approach.place
    distance = abs(aim.east - -380.0)
    assert tree.approach.slope * distance >= 14.0 + 15.0 - 1.0
    around = plan_approach(ApproachSite(STRIP, (0.0, -1.0), wall(0.0, -300.0, 60.0, 20.0)), PARAMS)
    assert around.approach is None or math.degrees(around.approach.course) % 360 == pytest.approx(270.0)


def test_why_none_fits_is_said_for_both_directions():
    found = plan_approach(ApproachSite(STRIP, (12.0, -3.0), flat), PARAMS)
    assert found.approach is None and found.items == ()
    assert "90 deg: a crosswind of 12.0 m/s" in found.why and "270 deg: a tailwind of 3.0 m/s" in found.why
    valley = plan_approach(ApproachSite(STRIP, (0.0, -3.0), lambda p: np.where(np.abs(p[:, 1]) > 250.0, 150.0, 0.0)), PARAMS)
    assert valley.approach is None and "go-around" in valley.why


def test_a_higher_clearance_means_a_longer_or_steeper_approach():
    low, high = (plan_approach(ApproachSite(STRIP, (0.0, -4.0), flat, clearance=c), PARAMS).approach for c in (5.0, 60.0))
    assert high.height >= 60.0 > low.height
    assert high.length > low.length


@pytest.mark.parametrize("changes", [{"wind": (math.nan, 0.0)}, {"clearance": -1.0}, {"tailwind": math.inf}])
def test_numbers_that_make_no_sense_are_refused(changes):
    with pytest.raises(ValueError, match="give"):
        replace(ApproachSite(STRIP, (0.0, 0.0), flat), **changes)
