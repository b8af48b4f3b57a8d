"""The descent leads to the goal where it can, and to a minimum that is one where it cannot."""

import math
import re

import numpy as np
import pytest

from tests.planning.global_planners.worlds import BURGER, check
from tests.planning.search.driving import costmap
from uvf.planning.global_planners.planner import PathQuery, Refusal
from uvf.planning.global_planners.planners import make_global_planner
from uvf.planning.global_planners.potential_field import PotentialField, potential


def descent(cells, start, goal):
    costs = costmap(cells, BURGER)
    return costs, make_global_planner("potential_field", costs).plan(PathQuery(start, goal))


def test_in_the_open_it_is_nearly_straight():
    costs, found = descent(np.zeros((100, 160)), (2.0, 2.0, 0.0), (14.0, 7.3, 1.0))
    assert found.length == pytest.approx(math.hypot(12.0, 5.3), rel=0.01)
    check(costs, found.path, (2.0, 2.0, 0.0), (14.0, 7.3, 1.0))


def test_round_a_pillar_at_a_distance():
    cells = np.zeros((100, 160))
    rows, columns = np.indices(cells.shape)
    cells[np.hypot(rows - 50, columns - 80) < 4.0] = 100
    costs, found = descent(cells, (2.0, 5.6, 0.0), (14.0, 5.0, 0.0))
    check(costs, found.path, (2.0, 5.6, 0.0), (14.0, 5.0, 0.0))
    assert min(costs.clearance_at(costs.cell(x, y)) for x, y, _ in found.path) > 0.3


@pytest.mark.parametrize("beside", [0.35, 0.6, 1.0])
def test_a_goal_beside_a_wall_is_reached(beside):
    cells = np.zeros((100, 160))
    cells[:, 150:] = 100
    _, found = descent(cells, (2.0, 2.0, 0.0), (15.0 - beside, 7.0, 0.0))
    assert found.path is not None, found.reason


def test_a_pocket_is_a_minimum_and_is_told():
    cells = np.zeros((100, 160))
    cells[30:70, 80:84] = cells[30:34, 50:84] = cells[66:70, 50:84] = 100
    _, found = descent(cells, (2.0, 5.0, 0.0), (14.0, 5.0, 0.0))
    assert found.path is None and found.refusal is Refusal.LOCAL_MINIMUM
    x, y, left = map(float, re.findall(r"-?\d+\.\d+", found.reason))
    assert 5.0 < x < 8.0 and 3.4 < y < 6.6 and left == pytest.approx(math.dist((x, y), (14.0, 5.0)), abs=0.02)


def test_the_potential_is_the_distance_far_from_walls_and_grows_towards_them():
    distance = np.broadcast_to(np.minimum(np.arange(60.0), 59.0 - np.arange(60.0)), (60, 60)).copy()
    field = PotentialField(distance, (30.0, 50.0), 10.0, 20.0)
    assert potential(field, 30.0, 10.0) == pytest.approx(40.0)
    row = [potential(field, x, 10.0) - math.dist((x, 10.0), (30.0, 50.0)) for x in np.arange(9.0, 0.5, -0.5)]
    assert (np.diff(row) > 0).all() and row[0] > 0.0
    # Khatib's term at 4 cells of room, half a cell counted off between centre and edge.
    assert potential(field, 5.0, 10.0) - math.hypot(25.0, 40.0) == pytest.approx(0.5 * 20.0 * (1 / 4.0 - 1 / 10.0) ** 2, rel=1e-9)
