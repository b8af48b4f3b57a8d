"""Open ground, where little of a sweep comes back and most of that walks: an odometry that knows how good it is, is held to."""

from dataclasses import replace

import numpy as np
import pytest

from uvf.maths.se2 import IDENTITY, Pose2, inverse, transform
from uvf.slam.graph.drift import TIED, PathLengths
from uvf.slam.graph.fitting import information_of
from uvf.slam.graph.method import GraphSlam
from uvf.slam.graph.motion import ALLOWANCE, LEAST_OFF, MotionNoise, OdometryMotion
from uvf.slam.graph.tracker import LocalMap, Tracker
from uvf.slam.graph.trust import Trust
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.imls import Match
from uvf.slam.matching.point_map import point_map
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


def across_the_square(says, walk=(0.0, 0.9), seed=3):
    """A straight drive of 16 m among people who all walk one way [m/s]; the heading drifts by 0.02 mrad a step, and it says so or not.

    Returns how far off the estimate is at the end: (heading [rad], position [m]).
    """
    rng, slam, heading = np.random.default_rng(seed), GraphSlam(), 0.0
    begun, speeds = rng.uniform((0.5, -4.0), (3.0, 4.0), (6, 2)), np.array(walk)
    for k in range(400):
        x, heading = STEP * k, heading + 2e-5
        gone = begun + 0.1 * k * speeds
        people = np.column_stack((x + gone[:, 0] % 3.0 + 0.5, (gone[:, 1] + 4.0) % 8.0 - 4.0, np.full(6, 0.25)))
        ranges = sweep(np.vstack((PILLARS, people)), Pose2(x, 0.0, 0.0))
        noisy = np.where(ranges > 0.0, ranges + 0.01 * rng.standard_normal(len(ranges)), 0.0)
        told = Pose2(x, 0.5 * x * heading, heading)
        estimate = slam.add(Reading(0.1 * k, noisy, BEAMS, told, (0.01, 0.002) if says else None))
    found = estimate.map_from_base
    return abs(found.yaw), float(np.hypot(found.x - x, found.y))


@pytest.mark.parametrize("seed", [3, 4])
@pytest.mark.parametrize("walk", [(0.0, 0.9), (0.0, -1.3), (0.6, 0.6)], ids=["left", "right, faster", "along and aside"])
def test_people_do_not_drag_the_map_of_who_knows_how_it_moves(walk, seed):
    heading, position = across_the_square(says=True, walk=walk, seed=seed)
    assert heading < 0.02
    assert position < 0.2


def test_people_do_drag_the_map_of_who_does_not_say():
    heading, position = across_the_square(says=False)
    assert heading > 0.08
    assert position > 10.0


def beside_a_fence(pose, y=-3.0):
    """(541,) ranges [m] of a straight fence without an end, along x at ``y`` [m]."""
    bearings = np.arctan2(*BEAMS.directions.T[::-1]) + pose.yaw
    with np.errstate(divide="ignore"):
        ranges = (y - pose.y) / np.sin(bearings)
    return np.where((ranges > 0.0) & (ranges < BEAMS.range_max), ranges, 0.0)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_fence_seen_twice_does_not_say_where_along_it(seed):
    """There and back beside a fence, which is all that is seen: the way along it is the odometry's."""
    rng, slam, errors = np.random.default_rng(seed), GraphSlam(), []
    there = [Pose2(0.1 * k, 0.0, 0.0) for k in range(400)]
    turn = [Pose2(40.0, 0.0, 0.1 * k) for k in range(32)]
    back = [Pose2(40.0 - 0.1 * k, 0.1 * min(k, 8), np.pi) for k in range(400)]
    for k, pose in enumerate((*there, *turn, *back)):
        ranges = beside_a_fence(pose)
        noisy = np.where(ranges > 0.0, ranges + 0.01 * rng.standard_normal(len(ranges)), 0.0)
        found = slam.add(Reading(0.2 * k, noisy, BEAMS, pose, (0.01, 0.002))).map_from_base
        errors.append(np.hypot(found.x - pose.x, found.y - pose.y))
    assert slam.closing.loops > 2
    assert max(errors) < 0.05


def test_a_match_tells_nothing_of_the_way_that_it_does_not_see():
    turn = np.array(((0.8, -0.6, 0.0), (0.6, 0.8, 0.0), (0.0, 0.0, 1.0)))
    information = information_of(Match(Pose2(1.5, 0.0, 0.0), turn @ np.diag((0.0, 1e5, 1e5)) @ turn.T, 1.0, 0.01))
    sigmas, ways = np.linalg.eigh(np.linalg.inv(information)[:2, :2])
    assert np.sqrt(sigmas) == pytest.approx([0.01, 10.0], abs=0.01)
    assert np.abs(ways[:, 1]) == pytest.approx([0.8, 0.6], abs=0.01)
    lengths = PathLengths()
    lengths.add(0, 1, 20.0)
    lengths.tie(0, 1, information)
    assert lengths.since(0, 2)[1] == 20.0
    lengths.tie(0, 2, np.diag((1e3, 1e3, 1e3)))
    assert lengths.since(0, 3)[2] == TIED


def test_of_several_edges_between_two_keyframes_the_shortest_counts():
    lengths = PathLengths()
    for i, j, length in ((0, 1, 20.0), (0, 1, 0.5), (1, 0, 0.3), (0, 1, 3.0)):
        lengths.add(i, j, length)
    assert lengths.since(0, 2)[1] == 0.3


READING = Reading(0.0, np.zeros(541), BEAMS, Pose2(0.0, 0.0, 0.0))


def test_a_motion_is_off_by_what_its_speeds_are_off_by_all_the_time():
    before, now = (replace(READING, t=t, rate_sigmas=(0.02, 0.004)) for t in (0.0, 0.5))
    assert now.claimed_since(before) == pytest.approx((0.01, 0.002))
    assert before.claimed_since(now) is None
    assert now.claimed_since(READING) is None
    assert READING.claimed_since(before) is None


@pytest.mark.parametrize("claimed", [(0.0, 0.0), (4e-3, 1e-3), (10.0, 10.0)])
def test_a_claim_counts_with_some_allowance_and_only_where_it_is_the_smaller_one(claimed):
    motion = OdometryMotion(Pose2(0.0, 0.0, 0.0), Pose2(0.1, 0.0, 0.05), MotionNoise())
    usual, found = Trust().information(motion), Trust().information(replace(motion, claimed=claimed))
    for axis, said, least in ((0, claimed[0], LEAST_OFF[0]), (1, claimed[0], LEAST_OFF[0]), (2, claimed[1], LEAST_OFF[1])):
        assert found[axis, axis] ** -0.5 == pytest.approx(min(max(ALLOWANCE * said, least), usual[axis, axis] ** -0.5))


def test_a_gyro_counts_beside_a_match_that_turns_the_sweep():
    """A fence to one side and posts to the other: what little bends all sweeps alike, the gyro does not see."""
    posts = np.column_stack((np.linspace(-5.0, 5.0, 21), np.full(21, 4.0), np.full(21, 0.4)))
    seen, turned = (cloud_of(Reading(0.0, sweep(posts, Pose2(0.0, 0.0, yaw)), BEAMS, IDENTITY)) for yaw in (0.0, 0.01))
    found = {}
    for claimed in (None, (1e-3, 2e-4)):
        motion = OdometryMotion(IDENTITY, IDENTITY, MotionNoise(), claimed=claimed)
        found[claimed] = Tracker().track(LocalMap(point_map([seen])), motion, turned).match.map_from_base.yaw
    assert found[None] > 0.005
    assert abs(found[1e-3, 2e-4]) < 0.5 * found[None]
