"""Measures of maps, on maps whose faults are known because they were made by hand."""

from dataclasses import replace

import numpy as np
import pytest

from tests.slam.maps.floor_plans import FINE, plan
from uvf.maths.se2 import IDENTITY, Pose2, inverse, transform
from uvf.models.world.map_file import GridMap
from uvf.slam.maps.quality import compare, score
from uvf.slam.maps.walls import wall_figures

CELL = 0.05


def mapped(truth, origin=IDENTITY, shape=(200, 240)):
    """What a perfect lidar would have of a plan: free floor, the first cell of what is solid, the rest unknown."""
    rows, columns = np.indices(shape)
    centres = transform(origin, np.column_stack((columns.ravel() + 0.5, rows.ravel() + 0.5)) * CELL)
    x, y = ((centres - (truth.x, truth.y)) / FINE).astype(int).T
    inside = (x >= 0) & (y >= 0) & (x < truth.cells.shape[1]) & (y < truth.cells.shape[0])
    solid = np.ones(len(x), bool)
    solid[inside] = truth.cells[y[inside], x[inside]]
    free = ~solid.reshape(shape)
    cells = np.full(shape, -1, dtype=np.int8)
    cells[free] = 3
    near = np.pad(free, 1)
    beside = near[:-2, 1:-1] | near[2:, 1:-1] | near[1:-1, :-2] | near[1:-1, 2:]
    cells[beside & ~free] = 97
    return GridMap(cells, CELL, origin)


CORNER = Pose2(-0.53, -0.51, 0.0)


def test_a_true_map_is_all_right():
    found = score(mapped(plan(), CORNER), plan(), IDENTITY)
    assert [d.f1 for d in found.walls.detections] == [1.0, 1.0]
    assert found.walls.to_true[0] < 0.04 and found.walls.to_map[1] < 0.05
    assert found.free_iou > 0.98 and found.occupied_iou > 0.7
    assert found.unknown < 0.001
    assert found.thickness == pytest.approx(CELL, abs=0.01)
    assert found.double_walls == 0


def test_where_the_map_lies_is_minded_and_not_mended():
    plan_from_map = Pose2(1.3, -0.4, 0.7)
    grid = mapped(plan(), CORNER)
    turned = GridMap(grid.cells, CELL, Pose2(*transform(inverse(plan_from_map), np.array([CORNER[:2]]))[0], -0.7))
    assert score(turned, plan(), plan_from_map).walls.detections[0].f1 > 0.99
    shifted = score(grid, plan(), Pose2(0.06, 0.0, 0.0))
    assert shifted.walls.detections[0].precision < 0.75 and shifted.walls.detections[1].precision > 0.99
    assert shifted.walls.to_true[1] == pytest.approx(0.08, abs=0.03)


def test_walls_that_are_not_there_cost_precision_and_missing_ones_recall():
    bare, full = mapped(plan(solids=()), CORNER), mapped(plan(), CORNER)
    missing, invented = score(bare, plan(), IDENTITY), score(full, plan(solids=()), IDENTITY)
    share = 2.4 / (2.4 + 28.0)
    assert missing.walls.detections[1].precision == 1.0
    assert missing.walls.detections[1].recall == pytest.approx(1 - share, abs=0.02)
    assert invented.walls.detections[1].recall == 1.0
    assert invented.walls.detections[1].precision == pytest.approx(1 - share, abs=0.02)


@pytest.mark.parametrize("row", [slice(20, 100), 60])
def test_a_false_wall_one_cell_thick_costs_whichever_way_it_runs(row):
    grid = mapped(plan(), CORNER)
    right = score(grid, plan(), IDENTITY).walls.detections[1]
    false = grid.cells.copy()
    at = (row, 45) if isinstance(row, slice) else (row, slice(15, 50))
    false[at] = 97
    wrong = score(replace(grid, cells=false), plan(), IDENTITY).walls.detections[1]
    assert wrong.precision < right.precision - 0.03 and wrong.recall == pytest.approx(right.recall, abs=0.01)


def test_what_was_not_seen_is_unknown_not_missing():
    grid = mapped(plan(), CORNER)
    half = GridMap(np.where(np.arange(grid.cells.shape[1]) < 90, grid.cells, -1).astype(np.int8), CELL, CORNER)
    found = score(half, plan(), IDENTITY)
    assert found.walls.detections[1].recall > 0.99
    assert found.unknown == pytest.approx(1 - (90 * CELL - 0.53) / 8.0, abs=0.02)
    floor = ~plan().cells
    floor[:, 200:] = False
    assert score(half, plan(), IDENTITY, floor).unknown < 0.001


@pytest.mark.parametrize("apart", [0.15, 0.2, 0.3])
def test_a_wall_drawn_twice_is_counted(apart):
    grid = mapped(plan(), CORNER)
    cells = grid.cells.copy()
    row = round((1.0 + 0.51) / CELL)
    shift = round(apart / CELL)
    left = np.flatnonzero(cells[row] > 50)[0]
    cells[row : row + 40, left + shift] = 97  # 2 m of the left wall once more, a little inwards
    assert score(GridMap(cells, CELL, CORNER), plan(), IDENTITY).double_walls == 1
    top = np.flatnonzero(cells[:, 60] > 50)[-1]
    cells[top - shift, 20:50] = 97
    assert wall_figures(GridMap(cells, CELL, CORNER)).double_walls == 2


def test_an_open_door_leaf_is_no_double_wall():
    cells = mapped(plan(), CORNER).cells.copy()
    left = np.flatnonzero(cells[100] > 50)[0]
    for i in range(20):
        cells[60 + i, left + 1 + round(0.35 * i)] = 97
    assert wall_figures(GridMap(cells, CELL, CORNER)).double_walls == 0
    for i in range(40):
        cells[60 + i, left + 3 + round(0.03 * i)] = 97  # the wall once more, a little turned
    assert wall_figures(GridMap(cells, CELL, CORNER)).double_walls >= 1


def test_a_true_narrow_gap_is_no_double_wall():
    board = (2.0, 0.2, 4.0, 0.4)  # stands 0.2 m before the lower wall
    grid = mapped(plan(solids=(board,)), CORNER)
    assert wall_figures(grid).double_walls == 1
    assert score(grid, plan(solids=(board,)), IDENTITY).double_walls == 0


def test_the_two_faces_of_a_thin_wall_are_no_double_wall():
    rooms = ((0.0, 0.0, 3.95, 6.0), (4.05, 0.0, 8.0, 6.0))
    grid = mapped(plan((), rooms=rooms), CORNER)
    assert wall_figures(grid).double_walls == 0


def test_thickness_is_that_of_the_wall():
    grid = mapped(plan(), CORNER)
    thick = GridMap(np.where(grid.cells == 97, 97, grid.cells), CELL, CORNER)
    cells = thick.cells.copy()
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        cells = np.where(np.roll(grid.cells, step, axis) == 97, 97, cells)
    assert wall_figures(GridMap(cells, CELL, CORNER)).thickness == pytest.approx(3 * CELL, abs=0.02)


def test_two_maps_are_compared_where_both_know():
    a, b = mapped(plan(), CORNER), mapped(plan(), Pose2(-0.41, -0.33, 0.0))
    walls, free, occupied = compare(a, a)
    assert walls.detections[0].f1 == free == occupied == 1.0
    walls, free, occupied = compare(a, b)
    assert walls.detections[0].f1 > 0.98 and free > 0.96
    walls, _, _ = compare(mapped(plan(solids=()), CORNER), a)
    assert walls.detections[1].precision == 1.0 and walls.detections[1].recall < 0.95


def test_an_empty_map_scores_nothing():
    found = score(GridMap(np.full((1, 1), -1, dtype=np.int8), CELL, IDENTITY), plan(), IDENTITY)
    assert [d.f1 for d in found.walls.detections] == [0.0, 0.0]
    assert found.unknown == 1.0 and found.double_walls == 0
