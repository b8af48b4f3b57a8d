"""Slip is told once an episode, with what disagrees; scans that do not follow the wheels are noticed."""

from math import copysign

import pytest

from uvf.estimation.odometry.slip import BLUR, Episodes, MatchedMotion, WheelWatch
from uvf.maths.kinematics import Twist, move
from uvf.maths.se2 import IDENTITY, Pose2

DT = 0.02


def test_a_wheel_is_not_believed_for_one_large_or_many_small_differences():
    watch = WheelWatch()
    assert watch.believes(0.01, 1e-4, DT)
    assert not watch.believes(0.1, 1e-4, DT)
    patient = WheelWatch()
    believed = [patient.believes(0.025, 1e-4, DT) for _ in range(100)]
    assert all(believed[:5]) and not any(believed[-50:])


def test_noise_is_believed():
    watch = WheelWatch()
    assert all(watch.believes(0.025 * (-1) ** k, 1e-4, DT) for k in range(200))


def test_each_episode_is_told_once_and_a_single_doubt_is_none():
    episodes, told = Episodes(), []
    for k in range(1000):
        slips = 100 <= k < 250 or 260 <= k < 300 or 600 <= k < 650 or k == 50
        episode = episodes.step("because" if slips else None, DT)
        if episode is not None:
            told.append((k, episode.cause))
    assert [(round(k, -1), cause) for k, cause in told] == [(100, "because"), (600, "because")]
    assert not episodes.active


def driven(motion, speed, matched, start=0.0, until=8.0, every=10):
    """What is found at each match, every 0.2 s or as many steps: the wheels roll at ``speed``, and scans are matched at ``matched(t)``."""
    found = []
    for k in range(1, round(until / DT)):
        motion.roll(start + k * DT, speed * DT)
        if k % every == 0:
            found.append(motion.compare(start + k * DT, matched(k * DT)))
    return found


@pytest.mark.parametrize(("followed", "noticed"), [(1.0, False), (0.97, False), (0.6, True), (0.0, True), (-0.5, True)])
@pytest.mark.parametrize("speed", [0.3, -0.3, 1.0])
def test_scans_that_see_less_of_the_way_are_noticed(speed, followed, noticed):
    found = driven(MatchedMotion(), speed, lambda t: Pose2(followed * speed * t, 0.0, 0.0))
    assert (found[-1] is not None) == noticed
    assert not any(found[:8])
    seen = max(followed * abs(speed), -BLUR / 0.2)  # nobody rolls on and is carried back, but for the matches' noise
    assert found[-1] is None or found[-1].speed * copysign(1.0, speed) == pytest.approx(seen, abs=0.01)


def test_a_correction_while_standing_is_no_slip():
    assert not any(driven(MatchedMotion(), 0.0, lambda t: Pose2(0.1 * t, 0.0, 0.0)))


@pytest.mark.parametrize("back", [-0.5, -0.2, 0.5])
@pytest.mark.parametrize(("speed", "every"), [(0.2, 10), (0.6, 10), (1.5, 5), (0.4, 20), (0.3, 40)])
def test_a_closed_loop_is_no_slip(back, speed, every):
    """The matches move by half a metre at once."""
    found = driven(MatchedMotion(), speed, lambda t: Pose2(speed * t + back * (t >= 4.0), 0.0, 0.0), until=12.0, every=every)
    assert not any(found)


@pytest.mark.parametrize("every", [5, 10, 20, 25, 30, 35, 40, 45, 50, 60, 75, 100])
def test_slip_is_seen_however_often_scans_are_matched(every):
    found = driven(MatchedMotion(), 0.4, lambda t: Pose2(0.5 * 0.4 * t, 0.0, 0.0), until=20.0, every=every)
    assert all(found[-3:])
    assert [one.speed for one in found[-3:]] == pytest.approx([0.2] * 3)


def test_an_arc_is_no_slip():
    assert not any(driven(MatchedMotion(), 0.5, lambda t: move(IDENTITY, Twist(0.5, 1.5), t)))


@pytest.mark.parametrize("back", [0.03, 0.1, 0.5, 100.0])
def test_time_that_goes_back_compares_nothing(back):
    motion = MatchedMotion()
    driven(motion, 0.3, lambda t: Pose2(0.3 * t, 0.0, 0.0), 100.0)
    assert not any(driven(motion, 0.3, lambda t: Pose2(0.3 * t - 5.0, 0.0, 0.0), 108.0 - back))


@pytest.mark.parametrize("t", [-1.0, 8.5])
def test_a_scan_from_before_the_memory_or_from_the_future_compares_nothing(t):
    motion = MatchedMotion()
    assert motion.compare(0.0, IDENTITY) is None
    driven(motion, 0.3, lambda t: IDENTITY)
    assert motion.compare(t, IDENTITY) is None
