"""The map of tiles: what keyframes show, wherever they are, as often as they move, and nothing that has gone."""

from math import inf, nan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.planar_rays import rectangles
from tests.slam.room import ANGLES, FURNITURE, RANGE_MAX, WALLS, measured
from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.models.yaml_data import BadInput
from uvf.slam.maps import evidence, tiles
from uvf.slam.maps.tiles import EPOCH, TileMap
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading

LIDAR = Beams((0.0, 0.0), ANGLES, 0.12, RANGE_MAX)
EMPTY_ROOM = rectangles(np.array(WALLS))
CHAIR = (1.02, 0.02, 0.2, 0.2, 0.0)
NO_CIRCLES = np.zeros((0, 3))


def keyframe(pose, things=(), circles=NO_CIRCLES, drawn_at=None):
    boxes = rectangles(np.array(WALLS + things)) if things else EMPTY_ROOM
    return Keyframe(drawn_at or pose, Reading(0.0, measured(pose, boxes=boxes, circles=circles), LIDAR, pose))


def one_beam(length, pose=IDENTITY, bearing=0.0, origin=(0.0, 0.0)):
    return Keyframe(pose, Reading(0.0, np.array([length]), Beams(origin, np.array([bearing]), 0.1, 5.0), pose))


def at(map_, x, y):
    """What the map has at a place [m]."""
    cells, corner = map_.cells()
    row, column = int((y - corner[1]) // map_.resolution), int((x - corner[0]) // map_.resolution)
    return int(cells[row, column]) if 0 <= row < cells.shape[0] and 0 <= column < cells.shape[1] else -1


def poses(n, seed=0):
    rng = np.random.default_rng(seed)
    return [Pose2(*p) for p in np.column_stack((rng.uniform(-2.5, 2.5, n), rng.uniform(-0.5, 0.5, n), rng.uniform(-3, 3, n)))]


SWEEPS = [keyframe(pose, FURNITURE) for pose in poses(8, 9)]


def moved(keyframes, by, one, by_more):
    """All shifted in their own frames by a little, and one of them by more."""
    return [Keyframe(compose(k.map_from_base, Pose2(*(by_more if i == one else by))), k.reading) for i, k in enumerate(keyframes)]


def same(a, b):
    (cells_a, corner_a), (cells_b, corner_b) = a.cells(), b.cells()
    return corner_a == corner_b and np.array_equal(cells_a, cells_b)


def test_a_beam_is_free_up_to_where_it_ends_and_tells_nothing_behind():
    map_ = TileMap()
    map_.add(one_beam(2.02))
    assert [at(map_, x, 0.01) for x in (0.01, 1.0, 1.97)] == [40, 40, 40]
    assert at(map_, 2.02, 0.01) == 70
    assert at(map_, 2.07, 0.01) == at(map_, -0.02, 0.01) == at(map_, 1.0, 0.06) == -1


def test_the_beam_begins_at_the_lidar_not_at_the_vehicle():
    map_ = TileMap()
    map_.add(one_beam(1.0, Pose2(3.01, 1.01, np.pi / 2), 0.0, origin=(0.5, 0.2)))
    assert at(map_, 2.81, 2.51) == 70  # 0.5 ahead (north), 0.2 to the left (west), 1 m north
    assert at(map_, 2.81, 1.55) == 40 and at(map_, 2.81, 1.4) == -1


@pytest.mark.parametrize("length", [0.0, inf, 5.0, 81.83])
def test_no_return_is_free_as_far_as_nine_tenths_of_the_range(length):
    map_ = TileMap()
    map_.add(one_beam(length))
    assert at(map_, 4.4, 0.0) == 40 and at(map_, 4.6, 0.0) == -1


@pytest.mark.parametrize("length", [nan, 0.05, -1.0, -inf])
def test_a_disturbed_beam_says_nothing(length):
    map_ = TileMap()
    map_.add(one_beam(length))
    cells, _ = map_.cells()
    assert (cells == -1).all()


def test_the_map_reaches_wherever_the_vehicle_goes():
    map_ = TileMap()
    far = [Pose2(0.0, 0.0, 0.0), Pose2(-300.01, 250.01, 0.0), Pose2(400.01, -100.01, 0.0)]
    for pose in far:
        map_.add(one_beam(1.01, pose))
    assert [at(map_, p.x + 1.01, p.y) for p in far] == [70, 70, 70]


def test_a_place_on_another_planet_is_refused_in_one_line():
    map_ = TileMap()
    map_.add(one_beam(1.0))
    for pose in (Pose2(nan, 0.0, 0.0), Pose2(0.0, 2e6, 0.0)):
        with pytest.raises(BadInput, match="look at the odometry"):
            map_.add(one_beam(1.0, pose))
    map_.add(one_beam(1.0, Pose2(5e5, 5e5, 0.0)))
    with pytest.raises(BadInput, match="look for a jump in the odometry"):
        map_.cells()


def test_a_wrong_number_of_ranges_is_refused_in_one_line():
    with pytest.raises(BadInput, match="of 359 ranges cannot be drawn: its lidar has 360 beams"):
        TileMap().add(Keyframe(IDENTITY, Reading(0.0, np.ones(359), LIDAR, IDENTITY)))


def test_walls_of_a_room_stand_where_they_are_and_its_floor_is_free():
    map_ = TileMap()
    map_.follow(keyframe(pose) for pose in poses(40))
    cells, corner = map_.cells()
    rows, columns = np.nonzero(cells > 50)
    x, y = corner[0] + (columns + 0.5) * 0.05, corner[1] + (rows + 0.5) * 0.05
    inner = np.maximum(np.abs(x) - 2.95, np.abs(y) - 1.95)
    assert np.abs(inner).max() < 0.05
    assert len(rows) > 180
    assert all(at(map_, x, y) < 20 for x in np.arange(-2.5, 2.6, 0.5) for y in np.arange(-1.5, 1.6, 0.5))


def test_a_map_that_has_followed_its_poses_equals_one_drawn_anew():
    rng = np.random.default_rng(3)
    taken = [keyframe(pose, FURNITURE) for pose in poses(3 * EPOCH // 2)]
    map_ = TileMap()
    map_.follow(taken)
    bent = [Keyframe(compose(Pose2(*rng.normal(0, (0.3, 4.0, 0.2))), k.map_from_base), k.reading) for k in taken]
    assert map_.follow(bent) == len(taken)
    anew = TileMap()
    anew.follow(bent)
    assert same(map_, anew)
    assert not same(map_, TileMap())
    map_.follow(taken)
    anew = TileMap()
    anew.follow(taken)
    assert same(map_, anew)


def test_only_what_has_moved_is_drawn_again():
    taken = [keyframe(pose) for pose in poses(10)]
    map_ = TileMap()
    assert map_.follow(taken) == 10
    assert map_.follow(taken) == 0
    assert map_.follow(moved(taken, (0.005, 0.0, 0.0), 4, (0.1, 0.0, 0.0))) == 1
    assert map_.follow(moved(taken, (0.0, 0.0, 0.001), 7, (0.0, 0.0, 0.05))) == 2  # the one, and number 4 on its way back


def test_a_keyframe_that_is_given_up_leaves_nothing():
    taken = [keyframe(pose) for pose in poses(10)]
    map_ = TileMap()
    map_.follow([*taken, one_beam(3.0, Pose2(20.0, 20.0, 0.0))])
    assert map_.follow(taken) == 1 and len(map_) == 10
    anew = TileMap()
    anew.follow(taken)
    assert same(map_, anew)


def test_keyframes_replaced_over_and_over_take_no_more_room():
    places = poses(10)
    map_ = TileMap()
    map_.follow(keyframe(pose) for pose in places)
    once = map_._evidence.size
    for _ in range(30):
        taken = [keyframe(pose) for pose in places]
        map_.follow(taken)
    assert map_._evidence.size <= 2 * once
    anew = TileMap()
    anew.follow(taken)
    assert same(map_, anew)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 7), *[st.integers(-n, n) for n in (10, 200, 30)]), max_size=12))
def test_whatever_comes_moves_and_goes_the_map_is_that_of_what_is_left(moves):
    left, map_ = {}, TileMap()
    for number, x, y, yaw in moves:
        if number in left and x < 0:
            del left[number]
        else:
            left[number] = Keyframe(Pose2(0.1 * x, 0.1 * y, 0.1 * yaw), SWEEPS[number].reading)
        map_.follow(left.values())
    anew = TileMap()
    anew.follow(left.values())
    assert same(map_, anew)


@pytest.mark.parametrize("seed", range(6))
def test_settled_epochs_show_and_move_like_any_other(seed, monkeypatch):
    rng = np.random.default_rng(seed)
    monkeypatch.setattr(tiles, "EPOCH", 3)
    taken = [keyframe(pose, (CHAIR,) if i % 20 < 10 else ()) for i, pose in enumerate(poses(60, seed))]
    settling, apart = TileMap(), TileMap()
    for n in (20, 45, 60, 60, 60):
        for i in rng.integers(0, n, 0 if n < 60 else 3):
            taken[i] = Keyframe(compose(taken[i].map_from_base, Pose2(*rng.normal(0.0, (0.2, 0.2, 0.1)))), taken[i].reading)
        monkeypatch.setattr(evidence, "RECENT", 3)
        settling.follow(taken[:n])
        settling.cells()
        monkeypatch.setattr(evidence, "RECENT", 1000)
        apart.follow(taken[:n])
        assert same(apart, settling)
        assert settling._evidence.size < apart._evidence.size


def test_the_room_for_a_place_is_bounded_however_often_it_is_driven_through(monkeypatch):
    monkeypatch.setattr(tiles, "EPOCH", 4)
    map_ = TileMap()
    sizes = []
    for _ in range(5):
        for sweep in (keyframe(pose) for pose in poses(4 * evidence.RECENT)):
            map_.add(sweep)
        sizes.append(map_._evidence.size)
    assert sizes[1] == sizes[-1]
    assert at(map_, 0.0, 0.0) < 10 and at(map_, 2.97, 0.0) > 90


def test_a_chair_that_is_taken_away_vanishes_after_a_few_looks_however_long_it_stood():
    map_ = TileMap()
    for pose in poses(3 * EPOCH, 1):
        if max(abs(pose.x - 1.0), abs(pose.y)) > 0.3:
            map_.add(keyframe(pose, (CHAIR,)))
    rim = [(0.82, 0.02), (1.22, 0.02), (1.02, 0.22), (1.02, -0.18)]
    assert min(at(map_, *place) for place in rim) > 90
    looks = [pose for pose in poses(2 * EPOCH, 2) if max(abs(pose.x - 1.0), abs(pose.y)) > 0.3]
    for pose in looks[:EPOCH]:  # at the latest: an epoch that still holds the chair has to end first
        map_.add(keyframe(pose))
    for pose in looks[EPOCH : EPOCH + 20]:
        map_.add(keyframe(pose))
    assert max(at(map_, *place) for place in rim) < 20
    map_.add(keyframe(looks[-1], (CHAIR,)))
    assert max(at(map_, *place) for place in rim) < 50, "one look is not enough to bring it back"


def test_a_person_who_walks_through_leaves_no_trail():
    map_, alone = TileMap(), TileMap()
    for i, pose in enumerate(poses(EPOCH, 4)):
        walker = np.array([[-2.5 + 5.0 * i / EPOCH, 1.2, 0.2]])
        map_.add(keyframe(pose, circles=walker if 10 < i < 50 else NO_CIRCLES))
        alone.add(keyframe(pose))
    trail = [at(map_, x, y) for x in np.arange(-1.5, 1.4, 0.05) for y in np.arange(0.9, 1.5, 0.05)]
    assert max(trail) < 50
    assert (map_.cells()[0] > 50).sum() > 0.97 * (alone.cells()[0] > 50).sum()


def test_distances_are_to_the_nearest_wall():
    map_ = TileMap()
    map_.follow(keyframe(pose) for pose in poses(40))
    distances, corner = map_.distances()
    middle = distances[int((0.0 - corner[1]) / 0.05), int((0.0 - corner[0]) / 0.05)]
    assert middle == pytest.approx(1.95, abs=0.06)


def test_the_map_holds_the_place_of_a_vehicle_whose_lidar_is_ahead_of_it():
    map_ = TileMap()
    map_.follow([one_beam(2.0, Pose2(-0.1, -0.1, 0.0), origin=(0.32, 0.32))])
    _, (x, y) = map_.cells()
    assert x <= -0.1 and y <= -0.1
    assert at(map_, -0.1, -0.1) == -1
    assert 0 <= at(map_, 1.0, 0.22) < 50 < at(map_, 2.22, 0.22)
