"""The matcher finds offsets that are known, and knows when it cannot."""

import numpy as np
import pytest

from services.slam.correlative import search
from services.slam.occupancy import OccupancyMap
from services.slam.scan_match import match
from tests.planar_rays import rectangles
from tests.services.slam.room import measured, points
from uvf.maths.planar import IDENTITY, compose, transform
from uvf.maths.rotations import wrap

NOWHERE = np.zeros((0, 2))


def mapped(poses, rng, **room):
    occupancy = OccupancyMap(0.05)
    for pose in poses:
        hits = transform(pose, points(measured(pose, rng, **room)))
        occupancy.insert(hits, NOWHERE, np.array(pose[:2]))
    return occupancy


@pytest.fixture(scope="module")
def occupancy():
    return mapped([(0.1 * i, 0.05 * i, 0.3 * i) for i in range(4)], np.random.default_rng(1))


def errors(found, true):
    return np.hypot(found[0] - true[0], found[1] - true[1]), abs(wrap(found[2] - true[2]))


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (0.05, -0.04, 0.03), (-0.08, 0.06, -0.06), (0.02, 0.1, 0.08)])
def test_recovers_known_offsets(occupancy, offset):
    true = (0.25, 0.1, 0.4)
    scan = points(measured(true, np.random.default_rng(2)))
    found = match(occupancy, compose(true, offset), scan, (0.0, 0.0))
    distance, turn = errors(found.map_from_base, true)
    assert distance < 0.01
    assert turn < 0.005
    assert found.agreeing > 0.95


def test_a_wrong_place_is_told_by_few_points_agreeing(occupancy):
    scan = points(measured((0.25, 0.1, 0.4)))
    assert match(occupancy, (-0.6, 0.5, 1.4), scan, (0.0, 0.0)).agreeing < 0.7


def test_an_empty_map_leaves_the_guess():
    start = (1.0, 2.0, 0.5)
    occupancy = OccupancyMap(0.05)
    occupancy.insert(np.array(((9.0, 9.0),)), NOWHERE, np.array((8.0, 9.0)))
    found = match(occupancy, start, points(measured(IDENTITY)), (0.0, 0.0))
    assert found.map_from_base == start
    assert found.matched == 0


def test_along_a_bare_corridor_the_motion_guess_stays():
    corridor = rectangles(np.array(((0.0, 1.0, 30.0, 0.05, 0.0), (0.0, -1.0, 30.0, 0.05, 0.0))))
    room = {"boxes": corridor, "circles": np.zeros((0, 3))}
    occupancy = mapped([IDENTITY, (0.2, 0.0, 0.0)], np.random.default_rng(1), **room)
    scan = points(measured((0.6, 0.02, 0.01), np.random.default_rng(2), **room))
    x, y, heading = match(occupancy, (0.6, 0.0, 0.0), scan, (0.0, 0.0)).map_from_base
    assert x == pytest.approx(0.6, abs=0.02)
    assert (y, heading) == pytest.approx((0.02, 0.01), abs=0.005)


def test_the_two_faces_of_a_thin_wall_stay_apart():
    wall = rectangles(np.array(((0.0, 0.0, 3.0, 0.05, 0.0),)))
    room = {"boxes": wall, "circles": np.array(((0.0, -2.0, 0.2), (0.0, 2.0, 0.2), (1.5, 2.0, 0.1)))}
    below, above = (0.0, -0.8, 0.0), (0.3, 0.8, 0.0)
    occupancy = mapped([below, above], np.random.default_rng(1), **room)
    scan = points(measured(above, np.random.default_rng(2), **room))
    found = match(occupancy, (0.3, 0.77, 0.0), scan, (0.0, 0.0))
    assert found.map_from_base[1] == pytest.approx(0.8, abs=0.01)


def test_the_search_finds_what_is_too_far_to_refine(occupancy):
    true = (0.25, 0.1, 0.4)
    scan = points(measured(true, np.random.default_rng(3)))
    start, score = search(occupancy, compose(true, (0.25, -0.2, 0.25)), scan)
    distance, turn = errors(start, true)
    assert distance < 0.08
    assert turn < 0.04
    assert score > 0.5
    distance, turn = errors(match(occupancy, start, scan, (0.0, 0.0)).map_from_base, true)
    assert distance < 0.01
    assert turn < 0.005
