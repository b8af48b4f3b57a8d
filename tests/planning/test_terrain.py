"""Obstacles by heights, and another vehicle's map below the own one."""

import numpy as np
import pytest

from uvf.maths.se2 import Pose2
from uvf.planning.costmap.shared_map import SharedMap
from uvf.planning.costmap.terrain import TerrainLimits, terrain_obstacles

NOWHERE = np.zeros((0, 2))
LIMITS = TerrainLimits(step=0.3, slope=0.35)
R = 0.25


def level():
    ground = np.zeros((40, 60), dtype=np.float32)
    return ground.copy(), ground


def test_a_wall_a_ditch_and_a_roof_over_the_ground_are_obstacles():
    top, ground = level()
    top[:, 20], ground[:, 20] = 2.0, 2.0
    ground[10:15, 40:45] = top[10:15, 40:45] = -0.8
    top[30, 30] = 3.0
    cells = terrain_obstacles((top, ground), R, LIMITS)
    assert (cells[:, 20] == 99).all() and (cells[:, 19] == 0).all()
    assert (cells[9, 40:45] == 100).all() and (cells[12, 42] == 0)
    assert cells[30, 30] == 99 and cells[30, 31] == 0


@pytest.mark.parametrize(("degrees", "blocked"), [(12.0, False), (28.0, True)])
def test_slopes_are_obstacles_from_the_limit_on(degrees, blocked):
    slope = np.tile((np.arange(60) * R * np.tan(np.radians(degrees))).astype(np.float32), (40, 1))
    cells = terrain_obstacles((slope, slope), R, LIMITS)
    assert (cells[5:-5, 10:-10] == (100 if blocked else 0)).all()


def test_gaps_between_lines_are_filled_and_what_was_never_seen_stays_unknown():
    top, ground = level()
    for each in (top, ground):
        each[:, 1::3] = np.nan
        each[:, 30:] = np.nan
    cells = terrain_obstacles((top, ground), R, LIMITS)
    assert (cells[:, :30] == 0).all() and (cells[:, 33:] == -1).all()
    assert (terrain_obstacles((top * np.nan, ground * np.nan), R, LIMITS) == -1).all()


def test_the_map_below_shows_where_the_own_one_does_not_and_both_fit_together():
    shared = np.zeros((8, 8), dtype=np.int8)
    shared[7, 7] = 100  # from 2.5 to 3 m in both directions
    own = np.array([[-1, 0], [100, -1]], dtype=np.int8)
    cells, (resolution, (x, y)) = SharedMap(shared, 0.5, Pose2(-1.0, -1.0, 0.0), outranks=True).below(own, (0.25, (4.0, 0.0)), NOWHERE, 0.3)
    assert (resolution, x, y) == (0.25, -1.0, -1.0) and cells.shape == (16, 22)

    def at(px, py):
        return cells[int((py - y) / resolution), int((px - x) / resolution)]

    assert at(2.6, 2.6) == 100 and at(0.1, 0.1) == 0
    assert [at(4.1, 0.1), at(4.4, 0.1), at(4.1, 0.4), at(4.4, 0.4)] == [-1, 0, 100, -1]


def test_a_map_that_is_turned_lies_where_it_belongs():
    shared = np.full((4, 4), -1, dtype=np.int8)
    shared[0, 3] = 100  # x 3..4, y 0..1 in its own frame; turned by a quarter: x -1..0, y 3..4
    own = np.zeros((1, 1), dtype=np.int8)
    cells, (_, (x, y)) = SharedMap(shared, 1.0, Pose2(0.0, 0.0, np.pi / 2), outranks=False).below(own, (0.5, (0.0, 0.0)), NOWHERE, 0.3)
    rows, columns = np.nonzero(cells == 100)
    assert ((columns + 0.5) * 0.5 + x).mean() == pytest.approx(-0.5) and ((rows + 0.5) * 0.5 + y).mean() == pytest.approx(3.5)


@pytest.mark.parametrize("outranks", [True, False])
def test_only_obstacles_seen_from_above_count_more_than_own_free_ground(outranks):
    shared, own = np.full((2, 2), 100, dtype=np.int8), np.zeros((2, 2), dtype=np.int8)
    cells, _ = SharedMap(shared, 0.5, Pose2(0.0, 0.0, 0.0), outranks=outranks).below(own, (0.5, (0.0, 0.0)), NOWHERE, 0.3)
    assert (cells == (100 if outranks else 0)).all()


def test_a_steep_slope_that_can_be_driven_is_no_step_in_large_cells():
    slope = np.add.outer(np.arange(40), np.arange(60)).astype(np.float32) * np.tan(0.25).astype(np.float32) / np.sqrt(2.0)
    cells = terrain_obstacles((slope, slope), 1.0, LIMITS)
    assert (cells[5:-5, 5:-5] == 0).all()


@pytest.mark.parametrize("column", [40, 41])
def test_a_wall_one_cell_thick_is_none_the_less_there_in_larger_cells(column):
    fine = np.zeros((80, 80), dtype=np.int8)
    fine[:, column] = 100
    shared = SharedMap(fine, 0.05, Pose2(0.0, 0.0, 0.0), outranks=False)
    both, _ = shared.below(np.full((10, 10), -1, dtype=np.int8), (0.1, (0.0, 0.0)), NOWHERE, 0.3)
    assert (both == 100).sum() == 40 and (both[:, 20] == 100).all()
