"""What beams tell of a place on a map that knows a room, the wall around it, and nothing beyond."""

import numpy as np
import pytest

from uvf.maths.se2 import Pose2
from uvf.models.world.map_file import GridMap
from uvf.slam.localization import known_map
from uvf.slam.localization.beams import BeamLikelihood, field_of, fits_at

CELL, SIZE = 0.05, 120
"""A room of 4 m by 4 m about the middle of a map of 6 m by 6 m."""


@pytest.fixture(scope="module")
def field():
    cells = np.full((SIZE, SIZE), -1, dtype=np.int8)
    cells[18:102, 18:102] = 100
    cells[20:100, 20:100] = 0
    return field_of(known_map.of_grid(GridMap(cells, CELL, Pose2(-3.0, -3.0, 0.0))))


def told(field, end):
    """(on walls, against) of one beam from the middle of the room."""
    found = fits_at(np.zeros((1, 3)), BeamLikelihood(np.array((end,)), (0.0, 0.0)), field)
    return found.fits[0], found.against[0]


def test_an_end_on_the_wall_fits(field):
    on_walls, against = told(field, (2.0, 0.3))
    assert on_walls > 0.8 and against < 0.2


def test_an_end_on_floor_that_is_known_free_contradicts(field):
    on_walls, against = told(field, (1.0, 0.3))
    assert on_walls < 0.01 and against > 0.99


def test_a_beam_through_a_wall_contradicts_wherever_it_ends(field):
    assert told(field, (2.9, 0.3)) == (0.0, 1.0)
    assert told(field, (9.0, 0.3)) == (0.0, 1.0)


def test_where_the_map_knows_nothing_a_beam_tells_nothing(field):
    found = fits_at(np.array(((2.6, 0.0, 0.0),)), BeamLikelihood(np.array(((0.3, 0.0),)), (0.0, 0.0)), field)
    assert found.fits[0] == found.against[0] == 0.0


def test_floor_that_hardly_a_beam_has_crossed_is_not_known():
    cells = np.full((SIZE, SIZE), 40, dtype=np.int8)
    cells[18:20, 20:100] = 100
    cells[20:24, 20:100] = 0
    unsure = field_of(known_map.of_grid(GridMap(cells, CELL, Pose2(-3.0, -3.0, 0.0))))
    assert told(unsure, (1.0, 0.3)) == (0.0, 0.0)
