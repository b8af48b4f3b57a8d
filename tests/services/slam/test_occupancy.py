"""The occupancy grid: free along the beams, occupied at their ends, unknown behind, growing as needed."""

import numpy as np
import pytest

from services.slam.occupancy import OccupancyMap

NOWHERE = np.zeros((0, 2))
SENSOR = np.array((0.02, 0.02))


def probability(occupancy, x, y):
    column, row = np.floor((np.array((x, y)) - occupancy.origin) / occupancy.resolution).astype(int)
    return occupancy.cells()[row, column]


def test_a_beam_frees_its_way_and_occupies_its_end():
    occupancy = OccupancyMap(0.05)
    occupancy.insert(np.array(((1.02, 0.02),)), NOWHERE, SENSOR)
    assert probability(occupancy, 1.02, 0.02) > 60
    assert all(0 <= probability(occupancy, x, 0.02) < 50 for x in np.arange(0.02, 0.97, 0.05))
    assert probability(occupancy, 1.12, 0.02) == -1
    assert probability(occupancy, 0.5, 0.3) == -1


def test_a_beam_without_return_occupies_nothing():
    occupancy = OccupancyMap(0.05)
    occupancy.insert(NOWHERE, np.array(((-1.02, 0.52),)), SENSOR)
    assert occupancy.cells().max() < 50
    assert 0 <= probability(occupancy, -0.52, 0.28) < 50


def test_grows_on_every_side_and_keeps_what_it_knew():
    occupancy = OccupancyMap(0.05)
    occupancy.insert(np.array(((1.02, 0.02),)), NOWHERE, SENSOR)
    before = probability(occupancy, 1.02, 0.02)
    for end in ((-9.0, 3.0), (4.0, -12.0), (15.0, 15.0)):
        occupancy.insert(np.array((end,)), NOWHERE, SENSOR)
        assert probability(occupancy, *end) > 60
    assert probability(occupancy, 1.02, 0.02) == before


def test_what_has_gone_is_cleared():
    occupancy = OccupancyMap(0.05)
    occupancy.insert(np.array(((1.02, 0.02),)), NOWHERE, SENSOR)
    for _ in range(5):
        occupancy.insert(np.array(((2.02, 0.02),)), NOWHERE, SENSOR)
    assert probability(occupancy, 1.02, 0.02) < 30


def test_a_scan_does_not_clear_what_it_hits_itself():
    """Beams that graze a wall pass through cells that others end in."""
    occupancy = OccupancyMap(0.05)
    wall = np.column_stack((np.linspace(0.5, 3.0, 200), np.full(200, 0.32)))
    occupancy.insert(wall, NOWHERE, SENSOR)
    assert all(probability(occupancy, x, 0.32) > 60 for x in np.arange(0.55, 2.95, 0.05))


def test_a_map_is_taken_up_again_from_its_published_form():
    first = OccupancyMap(0.05)
    wall = np.column_stack((np.linspace(-1.0, 1.0, 200), np.full(200, 0.62)))
    first.insert(wall, NOWHERE, SENSOR)
    second = OccupancyMap(0.05)
    second.restore(first.cells(), first.origin)
    np.testing.assert_allclose(second.cells(), first.cells(), atol=1)
    np.testing.assert_allclose(second.log_odds, first.log_odds, atol=0.1)
    column, row = np.floor((np.array((0.0, 0.62)) - second.origin) / 0.05).astype(int)
    assert second.surface[row, column, 4] < -0.7  # seen from below
    assert second.surface[row - 3, column, 0] == 0.0


def test_the_surface_point_of_a_cell_is_the_mean_of_its_hits():
    occupancy = OccupancyMap(0.1)
    hits = np.array(((1.01, 0.02), (1.03, 0.04), (1.05, 0.06)))
    occupancy.insert(hits, NOWHERE, SENSOR)
    column, row = np.floor((hits[0] - occupancy.origin) / 0.1).astype(int)
    n, x, y = occupancy.surface[row, column, :3]
    corner = occupancy.origin + 0.1 * np.array((column, row))
    assert n == 3
    assert corner + 0.1 * np.array((x, y)) / n == pytest.approx(hits.mean(axis=0), abs=1e-6)
