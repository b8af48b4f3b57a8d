"""The goal's place stays reached while the vehicle turns; the turn goes the shorter way and ends in the heading."""

import numpy as np
import pytest

from tests.planning.local.grounds import LIMITS, moved
from uvf.maths.rotations import wrap
from uvf.planning.local.goal_checker import GoalChecker, GoalTolerances, turn_to_heading
from uvf.planning.local.planner import State


def at(x, y, yaw=0.0):
    return State(x, y, yaw, 0.0, 0.0)


def test_the_place_counts_within_its_tolerance_and_stays_reached_until_there_is_another_goal():
    checker = GoalChecker(GoalTolerances(xy_goal_tolerance=0.2))
    assert not checker.at_place(at(0.0, 0.0), (0.3, 0.0))
    assert checker.at_place(at(0.15, 0.0), (0.3, 0.0))
    assert checker.at_place(at(-0.1, 0.0), (0.3, 0.0))  # it drifted as it turned
    assert checker.at_place(at(-0.1, 0.0), (0.25, 0.0))  # the same goal, planned again
    assert not checker.at_place(at(-0.1, 0.0), (1.3, 0.0))
    assert checker.at_place(at(1.2, 0.0), (1.3, 0.0))
    checker.reset()
    assert not checker.at_place(at(0.0, 0.0), (1.3, 0.0))


@pytest.mark.parametrize("yaw", [0.0, 3.1, -3.1, 6.5])
def test_the_heading_counts_round_the_circle(yaw):
    checker = GoalChecker(GoalTolerances(yaw_goal_tolerance=0.1))
    assert checker.has_heading(at(0.0, 0.0, yaw), yaw + 2.0 * np.pi + 0.09)
    assert not checker.has_heading(at(0.0, 0.0, yaw), yaw - 0.11)


@pytest.mark.parametrize(("start", "heading"), [(0.0, 1.5), (0.0, -3.0), (3.0, -3.0), (-2.0, 2.0), (0.0, 0.15)])
def test_the_turn_goes_the_shorter_way_without_overshooting(start, heading):
    state, way = at(0.0, 0.0, start), wrap(heading - start)
    turned = 0.0
    for _ in range(100):
        before = state.yaw
        state = moved(state, turn_to_heading(state, heading, LIMITS))
        turned += state.yaw - before
        assert abs(turned) < abs(way) + 0.03 and turned * way >= 0.0
    assert abs(wrap(heading - state.yaw)) < 0.05 and (state.x, state.y) == (0.0, 0.0)
