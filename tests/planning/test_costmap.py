"""Costs: the body's room is kept, nearness is dear, unknown ground is shut unless asked for; values are those of ROS."""

import numpy as np
import pytest

from tests.services.planner.plans import drawn, room
from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import INSCRIBED, LETHAL, NO_INFORMATION, Inflation, cost_factors, inflate
from uvf.planning.costmap.own_ground import LEAVING, with_way_out
from uvf.planning.smoothing import length, resample, smoothed

RADIUS = 0.15
BODY, INFLATION = RobotFootprint.circle(RADIUS), Inflation(0.55, 6.0)
FRAME = (0.05, (0.0, 0.0))


def test_no_cell_nearer_than_the_radius_is_passable():
    costs = make_costmap(room(2.0, 2.0), FRAME, BODY, INFLATION)
    assert costs.passable.any()
    assert costs.clearance[costs.passable].min() >= RADIUS


def test_nearness_costs_more_and_ease_nothing():
    costs = make_costmap(room(2.0, 2.0), FRAME, BODY, INFLATION)
    row = costs.values[20]
    assert row[20] == 0
    near = row[:20][row[:20] < INSCRIBED].astype(int)
    assert (np.diff(near) <= 0).all()
    assert 150 < near[0] <= 252


def test_values_round_an_obstacle_are_those_of_costmap_2d():
    """ROS computes 254 at the obstacle, 253 up to the inscribed radius, then 252 exp(-k (d - inscribed)), cut to whole numbers."""
    cells = np.zeros((41, 41), dtype=np.uint8)
    cells[20, 20] = LETHAL
    values, distance = inflate(cells, 0.1, 0.5, Inflation(1.0, 10.0))
    rows, columns = np.indices(cells.shape)
    expected = np.hypot(rows - 20, columns - 20) * 0.1
    wanted = np.where(expected <= 0.5, 253, np.where(expected > 1.0, 0, np.trunc(252 * np.exp(-10.0 * (expected - 0.5)))))
    wanted[20, 20] = 254
    sure = np.abs(expected - 0.5) > 1e-9  # on the circle itself rounding decides
    assert (values[sure] == wanted[sure]).all()
    assert distance[20, 28] == pytest.approx(8.0)


def test_unknown_ground_stays_unknown_but_beside_an_obstacle():
    cells = np.full((9, 30), NO_INFORMATION, dtype=np.uint8)
    cells[4, 3] = LETHAL
    values, _ = inflate(cells, 0.05, 0.15, Inflation(0.55, 3.0))
    assert values[4, 5] == INSCRIBED and values[4, 8] == NO_INFORMATION


def test_unknown_ground_is_impassable_unless_it_has_a_price():
    costs = make_costmap(drawn("....????\n" * 8), FRAME, BODY, INFLATION)
    assert (cost_factors(2.0)[costs.values[:, 4:]] < 0.0).all()
    assert (cost_factors(2.0, 3.0)[costs.values[:, 4:]] == 3.0).all()
    assert (cost_factors(2.0)[[0, 126, 252]] == (1.0, 2.0, 3.0)).all()


def test_cells_and_points_are_each_other():
    costs = make_costmap(room(2.0, 1.0), (0.05, (-3.0, 2.0)), BODY, INFLATION)
    for cell in ((0, 0), (7, 31)):
        x, y = costs.points(np.array((cell,)))[0]
        assert costs.cell(x, y) == cell
    assert not costs.holds(costs.cell(-3.1, 2.5))


def test_a_vehicle_too_near_a_wall_has_a_way_out():
    costs = make_costmap(room(2.0, 2.0), FRAME, BODY, INFLATION)
    start = costs.cell(1.0, 0.18)
    assert costs.values[start] == INSCRIBED
    opened = with_way_out(costs, start, 0.3)
    assert opened.values[start] == LEAVING
    assert opened.values[costs.cell(1.0, 0.07)] >= INSCRIBED
    assert opened.values[costs.cell(1.9, 1.9)] == costs.values[costs.cell(1.9, 1.9)]


def test_resampling_keeps_the_line():
    corner = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 0.55)))
    points = resample(corner, 0.1)
    assert length(points) == pytest.approx(1.55, abs=0.03)
    assert np.hypot(*np.diff(points, axis=0).T).max() <= 0.1 + 1e-9
    assert (points[-1] == corner[-1]).all()


def test_smoothing_rounds_corners_without_coming_too_near():
    cells = room(3.0, 3.0)
    cells[20:24, 20:60] = 100
    costs = make_costmap(cells, FRAME, BODY, INFLATION)
    corner = np.array(((0.5, 0.5), (0.5, 1.6), (2.5, 1.6)))
    path = smoothed(corner, costs, RADIUS)
    turns = np.abs(np.diff(np.unwrap(np.arctan2(*np.diff(path, axis=0).T[::-1]))))
    assert turns.max() < 0.6
    assert length(path) < length(corner)
    assert all(costs.clearance[costs.cell(x, y)] >= RADIUS for x, y in path)
