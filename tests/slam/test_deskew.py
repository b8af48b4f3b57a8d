"""Sweeps that took their time."""

import numpy as np
import pytest

from benchmarks.slam.evaluation.building import cast
from tests.slam.matching.walls import ROOM, seen
from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.slam.deskew import SPACING, deskewed, straightened
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.reading import Beams, Reading

BEARINGS = np.radians(np.arange(-180.0, 180.0))


def swept(room_from_last, last_from_first, beams):
    """Each beam cast from where the lidar is at its moment."""
    ranges = []
    for share, direction in zip(np.linspace(1.0, 0.0, len(beams.bearings)), beams.directions, strict=True):
        base = compose(room_from_last, Pose2(*(share * np.array(last_from_first))))
        lidar = compose(base, Pose2(*beams.origin, 0.0))
        ranges.append(cast(np.array(lidar), direction[None], ROOM, 30.0)[0])
    return Reading(0.0, np.array(ranges), beams, IDENTITY)


def off_the_walls(reading, room_from_base):
    """(n,) m, of the points of a reading."""
    c, s = np.cos(room_from_base.yaw), np.sin(room_from_base.yaw)
    points = cloud_of(reading).points @ np.array(((c, s), (-s, c))) + np.array(room_from_base[:2])
    start, along = ROOM[:, :2], ROOM[:, 2:] - ROOM[:, :2]
    reach = points[:, None] - start
    share = np.clip((reach * along).sum(axis=2) / (along**2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(reach - share[..., None] * along, axis=2).min(axis=1)


@pytest.mark.parametrize("motion", [Pose2(0.0, 0.0, -0.3), Pose2(-0.15, 0.0, 0.2), Pose2(-0.2, 0.03, 0.0)], ids=["turn", "arc", "ahead"])
@pytest.mark.parametrize("bearings", [BEARINGS, BEARINGS[::-1].copy()], ids=["left about", "right about"])
@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.2, -0.1)], ids=["in the middle", "ahead"])
def test_a_room_seen_on_the_move_is_set_straight(motion, bearings, origin):
    place = Pose2(0.3, 0.2, 0.4)
    reading = swept(place, motion, Beams(origin, bearings, 0.1, 30.0, duration=0.2))
    assert np.quantile(off_the_walls(reading, place), 0.9) > 0.02
    straight = deskewed(reading, np.array((motion, IDENTITY)))
    assert off_the_walls(straight, place).max() < 1e-6
    assert straight.beams.duration == 0.0


def test_a_standing_lidar_sees_the_same():
    beams = Beams((0.1, 0.0), BEARINGS, 0.1, 30.0, duration=0.2)
    reading = Reading(0.0, seen(ROOM, beams=beams).ranges, beams, IDENTITY)
    straight = deskewed(reading, np.zeros((2, 3)))
    np.testing.assert_allclose(straight.ranges, reading.ranges, atol=1e-9)
    np.testing.assert_allclose(straight.beams.directions, beams.directions, atol=1e-9)


def test_a_sweep_taken_at_once_is_left_as_it_is():
    reading = seen(ROOM)
    assert deskewed(reading, np.array((Pose2(0.1, 0.0, 0.3), IDENTITY))) is reading


def test_what_did_not_come_back_still_does_not():
    beams = Beams((0.0, 0.0), BEARINGS, 0.1, 30.0, duration=0.2)
    ranges = np.full(360, 2.0)
    ranges[:6] = (np.nan, np.inf, 0.0, -1.0, 30.0, 99.0)
    straight = deskewed(Reading(0.0, ranges, beams, IDENTITY), np.array((Pose2(0.1, 0.0, 0.2), IDENTITY)))
    assert straight.returned.tolist() == [False] * 6 + [True] * 354


@pytest.mark.parametrize("n", [0, 1])
def test_a_sweep_of_one_beam_has_no_skew(n):
    reading = Reading(0.0, np.ones(n), Beams((0.0, 0.0), np.zeros(n), 0.1, 30.0, duration=0.1), IDENTITY)
    assert deskewed(reading, np.array((Pose2(0.1, 0.0, 0.0), IDENTITY))) is reading


def test_a_disturbed_beam_still_says_nothing_and_a_free_one_is_still_free():
    beams = Beams((0.0, 0.0), BEARINGS, 0.1, 30.0, duration=0.2)
    ranges = np.full(360, 2.0)
    ranges[:6] = (np.nan, 0.05, -1.0, np.inf, 0.0, 30.0)
    straight = deskewed(Reading(0.0, ranges, beams, IDENTITY), np.array((Pose2(0.1, 0.0, 0.2), IDENTITY)))
    assert np.isnan(straight.ranges[:3]).all()
    assert np.isinf(straight.ranges[3:6]).all()


def test_what_has_come_back_is_not_lost_at_the_limits():
    """Driving ahead brings what was 0.12 m ahead nearer, and what was 2.99 m behind farther away."""
    beams = Beams((0.0, 0.0), BEARINGS, 0.12, 3.0, duration=0.2)
    ranges = np.where(np.abs(BEARINGS) < 0.1, 0.25, 2.99)
    straight = deskewed(Reading(0.0, ranges, beams, IDENTITY), np.array((Pose2(-0.3, 0.0, 0.0), IDENTITY)))
    assert straight.ranges.min() < 0.12 and straight.ranges.max() > 3.0
    assert straight.returned.all()


def test_a_turn_of_more_than_half_about_is_followed_all_the_way():
    turn = np.linspace(-4.0, 0.0, 9)
    beams = Beams((0.0, 0.0), BEARINGS, 0.1, 30.0, duration=1.0)
    place = Pose2(0.3, 0.2, 0.4)
    poses = np.column_stack((np.zeros((9, 2)), (turn + np.pi) % (2 * np.pi) - np.pi))
    straight = deskewed(swept(place, Pose2(0.0, 0.0, -4.0), beams), poses)
    assert off_the_walls(straight, place).max() < 1e-6


def test_the_odometry_is_asked_for_at_moments_within_the_sweep():
    beams, asked = Beams((0.0, 0.0), BEARINGS, 0.1, 30.0, duration=0.2), []

    def odom_from_base(times):
        asked.extend(times)
        return np.column_stack((times, times**2, 0.1 * times))

    reading = straightened(np.full(360, 2.0), beams, 3.0, odom_from_base)
    assert (asked[0], asked[-1], reading.t) == pytest.approx((3.0, 3.2, 3.2))
    assert 0.0 < np.diff(asked).max() <= SPACING + 1e-9
    assert reading.odom_from_base == pytest.approx((3.2, 3.2**2, 0.32))
    once = straightened(np.full(360, 2.0), seen(ROOM).beams, 3.0, odom_from_base)
    assert (once.t, once.odom_from_base) == (3.0, pytest.approx((3.0, 9.0, 0.3)))
