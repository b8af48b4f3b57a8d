"""Slip is told once an episode, with what disagrees; scans that do not follow the wheels are noticed."""

import pytest

from uvf.estimation.odometry.slip import Episodes, MatchedMotion, WheelWatch
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


@pytest.mark.parametrize(("followed", "noticed"), [(1.0, False), (0.97, False), (0.6, True), (0.0, True), (-0.5, True)])
def test_scans_that_see_less_of_the_way_are_noticed(followed, noticed):
    motion, causes = MatchedMotion(), []
    for k in range(40):
        way = 0.03 * k
        causes.append(motion.compare(0.1 * k, Pose2(way, 0.0, 0.0), Pose2((followed - 1.0) * way, 0.0, 0.0)))
    assert (causes[-1] is not None) == noticed
    assert not any(causes[:15])
    assert causes[-1] is None or causes[-1].speed == pytest.approx(0.3 * followed, abs=0.01)


def test_a_correction_while_standing_is_no_slip():
    motion = MatchedMotion()
    assert not any(motion.compare(0.1 * k, IDENTITY, Pose2(0.01 * k, 0.0, 0.0)) for k in range(40))


def test_time_that_begins_anew_compares_nothing():
    motion = MatchedMotion()
    for k in range(30):
        motion.compare(100.0 + 0.1 * k, Pose2(0.03 * k, 0.0, 0.0), IDENTITY)
    assert motion.compare(0.0, Pose2(5.0, 0.0, 0.0), Pose2(-5.0, 0.0, 0.0)) is None
