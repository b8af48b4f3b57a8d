"""Rays go in as OctoMap's do, and the map answers."""

import numpy as np
import pytest

from tests.slam.octree.scenes import HIGH, LOW, room_scan, wall_distance
from uvf.slam.octree.layout import HIGHEST, HIT, LOWEST, MISS, REACH
from uvf.slam.octree.leaves import boxes, leaves_of
from uvf.slam.octree.octree import FREE, NOT_KNOWN, OCCUPIED, Octree

HERE = np.array((0.05, 0.05, 0.05))


def along_x(*lengths):
    return HERE + np.outer(lengths, (1.0, 0.0, 0.0))


def at(octree, *xs):
    return octree.log_odds(np.array([(x, 0.05, 0.05) for x in xs]))


@pytest.fixture(scope="module")
def room():
    octree, rng = Octree(0.1), np.random.default_rng(1)
    for _ in range(12):
        octree.insert(*room_scan(rng))
    return octree


def test_walls_are_occupied_and_nothing_else_is(room):
    leaves = leaves_of(room)
    middles, _ = boxes(leaves, 0.1)
    occupied = leaves.values >= 0
    assert (wall_distance(middles[occupied]) <= 0.1 * np.sqrt(3) / 2 + 1e-6).all()
    inner = np.random.default_rng(2).uniform(LOW + 0.2, HIGH - 0.2, (5000, 3))
    assert (room.states(inner) == FREE).mean() > 0.99
    assert (room.states(inner) != OCCUPIED).all()


def test_every_place_on_a_wall_is_found_within_a_cell(room):
    rng = np.random.default_rng(3)
    on_wall = np.concatenate([room_scan(rng, 2000)[1] for _ in range(3)])
    near = np.stack([room.states(on_wall + 0.1 * np.array((i, j, k))) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)])
    assert (near == OCCUPIED).any(axis=0).mean() > 0.995


def test_nothing_is_known_behind_the_walls(room):
    assert (room.states(np.array(((4.0, 0, 1), (0, 3.0, 1), (0, 0, -1.0), (0, 0, 5.0)))) == NOT_KNOWN).all()


def test_one_beam_clears_its_way_and_occupies_its_end():
    octree = Octree(0.1)
    octree.insert(HERE, along_x(1.0))
    assert at(octree, 0.05, 0.55, 0.95, 1.05).tolist() == pytest.approx([MISS, MISS, MISS, HIT])
    assert np.isnan(at(octree, -0.05, 1.15)).all()


def test_a_scan_changes_each_cell_once_and_does_not_clear_what_it_has_hit():
    octree = Octree(0.1)
    octree.insert(HERE, along_x(1.0, 1.0, 1.0, 2.0, 2.01))
    assert at(octree, 0.55, 1.05, 1.55, 2.05).tolist() == pytest.approx([MISS, HIT, MISS, HIT])


def test_the_next_scan_may_clear_it():
    octree = Octree(0.1)
    octree.insert(HERE, along_x(1.0))
    octree.insert(HERE, along_x(2.0))
    assert at(octree, 1.05)[0] == pytest.approx(HIT + MISS)


def test_a_beam_that_ends_where_it_begins_is_a_hit_there():
    octree = Octree(0.1)
    octree.insert(HERE, HERE[None] + 0.01)
    assert at(octree, 0.05)[0] == HIT


def test_what_lies_beyond_the_reach_is_free_as_far_as_there():
    octree = Octree(0.1)
    octree.insert(HERE, along_x(5.0), 1.0)
    assert (at(octree, 0.05, 0.95) < 0).all()
    assert np.isnan(at(octree, 1.15, 5.05)).all()


def test_no_cell_is_surer_than_the_clamping_thresholds():
    octree = Octree(0.1)
    for _ in range(20):
        octree.insert(HERE, along_x(1.0))
    assert at(octree, 0.55, 1.05).tolist() == [LOWEST, HIGHEST]


def test_a_wall_that_has_gone_fades():
    octree = Octree(0.1)
    for _ in range(20):
        octree.insert(HERE, along_x(1.0))
    for _ in range(9):
        octree.insert(HERE, along_x(2.0))
    assert at(octree, 1.05)[0] < 0


def test_broken_points_are_left_out():
    octree = Octree(0.1)
    octree.insert(HERE, np.array(((np.nan, 0, 0), (np.inf, 0, 0), (1e30, 1e30, 0), (1.05, 0.05, 0.05))))
    assert at(octree, 1.05)[0] == HIT
    octree.insert(np.array((np.nan, 0.0, 0.0)), along_x(1.0))
    assert at(octree, 1.05)[0] == HIT


def test_the_map_reaches_very_far_and_ends_there():
    octree = Octree(0.1)
    far = np.array((400_000.0, -300_000.0, 200_000.0))
    octree.insert(far, far[None] + (3.0, 0.0, 0.0))
    assert octree.states(far[None]) == FREE
    octree.insert(np.zeros(3), np.array(((0.1 * REACH, 0.0, 0.0),)))
    assert octree.states(np.zeros((1, 3))) == NOT_KNOWN


def test_blocks_that_say_the_same_throughout_keep_one_value():
    octree = Octree(0.1)
    rng = np.random.default_rng(1)
    scans = [room_scan(rng, 20_000) for _ in range(5)]
    for scan in scans:
        octree.insert(*scan)
    unsure = octree.memory
    for scan in scans * 4:
        octree.insert(*scan)
    assert octree.memory == unsure
    assert (octree.blocks.slots[: octree.block_count] < 0).sum() > 50


def test_scans_in_any_order_of_their_beams_give_the_same_map():
    rng = np.random.default_rng(5)
    origin, points = room_scan(rng)
    one, other = Octree(0.1), Octree(0.1)
    one.insert(origin, points)
    other.insert(origin, points[rng.permutation(len(points))])
    for a, b in zip(leaves_of(one), leaves_of(other), strict=True):
        assert (a == b).all()


def test_a_ray_meets_the_wall_that_it_points_at(room):
    met = room.cast(np.array(((0.0, 0.0, 1.0),) * 3), np.array(((5.0, 0, 0), (0, -1.0, 0), (0, 0, 0.1))))
    assert met[0] == pytest.approx((3.05, 0.05, 1.05))
    assert met[1] == pytest.approx((0.05, -2.05, 1.05))
    assert met[2] == pytest.approx((0.05, 0.05, 2.55))


def test_a_ray_ends_at_its_reach_at_the_unknown_and_without_a_direction(room):
    origins = np.array(((0.0, 0.0, 1.0),))
    assert np.isnan(room.cast(origins, np.array(((1.0, 0, 0),)), reach=2.0)).all()
    assert np.isnan(room.cast(origins, np.zeros((1, 3)))).all()
    behind = np.array(((9.0, 0.0, 1.0),))
    assert np.isnan(room.cast(behind, np.array(((-1.0, 0, 0),)))).all()
    assert room.cast(behind, np.array(((-1.0, 0, 0),)), through_unknown=True)[0, 0] == pytest.approx(3.05)
    assert np.isnan(room.cast(behind, np.array(((1.0, 0, 0),)), reach=5.0, through_unknown=True)).all()
