"""How long ago a ground vehicle has seen anything."""

import pytest

from schemas.messages import FrameTransform, LaserScan
from services.autopilot.ground.sight import MOVED, SensorWatch
from uvf.runtime.messages.convert import stamp
from uvf.sensors.sweeping import AT_ONCE, Sweeping


def scan(t, ahead=1.0):
    return LaserScan(timestamp=stamp(t), ranges=[ahead])


@pytest.mark.parametrize(("sweeping", "unseen"), [(AT_ONCE, 0.3), (Sweeping(0.2), 0.1)])
def test_a_scan_is_as_old_as_its_last_beam(sweeping, unseen):
    sight = SensorWatch({"": sweeping})
    sight.step(3.0, [], None, 0.0)
    assert (sight.unseen, sight.map_age) == (0.0, 0.0)
    sight.step(3.3, [scan(3.0)], None, 0.0)
    assert sight.unseen == pytest.approx(unseen)


def test_a_scan_that_stays_the_same_while_the_wheels_turn_is_not_seen():
    sight = SensorWatch({"": AT_ONCE})
    sight.step(1.0, [scan(1.0)], None, 0.0)
    sight.step(2.0, [scan(2.0)], None, 0.5 * MOVED)
    assert sight.unseen == 0.0
    sight.step(3.0, [scan(3.0)], None, 2.0 * MOVED)
    assert sight.unseen == pytest.approx(1.0)
    sight.step(4.0, [scan(4.0, 1.1)], None, 3.0 * MOVED)
    assert sight.unseen == 0.0


def test_a_mapping_that_falls_silent_is_told_apart():
    sight = SensorWatch({"": AT_ONCE})
    sight.step(1.0, [scan(1.0)], FrameTransform(timestamp=stamp(1.0)), 0.0)
    sight.step(2.0, [scan(2.0)], None, 0.0)
    assert (sight.unseen, sight.map_age) == (0.0, pytest.approx(1.0))


@pytest.mark.parametrize("ranges", [[0.0] * 36, [float("inf")] * 36, []])
def test_in_open_space_a_lidar_that_sees_nothing_has_not_frozen(ranges):
    sight = SensorWatch({"": AT_ONCE})
    for k in range(50):
        sight.step(0.1 * k, [LaserScan(timestamp=stamp(0.1 * k), ranges=ranges)], None, 0.05 * k)
    assert sight.unseen == 0.0


def test_of_several_lidars_the_one_counts_that_was_heard_longest_ago():
    sight = SensorWatch({"v/front": AT_ONCE, "v/rear": AT_ONCE})

    def hear(t, *frames):
        told = [LaserScan(timestamp=stamp(t), frame_id=frame, ranges=[t]) for frame in frames]
        sight.step(t, told, None, 0.0)
        return sight.unseen

    assert hear(1.0, "v/front", "v/rear") == 0.0
    assert hear(2.0, "v/front") == pytest.approx(1.0)
    assert hear(2.5, "v/stranger") == pytest.approx(1.5)
    assert hear(3.0, "v/rear") == pytest.approx(1.0)


def test_a_lidar_that_never_speaks_is_missed_from_the_first_scan_of_the_others_on():
    sight = SensorWatch({"v/front": AT_ONCE, "v/rear": AT_ONCE})
    for t in (5.0, 6.0, 7.0):
        sight.step(t, [LaserScan(timestamp=stamp(t), frame_id="v/front", ranges=[t])], None, 0.0)
    assert sight.unseen == pytest.approx(2.0)
