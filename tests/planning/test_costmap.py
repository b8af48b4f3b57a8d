"""Costs: the body's room is kept, nearness is dear, unknown ground is shut unless asked for."""

import numpy as np
import pytest

from tests.services.planner.plans import drawn, room
from uvf.planning.costmap import IMPASSABLE, RobotFootprint, costmap, with_way_out
from uvf.planning.smoothing import length, resample, smoothed

BODY = RobotFootprint(radius=0.15, inflation_radius=0.35, cost_scaling_factor=5.0)


def test_no_cell_nearer_than_the_radius_is_passable():
    costs = costmap(room(2.0, 2.0), (0.05, (0.0, 0.0)), BODY)
    passable = costs.cost >= 0
    assert passable.any()
    assert costs.clearance[passable].min() >= BODY.radius
    assert (costs.cost[passable] >= 1.0).all()


def test_nearness_costs_more_and_ease_costs_one():
    costs = costmap(room(2.0, 2.0), (0.05, (0.0, 0.0)), BODY)
    row = costs.cost[20]
    assert row[20] == 1.0
    near = row[:20][row[:20] >= 0]
    assert (np.diff(near) <= 0).all()
    assert 3.0 < near[0] <= 5.0


def test_unknown_ground_is_impassable_unless_it_has_a_price():
    cells = drawn("....????\n" * 8)
    assert (costmap(cells, (0.05, (0.0, 0.0)), BODY).cost[:, 4:] == IMPASSABLE).all()
    assert (costmap(cells, (0.05, (0.0, 0.0)), BODY, unknown_cost=3.0).cost[:, 4:] == 3.0).all()


def test_cells_and_points_are_each_other():
    costs = costmap(room(2.0, 1.0), (0.05, (-3.0, 2.0)), BODY)
    for cell in ((0, 0), (7, 31)):
        x, y = costs.points(np.array((cell,)))[0]
        assert costs.cell(x, y) == cell
    assert not costs.holds(costs.cell(-3.1, 2.5))


def test_a_vehicle_too_near_a_wall_has_a_way_out():
    costs = costmap(room(2.0, 2.0), (0.05, (0.0, 0.0)), BODY)
    start = costs.cell(1.0, 0.18)
    assert costs.cost[start] < 0
    opened = with_way_out(costs, start, 0.3)
    assert opened.cost[start] > 1
    assert opened.cost[costs.cell(1.0, 0.07)] < 0
    assert opened.cost[costs.cell(1.9, 1.9)] == costs.cost[costs.cell(1.9, 1.9)]


def test_resampling_keeps_the_line():
    corner = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 0.55)))
    points = resample(corner, 0.1)
    assert length(points) == pytest.approx(1.55, abs=0.03)
    assert np.hypot(*np.diff(points, axis=0).T).max() <= 0.1 + 1e-9
    assert (points[-1] == corner[-1]).all()


def test_smoothing_rounds_corners_without_coming_too_near():
    cells = room(3.0, 3.0)
    cells[20:24, 20:60] = 100
    costs = costmap(cells, (0.05, (0.0, 0.0)), BODY)
    corner = np.array(((0.5, 0.5), (0.5, 1.6), (2.5, 1.6)))
    path = smoothed(corner, costs, BODY.radius)
    turns = np.abs(np.diff(np.unwrap(np.arctan2(*np.diff(path, axis=0).T[::-1]))))
    assert turns.max() < 0.6
    assert length(path) < length(corner)
    assert all(costs.clearance[costs.cell(x, y)] >= BODY.radius for x, y in path)
