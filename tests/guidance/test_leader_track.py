"""The trail of a leader: where it was when, how it flew there, and which spot a follower is beside."""

import math

import numpy as np
import pytest

from uvf.guidance.leader_track import KEPT, LeaderReport, LeaderTrack

SPEED, RADIUS = 25.0, 100.0


def told(t, north, east, course, height=100.0, climb=0.0, speed=SPEED, airspeed=SPEED):
    return LeaderReport(t, north, east, height, speed * math.cos(course), speed * math.sin(course), climb, airspeed)


def straight(seconds=20.0, airspeed=SPEED):
    """North, heard 50 times a second."""
    trail = LeaderTrack()
    for i in range(round(seconds * 50) + 1):
        trail.add(told(i / 50, SPEED * i / 50, 0.0, 0.0, airspeed=airspeed))
    return trail


def circling(seconds=20.0):
    """Clockwise about the origin, begun in the north, climbing at 1 m/s."""
    trail = LeaderTrack()
    for i in range(round(seconds * 50) + 1):
        angle = SPEED / RADIUS * i / 50
        place = RADIUS * math.cos(angle), RADIUS * math.sin(angle)
        trail.add(told(i / 50, *place, angle + math.pi / 2, height=100 + i / 50, climb=1.0))
    return trail


def test_a_spot_is_where_the_leader_was():
    spot = straight().at(7.33)
    assert (spot.t, spot.north, spot.east, spot.height) == pytest.approx((7.33, SPEED * 7.33, 0.0, 100.0))
    assert (spot.speed, spot.climb, spot.curvature) == pytest.approx((SPEED, 0.0, 0.0))


def test_it_goes_straight_on_at_both_ends():
    trail = straight()
    assert trail.at(-4.0).north == pytest.approx(-100.0)
    assert trail.at(22.0).north == pytest.approx(550.0)


def test_curvature_and_climb_are_those_of_the_flight():
    spot = circling().at(10.0)
    assert spot.curvature == pytest.approx(1 / RADIUS, rel=0.01)
    assert spot.climb == pytest.approx(1.0, rel=0.01)
    assert spot.height == pytest.approx(110.0)


def test_the_course_goes_on_past_north():
    trail = circling(seconds=40.0)
    courses = np.array([trail.at(t).course for t in np.arange(1.0, 39.0, 0.05)])
    assert np.abs(np.diff(courses)).max() < 0.02


def test_the_nearest_spot_is_abeam():
    spot = straight().nearest((131.3, 40.0))
    assert (spot.north, spot.east) == pytest.approx((131.3, 0.0))
    assert spot.t == pytest.approx(131.3 / SPEED)


def test_on_a_second_round_the_spot_of_that_round_is_meant():
    round_trip = math.tau * RADIUS / SPEED
    trail = circling(seconds=1.8 * round_trip)
    here = (RADIUS + 5.0, 1.0)
    first, second = trail.nearest(here, about=1.0), trail.nearest(here, about=round_trip + 1.0)
    assert second.t - first.t == pytest.approx(round_trip, abs=0.05)


def test_the_pace_is_that_through_the_air():
    assert straight(airspeed=17.0).pace == pytest.approx(17.0)


def test_what_is_old_is_forgotten():
    trail = straight(seconds=KEPT + 30.0)
    assert trail.at(10.0).north == pytest.approx(250.0, abs=0.1)  # straight on from the oldest
    assert len(trail._t) <= KEPT / 0.1 + 2


@pytest.mark.parametrize("bad", [told(5.0, math.nan, 0.0, 0.0), told(3.0, 9.0, 9.0, 0.0)])
def test_broken_and_old_reports_tell_nothing(bad):
    trail = straight(seconds=4.0)
    trail.add(bad)
    assert trail.newest.t == pytest.approx(4.0)


def gusty(seconds):
    """North, through gusts of 5 s."""
    trail, air = LeaderTrack(), SPEED + 2 * np.sin(2 * math.pi * np.arange(round(seconds * 50) + 1) / 250)
    for i, airspeed in enumerate(air):
        trail.add(told(i / 50, SPEED * i / 50, 0.0, 0.0, airspeed=airspeed))
    return trail, air


@pytest.mark.parametrize(("seconds", "over"), [(12.0, 12.0), (47.0, 20.0)])
def test_the_pace_is_the_mean_airspeed_and_its_rate_tells_how_that_changes(seconds, over):
    trail, air = gusty(seconds)
    assert trail.pace == pytest.approx(air[-round(50 * over) :].mean(), abs=0.02)
    (earlier, _), (later, _) = gusty(seconds - 0.1), gusty(seconds + 0.1)
    assert trail.pace_rate == pytest.approx((later.pace - earlier.pace) / 0.2, abs=0.01)
