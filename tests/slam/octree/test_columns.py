"""The map from above: slices, tops and grounds."""

import numpy as np
import pytest

from tests.slam.octree.scenes import room_scan
from uvf.slam.octree.columns import FREE, OCCUPIED, UNKNOWN, columns_of
from uvf.slam.octree.octree import Octree

MANY = 1_000_000


@pytest.fixture(scope="module")
def scene():
    """Ground at z = -1..0 of cells, free air above it, a table at 2 and a lamp at 5; seen from beams along z."""
    octree = Octree(0.5)
    for x in range(-3, 4):
        for y in range(-3, 4):
            middle = np.array(((x + 0.5) * 0.5, (y + 0.5) * 0.5, 3.75))
            floor = middle * (1.0, 1.0, 0.0) - (0.0, 0.0, 0.25)
            octree.insert(middle, floor[None])
    for x, y, z in ((1, 1, 2), (-2, 0, 5)):
        middle = (np.array((x, y, z)) + 0.5) * 0.5
        for _ in range(3):
            octree.insert(middle, middle[None])
    return octree


def column(seen, grid, x, y):
    row = int(np.floor(((y + 0.5) * 0.5 - seen.y) / seen.resolution))
    return grid[row, int(np.floor(((x + 0.5) * 0.5 - seen.x) / seen.resolution))]


def test_a_slice_holds_what_stands_in_its_heights_and_nothing_else(scene):
    low, high = (columns_of(scene, *band, MANY) for band in ((0.2, 1.4), (2.0, 3.0)))
    assert column(low, low.slice, 1, 1) == OCCUPIED and column(high, high.slice, 1, 1) == FREE
    assert column(low, low.slice, -2, 0) == FREE and column(high, high.slice, -2, 0) == OCCUPIED
    assert column(low, low.slice, 0, 0) == FREE
    assert column(low, low.slice, -4, -4) == UNKNOWN


def test_the_top_is_the_highest_thing_and_the_ground_what_one_stands_on(scene):
    seen = columns_of(scene, 0.0, 1.0, MANY)
    assert column(seen, seen.top, 0, 0) == 0.0 and column(seen, seen.ground, 0, 0) == 0.0
    assert column(seen, seen.top, 1, 1) == pytest.approx(1.5) and column(seen, seen.ground, 1, 1) == 0.0
    assert column(seen, seen.top, -2, 0) == pytest.approx(3.0) and column(seen, seen.ground, -2, 0) == 0.0
    assert np.isnan(column(seen, seen.top, -4, -4)) and np.isnan(column(seen, seen.ground, -4, -4))


def test_without_free_space_on_it_nothing_is_ground():
    octree = Octree(0.5)
    octree.insert(np.array((0.25, 0.25, 0.25)), np.array(((0.25, 0.25, 0.25),)))
    seen = columns_of(octree, 0.0, 1.0, MANY)
    assert column(seen, seen.top, 0, 0) == pytest.approx(0.5)
    assert np.isnan(seen.ground).all()


def test_too_many_columns_are_put_together_and_nothing_occupied_is_lost(scene):
    whole, half = columns_of(scene, 0.2, 1.4, MANY), columns_of(scene, 0.2, 1.4, 50)
    assert half.resolution == 2 * whole.resolution and half.slice.shape == (4, 4)
    assert (half.slice == OCCUPIED).sum() == (whole.slice == OCCUPIED).sum() == 1
    assert np.nanmax(half.top) == np.nanmax(whole.top) and np.nanmin(half.ground) == np.nanmin(whole.ground)
    assert half.slice[int((0.75 - half.y) / half.resolution), int((0.75 - half.x) / half.resolution)] == OCCUPIED


@pytest.mark.parametrize("most", [1000, 300, 20])
def test_put_together_they_say_what_the_single_ones_say(most):
    octree, rng = Octree(0.1), np.random.default_rng(4)
    for _ in range(4):
        octree.insert(*room_scan(rng))
    whole, few = columns_of(octree, 0.3, 0.9, MANY), columns_of(octree, 0.3, 0.9, most)
    side = round(few.resolution / whole.resolution)
    assert side > 1 and few.slice.size <= most and (few.x, few.y) == (whole.x, whole.y)
    rows, columns = np.indices(whole.slice.shape) // side
    for name, put, start in (("slice", np.maximum, UNKNOWN), ("top", np.fmax, np.nan), ("ground", np.fmin, np.nan)):
        wanted = np.full(few.slice.shape, start, dtype=getattr(whole, name).dtype)
        put.at(wanted, (rows, columns), getattr(whole, name))
        assert np.array_equal(getattr(few, name), wanted, equal_nan=name != "slice"), name


def test_a_map_of_two_far_places_makes_no_huge_grid_on_the_way():
    """Between them are 4e9 columns, which would take 36 GB."""
    octree = Octree(0.1)
    for place in (np.array((-3200.0, -3200.0, 1.0)), np.array((3200.0, 3200.0, 1.0))):
        octree.insert(place, place[None] + (1.0, 0.0, 0.0))
    seen = columns_of(octree, 0.5, 1.5, MANY)
    assert seen.slice.size <= MANY
    assert (seen.slice == OCCUPIED).sum() == 2 and seen.slice[0, 0] == OCCUPIED and seen.slice[-1, -1] == OCCUPIED


def test_uniform_blocks_count_like_others():
    octree = Octree(0.5)
    octree.set_blocks(np.array([(1 << 20) << 42 | (1 << 20) << 21 | 1 << 20]), np.array([-2.0], dtype=np.float32))
    seen = columns_of(octree, 0.0, 1.0, MANY)
    assert (seen.slice == FREE).all() and seen.slice.shape == (4, 4) and (seen.x, seen.y) == (0.0, 0.0)


def test_of_an_empty_map_there_is_nothing_to_see():
    assert columns_of(Octree(0.1), 0.0, 1.0, MANY) is None
