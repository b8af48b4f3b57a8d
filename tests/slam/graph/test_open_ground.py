"""Open ground, where little of a sweep comes back and most of that walks: an odometry that knows how good it is, is held to."""

from dataclasses import replace
from math import isnan, nan

import numpy as np
import pytest

from uvf.maths.se2 import Pose2, inverse, transform
from uvf.slam.graph.method import GraphSlam
from uvf.slam.graph.motion import ALLOWANCE, LEAST_HEADING, MotionNoise, OdometryMotion
from uvf.slam.graph.trust import Trust
from uvf.slam.reading import Beams, Reading

BEAMS = Beams((0.0, 0.0), np.radians(np.linspace(-135.0, 135.0, 541)), 0.1, 10.0)
PILLARS = np.array(((4.0, 5.0, 0.2), (9.0, -6.0, 0.2), (14.0, 5.0, 0.2), (18.0, -5.0, 0.2)))  # x, y, radius [m]
STEP = 0.04  # m, every 0.1 s


def sweep(discs, pose):
    """(541,) ranges [m] of discs (k, 3)."""
    middle = transform(inverse(pose), discs[:, :2])
    along = middle @ BEAMS.directions.T
    across = np.abs(middle[:, :1] * BEAMS.directions[:, 1] - middle[:, 1:] * BEAMS.directions[:, 0])
    met = (across < discs[:, 2:]) & (along > 0.0)
    ranges = np.where(met, along - np.sqrt(np.maximum(discs[:, 2:] ** 2 - across**2, 0.0)), np.inf).min(axis=0)
    return np.where(ranges < BEAMS.range_max, ranges, 0.0)


def across_the_square(says):
    """A straight drive of 16 m among people who all walk to its left; the heading drifts by 0.02 mrad a step, and it says so or not."""
    rng, slam, heading = np.random.default_rng(3), GraphSlam(), 0.0
    for k in range(400):
        x, heading = STEP * k, heading + 2e-5
        places = np.arange(6)
        people = np.column_stack((x + 1.5 + 0.5 * (places % 3), (0.09 * k + 1.3 * places) % 8.0 - 4.0, np.full(6, 0.25)))
        ranges = sweep(np.vstack((PILLARS, people)), Pose2(x, 0.0, 0.0))
        noisy = np.where(ranges > 0.0, ranges + 0.01 * rng.standard_normal(len(ranges)), 0.0)
        reading = Reading(0.1 * k, noisy, BEAMS, Pose2(x, 0.5 * x * heading, heading), 1e-6 + 1e-8 * k if says else nan)
        estimate = slam.add(reading)
    return abs(estimate.map_from_base.yaw)


def test_people_do_not_turn_the_map_of_who_knows_its_heading():
    assert across_the_square(says=True) < 0.04
    assert across_the_square(says=False) > 0.08


READING = Reading(0.0, np.zeros(541), BEAMS, Pose2(0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("before", "now", "expected"), [(0.01, 0.05, 0.2), (0.01, 0.01, None), (0.05, 0.01, None), (nan, 0.01, None), (0.01, nan, None)]
)
def test_an_odometry_that_does_not_grow_less_certain_says_nothing(before, now, expected):
    first, second = (replace(READING, heading_variance=variance) for variance in (before, now))
    assert second.heading_sigma_since(first) == (None if expected is None else pytest.approx(expected))
    assert isnan(READING.heading_variance)


@pytest.mark.parametrize("claimed", [0.0, 1e-3, 10.0])
def test_a_claim_counts_with_some_allowance_and_only_where_it_is_the_smaller_one(claimed):
    motion = OdometryMotion(Pose2(0.0, 0.0, 0.0), Pose2(0.1, 0.0, 0.05), MotionNoise())
    usual, found = Trust().information(motion), Trust().information(replace(motion, claimed=claimed))
    assert found[2, 2] ** -0.5 == pytest.approx(min(max(ALLOWANCE * claimed, LEAST_HEADING), usual[2, 2] ** -0.5))
    np.testing.assert_array_equal(found[:2, :2], usual[:2, :2])
