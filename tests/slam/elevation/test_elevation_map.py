"""Heights by columns, from points that were hit."""

import numpy as np
import pytest

from uvf.slam.elevation import elevation_map
from uvf.slam.elevation.elevation_map import ElevationMap, MapFull


def drawn(*points, resolution=0.5, gate=0.3):
    heights = ElevationMap(resolution, gate)
    for point in points:
        heights.insert(np.array([point], dtype=float))
    return heights


def test_ground_and_top_of_a_column_are_the_means_of_the_lowest_and_the_highest_surface():
    found = drawn((0.1, 0.1, 0.0), (0.2, 0.3, 0.1), (0.3, 0.2, 3.0), (0.1, 0.4, 3.2), (0.1, 0.1, 1.5)).elevation()
    assert found.ground.shape == (1, 1) and (found.x, found.y) == (0.0, 0.0)
    assert found.ground[0, 0] == pytest.approx(0.05) and found.top[0, 0] == pytest.approx(3.1)


def test_a_surface_below_the_ground_is_the_ground_from_then_on():
    assert drawn((0.1, 0.1, 2.0), (0.1, 0.1, 0.0)).elevation().ground[0, 0] == 0.0


def test_it_grows_to_all_sides_and_keeps_what_it_knows():
    found = drawn((0.1, 0.1, 1.0), (-99.9, 40.2, 2.0), (60.2, -70.1, 3.0)).elevation()
    for x, y, z in ((0.1, 0.1, 1.0), (-99.9, 40.2, 2.0), (60.2, -70.1, 3.0)):
        assert found.ground[int((y - found.y) // 0.5), int((x - found.x) // 0.5)] == z
    assert np.isfinite(found.ground).sum() == 3


def test_a_part_is_cut_out():
    found = drawn((0.1, 0.1, 1.0), (10.1, 10.1, 2.0)).elevation()
    part = found.within((10.0, 10.0, 11.0, 11.0))
    assert part.ground.shape == (1, 1) and part.ground[0, 0] == 2.0 and (part.x, part.y) == (10.0, 10.0)
    assert found.within((20.0, 20.0, 30.0, 30.0)) is None


def test_what_is_not_finite_is_left_out_and_a_map_too_large_is_refused(monkeypatch):
    heights = drawn((0.1, 0.1, 1.0), (np.nan, 0.0, 0.0), (0.0, 0.0, np.inf))
    monkeypatch.setattr(elevation_map, "MOST_COLUMNS", 100_000)
    with pytest.raises(MapFull, match="100000 are possible"):
        heights.insert(np.array([[0.1, 0.1, 5.0], [1e4, 1e4, 0.0]]))
    assert heights.elevation().top[0, 0] == 1.0


def test_it_goes_on_with_a_map_that_was_drawn_before():
    left = drawn((0.1, 0.1, 1.0), (0.1, 0.1, 4.0), (5.1, -3.2, 2.0)).elevation()
    resumed = ElevationMap(0.5, 0.3)
    resumed.resume(left)
    assert np.array_equal(resumed.elevation().ground, left.ground, equal_nan=True)
    assert np.array_equal(resumed.elevation().top, left.top, equal_nan=True)


@pytest.mark.parametrize("beyond", [(0.0, 1600.0), (1600.0, 0.0), (600.0, 600.0)])
def test_it_does_not_grow_beyond_what_a_message_may_hold(beyond):
    heights = drawn((0.0, 0.0, 0.0), resolution=0.25)
    with pytest.raises(MapFull, match="6200 along a side"):
        heights.insert(np.array([(*beyond, 0.0)]))
    assert heights.elevation().ground.shape == (1, 1)
