"""Exploration goes where something new can be seen, and leaves alone what nothing came of."""

import numpy as np
import pytest

from tests.services.planner.plans import room
from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import INSCRIBED, Inflation, cost_factors
from uvf.planning.exploration import SHUN_TIME, Explorer, OthersGoal, Patrol
from uvf.planning.frontiers import FrontierChoice, FrontierWeights, frontiers
from uvf.planning.information_gain import unknown_area
from uvf.planning.search.grid_search import GridSearch

BODY, INFLATION = RobotFootprint.circle(0.1), Inflation(0.2, 6.0)
TASTE = FrontierWeights(least_size=4, view=0.3, worth=0.5)


def costs_of(cells):
    return make_costmap(cells, (0.05, (0.0, 0.0)), BODY, INFLATION)


def two_doors():
    """A room of 4 x 2 m with a wide opening on the left and a narrow one on the right."""
    cells = room(4.0, 2.0)
    cells[10:26, :2] = 0
    cells[10:26, 0] = -1
    cells[15:21, -2:] = 0
    cells[15:21, -1] = -1
    return costs_of(cells)


def ways_from(costs, x, y):
    return GridSearch(costs.values, cost_factors(2.0)).cost_to_go(costs.cell(x, y))


def none_shunned(costs):
    return np.zeros(costs.values.shape, dtype=bool)


def test_both_openings_are_frontiers_and_the_walls_are_not():
    costs = two_doors()
    found = frontiers(costs, ways_from(costs, 2.0, 1.0).cost, none_shunned(costs), TASTE)
    assert len(found) == 2
    assert {round(costs.points(np.array((f.goal,)))[0][0]) for f in found} == {0, 4}


def test_the_nearer_frontier_comes_first():
    costs = two_doors()
    for x, side in ((1.0, 0), (3.2, 4)):
        found = frontiers(costs, ways_from(costs, x, 1.0).cost, none_shunned(costs), TASTE)
        assert round(costs.points(np.array((found[0].goal,)))[0][0]) == side


def test_a_crack_is_no_frontier():
    cells = room(4.0, 2.0)
    cells[15:17, -2:] = 0
    cells[15:17, -1] = -1
    costs = costs_of(cells)
    assert frontiers(costs, ways_from(costs, 2.0, 1.0).cost, none_shunned(costs), TASTE) == []


def test_keeps_its_goal_until_nothing_new_is_left_there():
    costs = two_doors()
    explorer = Explorer(TASTE)
    first = explorer.choose(0.0, costs, ways_from(costs, 1.0, 1.0))
    assert explorer.choose(1.0, costs, ways_from(costs, 3.2, 1.0)) == first
    seen = room(4.0, 2.0)
    seen[15:21, -2:] = 0
    seen[15:21, -1] = -1
    other = costs_of(seen)
    assert explorer.choose(2.0, other, ways_from(other, 1.0, 1.0))[0] > 3.0


def test_a_goal_given_up_is_left_alone_for_a_while():
    costs = two_doors()
    explorer = Explorer(TASTE)
    ways = ways_from(costs, 1.0, 1.0)
    first = explorer.choose(0.0, costs, ways)
    explorer.blacklist_goal(0.0)
    second = explorer.choose(0.1, costs, ways)
    assert second[0] > 3.0 > first[0]
    explorer.blacklist_goal(0.2)
    assert explorer.choose(0.3, costs, ways) is None
    assert explorer.choose(SHUN_TIME + 0.1, costs, ways) == pytest.approx(first)


def test_a_closed_room_is_explored():
    costs = costs_of(room(2.0, 2.0))
    explorer = Explorer(TASTE)
    assert explorer.choose(0.0, costs, ways_from(costs, 1.0, 1.0)) is None
    assert explorer.explored == 1.0


def test_a_patrol_visits_all_ends_of_the_room():
    costs = costs_of(room(6.0, 2.0))
    patrol = Patrol()
    here, seen = (3.0, 1.0), []
    for _ in range(6):
        here = patrol.choose(here, costs, ways_from(costs, *here))
        seen.append(here)
        patrol.reached()
    assert min(x for x, _ in seen) < 1.0
    assert max(x for x, _ in seen) > 5.0
    assert all(costs.values[costs.cell(*p)] < INSCRIBED for p in seen)


def test_a_patrol_whose_goal_is_no_longer_on_the_map_goes_elsewhere():
    large, small = costs_of(room(6.0, 2.0)), costs_of(room(2.0, 2.0))
    patrol = Patrol()
    assert patrol.choose((1.0, 1.0), large, ways_from(large, 1.0, 1.0))[0] > 5.0
    assert patrol.choose((1.0, 1.0), small, ways_from(small, 1.0, 1.0))[0] < 2.0
    patrol.goal = (-0.5, 1.0)  # the last columns, were it taken for an index
    assert patrol.choose((1.0, 1.0), small, ways_from(small, 1.0, 1.0))[0] > 0.0


@pytest.mark.parametrize(("choice", "side"), [(FrontierChoice.NEAREST, 4), (FrontierChoice.INFORMATION_GAIN, 0)])
def test_nearest_goes_to_the_near_crack_and_information_gain_to_the_wide_opening(choice, side):
    costs = two_doors()
    taste = FrontierWeights(least_size=4, view=0.3, worth=0.5, choice=choice)
    found = frontiers(costs, ways_from(costs, 2.3, 1.0).cost, none_shunned(costs), taste)
    assert round(costs.points(np.array((found[0].goal,)))[0][0]) == side


def test_the_area_that_could_be_seen_is_that_of_the_circle_less_what_is_known_or_hidden():
    unknown, taken = np.ones((81, 81), dtype=bool), np.zeros((81, 81), dtype=bool)
    assert unknown_area(unknown, taken, (40, 40), 30.0) == pytest.approx(np.pi * 30.0**2, rel=0.04)
    assert unknown_area(~unknown, taken, (40, 40), 30.0) == 0.0
    taken[:, 45] = True
    hidden = unknown_area(unknown, taken, (40, 40), 30.0) / (np.pi * 30.0**2)
    assert 0.55 < hidden < 0.65
    assert unknown_area(~unknown, ~taken & False, (0, 0), 30.0) == pytest.approx(0.75 * np.pi * 30.0**2, rel=0.06)


def test_two_that_explore_go_to_different_frontiers_and_the_first_keeps_its_own():
    costs = two_doors()
    ways, wide, crack = ways_from(costs, 1.0, 1.0), (0.1, 0.9), (3.9, 0.9)
    assert Explorer(TASTE).choose(0.0, costs, ways)[0] < 1.0
    assert Explorer(TASTE).choose(0.0, costs, ways, [OthersGoal(wide, comes_first=True)])[0] > 3.0
    both = [OthersGoal(wide, comes_first=True), OthersGoal(crack, comes_first=True)]
    assert Explorer(TASTE).choose(0.0, costs, ways, both)[0] < 1.0
    explorer = Explorer(TASTE)
    explorer.choose(0.0, costs, ways)
    assert explorer.choose(0.5, costs, ways, [OthersGoal(wide, comes_first=False)])[0] < 1.0
    assert explorer.choose(1.0, costs, ways, [OthersGoal(wide, comes_first=True)])[0] > 3.0
