import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.maths.curves import dubins_path
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.transits import Motion, moved, quickest, segments_of

POSE = st.tuples(st.floats(-300, 300), st.floats(-300, 300), st.floats(-7, 7))


def motion(radius=50.0, wind=(0.0, 0.0)):
    return Motion(radius, GroundSpeed(25.0, wind).table, 25.0, wind)


@settings(max_examples=200, deadline=None)
@given(POSE, POSE)
def test_without_wind_the_quickest_path_is_the_shortest_dubins_path(start, end):
    time, _ = quickest(np.array(start), np.array(end), motion())
    assert time * 25.0 == pytest.approx(dubins_path(start, end, 50.0).length, abs=1e-3)


@settings(max_examples=100, deadline=None)
@given(POSE, POSE)
def test_in_wind_its_segments_end_where_they_should_and_take_its_time(start, end):
    wind = (8.0, -5.0)
    speed = GroundSpeed(25.0, wind)
    time, _ = quickest(np.array(start), np.array(end), motion(wind=wind))
    pose, passed = np.array(start), 0.0
    for x, y, course, curvature, length in segments_of(np.array(start), np.array(end), motion(wind=wind)):
        assert (x, y) == pytest.approx(tuple(pose[:2]), abs=1e-5)
        courses = course + curvature * (np.arange(400) + 0.5) * length / 400
        passed += float((length / 400 / speed.at(courses)).sum())
        pose = moved(np.array((x, y, course)), curvature, length)
    assert tuple(pose[:2]) == pytest.approx(end[:2], abs=1e-4)
    assert math.cos(pose[2] - end[2]) == pytest.approx(1.0)
    assert passed == pytest.approx(time, rel=1e-3, abs=1e-3)


def test_in_wind_the_quickest_path_is_not_always_the_shortest():
    wind, rng, gained = (20.0, 0.0), np.random.default_rng(1), 0
    speed = GroundSpeed(25.0, wind)
    for _ in range(100):
        start, end = tuple(rng.uniform(-100, 100, 3).tolist()), tuple(rng.uniform(-100, 100, 3).tolist())
        path = dubins_path(start, end, 50.0)
        ways = zip(path.joints, path.turns, path.lengths, strict=False)
        shortest = sum(speed.time(joint[2], turn / 50.0, length) for joint, turn, length in ways)
        time, _ = quickest(np.array(start), np.array(end), motion(wind=wind))
        assert time <= shortest + 1e-3
        gained += time < shortest - 0.5
    assert gained >= 2


def test_ground_speed_is_that_of_the_wind_triangle():
    speed = GroundSpeed(20.0, (12.0, 0.0))
    assert speed.at(0.0) == pytest.approx(32.0)
    assert speed.at(math.pi) == pytest.approx(8.0)
    assert speed.at(math.pi / 2) == pytest.approx(16.0)  # 12, 16, 20
    assert speed.time(0.3, 0.0, 100.0) == pytest.approx(100.0 / float(speed.at(0.3)))
    whole = sum(1.0 / float(speed.at(c)) for c in np.linspace(0, 2 * np.pi, 5_000, endpoint=False)) * 2 * np.pi / 5_000
    assert speed.time(1.0, -1 / 50.0, 2 * np.pi * 50.0) == pytest.approx(50.0 * whole, rel=1e-5)


@pytest.mark.parametrize(("airspeed", "wind"), [(20.0, (20.0, 0.0)), (20.0, (15.0, 15.0)), (0.0, (0.0, 0.0)), (20.0, (math.nan, 0.0))])
def test_wind_too_strong_is_refused(airspeed, wind):
    with pytest.raises(ValueError, match="m/s"):
        GroundSpeed(airspeed, wind)


def test_without_a_radius_it_turns_on_the_spot():
    start, end = np.array((0.0, 0.0, 1.0)), np.array((30.0, 40.0, -2.0))
    assert quickest(start, end, motion(0.0))[0] == pytest.approx(2.0)
    assert len(segments_of(start, end, motion(0.0))) == 1
    assert len(segments_of(start, start, motion(0.0))) == 0
