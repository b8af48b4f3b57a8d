"""Ways cut short: fewer pieces, the same ends, free as before; sampled poses lie on the pieces."""

import math

import numpy as np
import pytest

from tests.planning.search.driving import CAR, SIDE, check_turns, costmap, covered, filled_in
from uvf.maths.curves.segments import moved
from uvf.planning.costmap.inflation import cost_factors
from uvf.planning.search.hybrid_expansion import Question, curve_cost
from uvf.planning.search.hybrid_pieces import cut_short, sampled
from uvf.planning.search.pose_check import pose_check

RADIUS = 8.0  # cells


def swaying(turns, length=4.0):
    """Pieces (n, 5) that turn left and right by chance, and the pose where they end."""
    at, pieces = (20.0, 40.0, 0.0), []
    for turn in turns:
        pieces.append((*at, length, turn / RADIUS))
        at = moved(*at, turn / RADIUS, length)
    return np.array(pieces), at


def question(reverses):
    return Question((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), RADIUS, reverses, (2.0, 0.0, 1.2), 0.5, 0.05, 1000, 1000)


def cost_of(check, ask, pieces):
    return sum(curve_cost(check, ask, tuple(piece[:3]), piece[None, 3:].copy()) for piece in pieces)


@pytest.mark.parametrize("reverses", [False, True])
@pytest.mark.parametrize("wall", [False, True])
def test_a_swaying_way_gets_straight_as_far_as_there_is_room(reverses, wall):
    cells = np.zeros((80, 220))
    turns = np.array([1, -1, -1, 1] * 6 + [0])
    pieces, end = swaying(turns)
    if wall:
        cells[30:38, 59:62] = 100
    costs = costmap(cells, CAR)
    check, ask = pose_check(costs, cost_factors(2.0)), question(reverses)
    assert math.isfinite(cost_of(check, ask, pieces))
    short, saved = cut_short(check, ask, pieces, end)
    assert len(short) < len(pieces) / 2
    assert cost_of(check, ask, short) == pytest.approx(cost_of(check, ask, pieces) - saved, rel=1e-9) and saved > 1.0
    path = sampled(short, (20.0, 40.0, 0.0))
    assert math.dist(path[-1, :2], end[:2]) < 1e-6 and abs(math.remainder(path[-1, 2] - end[2], math.tau)) < 1e-6
    path[:, :2] *= SIDE
    check_turns(path[:, :3], path[:, 3], RADIUS * SIDE)
    assert covered(costs, filled_in(path[:, :3], 5), 0.3 * SIDE) == 0
    assert not wall or len(short) > 3


def test_a_way_that_is_the_shortest_stays():
    costs = costmap(np.zeros((80, 220)), CAR)
    pieces, end = np.array([(20.0, 40.0, 0.0, 30.0, 0.0), (50.0, 40.0, 0.0, 4.0, 1 / RADIUS)]), moved(50.0, 40.0, 0.0, 1 / RADIUS, 4.0)
    short, saved = cut_short(pose_check(costs, cost_factors(2.0)), question(False), pieces, end)
    assert saved == 0.0 and np.array_equal(short, pieces)
    nothing, saved = cut_short(pose_check(costs, cost_factors(2.0)), question(False), np.empty((0, 5)), end)
    assert len(nothing) == 0 and saved == 0.0


def test_sampled_poses_lie_on_the_pieces():
    path = sampled(np.array([(1.0, 2.0, 3.0, 2.0, 0.2), (0.0, 0.0, -3.0, -1.0, 0.0)]), (1.0, 2.0, 3.0))
    assert path[0].tolist() == [1.0, 2.0, 3.0, 1.0] and path[-1, 3] == -1.0
    assert (np.abs(path[:, 2]) <= math.pi).all() and len(path) == 1 + 4 + 2
    assert path[4, :2] == pytest.approx(moved(1.0, 2.0, 3.0, 0.2, 2.0)[:2])
    assert sampled(np.empty((0, 5)), (1.0, 2.0, 4.0)).tolist() == [[1.0, 2.0, pytest.approx(4.0 - math.tau), 1.0]]
