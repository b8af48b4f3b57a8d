"""A vehicle leaves what its map knows, and comes back; or is carried from there."""

import numpy as np
import pytest

from tests.planar_rays import rectangles
from tests.slam.localization.places import errors, map_of, readings
from tests.slam.room import CIRCLES, FURNITURE
from uvf.maths.se2 import Pose2, compose
from uvf.slam.localization.localizer import Localizer, LocalizerState
from uvf.slam.localization.params import FilterParams

WALLS = ((3.0, -2.0, 6.0, 0.05, 0.0), (3.0, 2.0, 6.0, 0.05, 0.0), (-3.0, 0.0, 0.05, 2.0, 0.0), (9.0, 0.0, 0.05, 2.0, 0.0))
DOOR = ((3.0, 1.25, 0.05, 0.75, 0.0), (3.0, -1.25, 0.05, 0.75, 0.0))
BEYOND = ((5.0, 1.4, 0.5, 0.3, 0.2), (7.4, -1.2, 0.3, 0.6, 0.0), (8.2, 1.3, 0.4, 0.4, 0.7))
PLACE = (rectangles(np.array(WALLS + DOOR + FURNITURE + BEYOND)), CIRCLES)
"""Two rooms and an open door between them; a map made in the left one sees a strip of the right one."""
THERE_AND_BACK = ((-1.0, 0.3), (2.0, 0.0), (4.5, 0.0), (6.0, 0.8), (8.0, 0.2), (6.0, -0.6), (4.5, 0.0), (2.0, 0.0), (0.0, 0.5), (-1.2, 0.4))


def along(corners, spacing=0.1):
    """(n, 3) poses along straight lines, turning by no more than 0.2 rad at once."""
    poses = []
    for a, b in zip(np.array(corners), np.array(corners)[1:], strict=False):
        yaw = np.arctan2(*(b - a)[::-1])
        if poses:
            yaw = poses[-1][2] + (yaw - poses[-1][2] + np.pi) % (2.0 * np.pi) - np.pi
            turns = np.linspace(poses[-1][2], yaw, int(abs(yaw - poses[-1][2]) / 0.2) + 2)[1:]
            poses += [(*a, turn) for turn in turns]
        steps = np.arange(1, int(np.hypot(*(b - a)) / spacing) + 1)[:, None] * spacing
        poses += [(*p, yaw) for p in a + steps * (b - a) / np.hypot(*(b - a))]
    return np.array(poses)


@pytest.fixture(scope="module")
def left_room():
    return map_of(PLACE)


def test_a_room_that_the_map_does_not_know_is_no_kidnapping(left_room):
    way = along(THERE_AND_BACK)
    localizer = Localizer(left_room, FilterParams(), 1, Pose2(*way[0].tolist()))
    estimates, states = [], []
    for reading in readings(PLACE, way):
        estimates.append(localizer.add(reading).map_from_base)
        states.append(localizer.state)
    metres, _ = errors(estimates, way)
    unknown = way[:, 0] > 4.0
    assert np.hypot(*np.diff(way[unknown, :2], axis=0).T).sum() > 6.0
    assert LocalizerState.LOST not in states
    assert metres[unknown].max() < 0.3 and metres[-10:].max() < 0.05


def test_who_is_carried_from_there_into_the_known_room_is_found_again(left_room):
    first, second = along(THERE_AND_BACK[:5]), along(((-2.0, 0.9), (0.5, 0.9), (1.8, -0.5), (0.0, 0.3), (-2.2, 0.3), (0.0, 0.9)))
    drive, then = readings(PLACE, first), readings(PLACE, second, seed=2)
    last = drive[-1].odom_from_base
    drive += [type(r)(r.t + 100.0, r.ranges, r.beams, compose(last, r.odom_from_base)) for r in then]
    localizer = Localizer(left_room, FilterParams(), 1, Pose2(*first[0].tolist()))
    estimates, states = [], []
    for reading in drive:
        estimates.append(localizer.add(reading).map_from_base)
        states.append(localizer.state)
    assert LocalizerState.LOST in states[len(first) :] and LocalizerState.LOST not in states[: len(first)]
    assert states[-1] is LocalizerState.TRACKING
    assert errors(estimates[-10:], second[-10:])[0].max() < 0.05
