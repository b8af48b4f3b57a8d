"""What the tracker learns of a vehicle's odometry."""

import numpy as np
import pytest

from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.slam.graph.motion import UNKNOWN, MotionNoise, OdometryMotion
from uvf.slam.graph.trust import LEAST_TRUST, MOST_SIGMAS, Trust

NOISE = MotionNoise()
STEP = Pose2(0.1, 0.0, 0.0)


def taught(trust: Trust, steps: int, veers: float, step: Pose2 = STEP, noise: float = 0.0) -> Trust:
    """After sweeps that all fit; veers: rad per m and rad that the odometry does not notice."""
    rng = np.random.default_rng(1)
    for _ in range(steps):
        missed = veers * (np.hypot(step[0], step[1]) + abs(step[2])) + noise * rng.normal()
        trust.learn(step, trust.straightened(OdometryMotion(IDENTITY, step, NOISE)), Pose2(step[0], step[1], step[2] + missed))
    return trust


@pytest.mark.parametrize("veers", [-0.015, 0.01, 0.03])
def test_an_odometry_that_always_veers_is_set_straight(veers):
    trust = taught(Trust(), 300, veers, noise=0.002)
    step = trust.straightened(OdometryMotion(IDENTITY, STEP, NOISE)).step
    assert step.yaw == pytest.approx(veers * 0.1, rel=0.3)
    assert (step.x, step.y) == (STEP.x, STEP.y)


def test_what_it_loses_in_turns_is_learnt_apart():
    trust = taught(Trust(), 100, 0.04, step=Pose2(0.0, 0.0, 0.1))
    assert trust.heading_drift.straightened(Pose2(0.0, 0.0, 1.0)).yaw == pytest.approx(1.04, abs=0.01)
    assert trust.heading_drift.straightened(Pose2(1.0, 0.0, 0.0)).yaw == pytest.approx(0.0, abs=1e-6)


def test_a_gyro_is_not_set_straight_by_what_matches_have_in_common():
    turn = Pose2(0.0, 0.0, 0.08)
    trust = taught(Trust(), 100, -0.015, step=turn)
    wheels, gyro = (OdometryMotion(IDENTITY, turn, NOISE, claimed=claimed) for claimed in (None, (1e-3, 2e-4)))
    assert trust.straightened(wheels).step.yaw == pytest.approx(0.08 * 0.985, rel=0.003)
    assert abs(trust.straightened(gyro).step.yaw - 0.08) < 0.1 * 0.015 * 0.08


def test_another_floor_is_learnt_anew():
    trust = taught(taught(Trust(), 500, 0.02), 400, -0.02)
    assert trust.heading_drift.straightened(STEP).yaw == pytest.approx(-0.002, rel=0.1)


def test_one_match_that_is_far_off_teaches_little():
    trust, motion = taught(Trust(), 100, 0.0), OdometryMotion(IDENTITY, STEP, NOISE)
    trust.learn(STEP, motion, Pose2(0.1, 0.0, 2.0))
    assert abs(trust.heading_drift.straightened(STEP).yaw) < 0.1 * motion.sigmas[1]
    assert trust.heading < 1.0


def test_a_good_odometry_is_held_to_more_firmly_but_not_in_turns():
    trust, motion = taught(Trust(), 500, 0.0), OdometryMotion(IDENTITY, STEP, NOISE)
    assert trust.position == trust.heading == LEAST_TRUST
    np.testing.assert_allclose(trust.information(motion), motion.information / LEAST_TRUST**2)
    turn = OdometryMotion(IDENTITY, Pose2(0.0, 0.0, 2.0), NOISE)
    assert trust.information(turn)[2, 2] < 1.1 * turn.information[2, 2]


def test_a_bad_one_less_firmly():
    trust = Trust()
    for side in (0.2, -0.2) * 200:
        trust.learn(STEP, OdometryMotion(IDENTITY, STEP, NOISE), Pose2(0.1, side, 0.0))
    assert trust.position == pytest.approx(MOST_SIGMAS, rel=0.05)


@pytest.mark.parametrize("motion", [OdometryMotion(IDENTITY, STEP, UNKNOWN), OdometryMotion(IDENTITY, STEP, NOISE, disputed=True)])
def test_what_the_odometry_has_not_told_stays_as_it_is(motion):
    trust = taught(Trust(), 300, 0.02)
    assert trust.straightened(motion) is motion
    np.testing.assert_array_equal(trust.information(motion), motion.information)


def test_surprise_grows_with_the_way_to_where_the_odometry_has_it():
    trust, motion = Trust(), OdometryMotion(Pose2(1.0, 2.0, 0.5), STEP, NOISE)
    beside = [trust.surprise(motion, compose(motion.guess, Pose2(0.0, y, y / 2))) for y in (0.0, 0.02, 0.2, 2.0)]
    assert beside[0] == 0.0
    assert all(np.diff(beside) > 0.5)
    assert taught(Trust(), 300, 0.0).surprise(motion, compose(motion.guess, Pose2(0.0, 0.02, 0.0))) > beside[1]
