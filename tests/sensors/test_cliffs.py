"""Which range finders look at the floor, where, and what they measure of it."""

import pytest

from uvf.models.vehicle.sensors import Mount, RangeFinder
from uvf.sensors.cliffs import floor_sights


def finder(xyz, rpy, range_max=0.5, frame="f"):
    return RangeFinder(Mount(xyz, rpy), hz=20.0, range_min=0.01, range_max=range_max, frame=frame)


def test_a_beam_straight_down_meets_the_floor_below_it():
    sight = floor_sights([finder((0.2, -0.1, 0.06), (0.0, 1.5708, 0.0))])["f"]
    assert sight.place == pytest.approx((0.2, -0.1), abs=1e-5)
    assert sight.length == pytest.approx(0.06)


def test_a_beam_that_leans_meets_it_ahead():
    sight = floor_sights([finder((0.1, 0.0, 0.1), (0.0, 1.0, 1.5708))])["f"]
    assert sight.place == pytest.approx((0.1, 0.1 / 1.5574), abs=1e-3)


@pytest.mark.parametrize(
    ("xyz", "rpy", "range_max"),
    [((0.1, 0.0, 0.1), (0.0, 0.0, 0.0), 0.5), ((0.1, 0.0, 0.1), (0.0, -1.5, 0.0), 0.5), ((0.1, 0.0, 0.6), (0.0, 1.5, 0.0), 0.5)],
    ids=["level", "up", "out of reach"],
)
def test_others_do_not_look_at_the_floor(xyz, rpy, range_max):
    assert floor_sights([finder(xyz, rpy, range_max)]) == {}


@pytest.mark.parametrize(("measured", "ended"), [(0.06, False), (0.08, False), (0.02, False), (0.1, True), (0.0, True), (-1.0, True)])
def test_the_floor_has_ended_where_the_beam_is_longer_or_does_not_come_back(measured, ended):
    assert floor_sights([finder((0.2, 0.0, 0.06), (0.0, 1.5708, 0.0))])["f"].has_ended(measured) is ended
