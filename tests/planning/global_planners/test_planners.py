"""All global planners by name: paths hold in worlds of several kinds, what can be reached is reached, refusals are the right ones."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.planning.global_planners.worlds import BURGER, SMALL, WORLDS, check, flood, pose, scattered, world
from tests.planning.search.driving import SIDE, costmap, covered, filled_in
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.global_planners.planner import GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planners import PLANNERS, make_global_planner

HYBRID = ("hybrid_astar_dubins", "hybrid_astar_reeds_shepp")
SAMPLING = ("rrt", "rrt_star", "rrt_connect", "prm")
POINT = [name for name in PLANNERS if name not in HYBRID]
COMPLETE = [name for name in POINT if name not in (*SAMPLING, "potential_field")]
EVERY = pytest.mark.parametrize("name", PLANNERS)
SECONDS = 60.0
"""Enough that iterations end a search, whatever else the machine does."""


def plan(name, costs, start, goal, settings=None, **asked):
    return make_global_planner(name, costs, settings).plan(PathQuery(start, goal, seconds=SECONDS, **asked))


def check_driven(costs, path, start, goal):
    np.testing.assert_allclose(path[0, :2], start[:2], atol=1e-9)
    assert math.dist(path[-1, :2], goal[:2]) < 1.5 * SIDE
    assert covered(costs, filled_in(path, 3)) == 0


@EVERY
@pytest.mark.parametrize("where", WORLDS)
def test_paths_hold(name, where):
    costs, start, goal = world(where)
    found = plan(name, costs, start, goal)
    if name == "potential_field" and found.path is None:
        assert found.refusal is Refusal.LOCAL_MINIMUM and " m from the goal" in found.reason and where != "open"
        return
    if name == "hybrid_astar_dubins" and found.path is None:
        assert where == "spiral" and found.refusal is Refusal.NO_VALID_PATH  # there is hardly any room to turn
        return
    assert found.path is not None, found.reason
    assert found.refusal is None and found.reason == ""
    (check_driven if name in HYBRID else check)(costs, found.path, start, goal)
    assert found.length >= math.dist(start[:2], goal[:2]) * (1 - 1e-9)
    again = plan(name, costs, start, goal)
    assert np.array_equal(found.path, again.path)


@pytest.mark.parametrize("where", WORLDS)
def test_lengths_are_in_their_order(where):
    costs, start, goal = world(where)
    flat = GlobalPlannerSettings(cost_travel_multiplier=0.0)
    start, goal = (pose(costs.cell(*end[:2]), end[2]) for end in (start, goal))
    lengths = {name: plan(name, costs, start, goal, flat).length for name in POINT}
    assert lengths["dijkstra"] == pytest.approx(lengths["astar"], rel=1e-6)
    assert lengths["jump_points"] == pytest.approx(lengths["astar"], rel=1e-6)
    shortest = lengths.pop("visibility_graph")
    assert all(length >= shortest * (1 - 1e-4) for length in lengths.values())
    assert lengths["theta_star"] <= min(lengths["astar"], 1.03 * shortest) + 1e-9
    assert lengths["rrt_star"] <= 1.05 * shortest and lengths["prm"] <= 1.1 * shortest


@pytest.mark.parametrize("name", COMPLETE)
@given(seed=st.integers(0, 10**6), share=st.floats(0.05, 0.6))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_what_can_be_reached_is_reached_and_nothing_else(name, seed, share):
    costs, free = scattered(seed, share=share)
    if not len(free):
        return
    planner = make_global_planner(name, costs)
    start = tuple(free[seed % len(free)])
    reached = flood(costs.passable, start)
    for goal in map(tuple, free[:: max(len(free) // 8, 1)]):
        query = PathQuery(pose(start), pose(goal, 0.5))
        found = planner.plan(query)
        assert (found.path is not None) == reached[goal], found.reason
        if found.path is None:
            assert found.refusal is Refusal.NO_VALID_PATH and found.reason.startswith("no way leads to the goal")
        else:
            check(costs, found.path, query.start, query.goal)


@pytest.mark.parametrize("name", [*SAMPLING, "potential_field"])
@pytest.mark.parametrize("seed", range(6))
def test_planners_that_may_fail_never_say_what_is_not_so(name, seed):
    costs, free = scattered(seed, (20, 20), 0.25)
    planner, start = make_global_planner(name, costs), tuple(free[0])
    reached, met = flood(costs.passable, start), 0
    for goal in map(tuple, free[::40]):
        query = PathQuery(pose(start), pose(goal, 0.5))
        found = planner.plan(query)
        if found.path is not None:
            assert reached[goal]
            check(costs, found.path, query.start, query.goal)
            met += 1
        else:
            assert (found.refusal is Refusal.NO_VALID_PATH) == (not reached[goal])
    assert met > 0


@EVERY
def test_ends_that_cannot_be_are_refused(name):
    cells = np.zeros((60, 80), dtype=np.int8)
    cells[20:40, 30:50] = 100
    cells[:, 70:] = -1
    costs, free = costmap(cells, BURGER), (1.0, 1.0, 0.0)
    for at, word, kinds in (
        ((4.0, 3.0, 0.0), "obstacle", (Refusal.START_OCCUPIED, Refusal.GOAL_OCCUPIED)),
        ((4.0, 1.85, 0.0), "obstacle", (Refusal.START_OCCUPIED, Refusal.GOAL_OCCUPIED)),
        ((7.5, 3.0, 0.0), "unknown ground", (Refusal.START_OCCUPIED, Refusal.GOAL_OCCUPIED)),
        ((-0.01, 3.0, 0.0), "outside the map", (Refusal.START_OUTSIDE_MAP, Refusal.GOAL_OUTSIDE_MAP)),
        ((3.0, 1e12, 0.0), "outside the map", (Refusal.START_OUTSIDE_MAP, Refusal.GOAL_OUTSIDE_MAP)),
    ):
        for k, query in enumerate(((at, free), (free, at))):
            found = plan(name, costs, *query)
            assert found.path is None and found.refusal is kinds[k] and found.length == math.inf
            assert found.reason.startswith(("the start", "the goal")[k]) and word in found.reason


@EVERY
def test_they_are_moved_where_that_is_allowed(name):
    cells = np.zeros((60, 120), dtype=np.int8)
    cells[20:40, 30:50] = 100
    cells[:, 110:] = -1
    costs = costmap(cells, BURGER)
    start, goal = (4.0, 3.6, 0.0), (11.2, 3.0, 0.3)
    found = plan(name, costs, start, goal, tolerance=1.0)
    assert found.path is not None, found.reason
    centres = costs.points(np.argwhere(costs.passable))
    away = [np.hypot(*(centres - end[:2]).T).min() for end in (start, goal)]
    assert math.dist(found.path[0, :2], start[:2]) == pytest.approx(away[0], abs=SIDE)
    assert math.dist(found.path[-1, :2], goal[:2]) == pytest.approx(away[1], abs=SIDE)
    assert math.remainder(found.path[-1, 2] - 0.3, math.tau) == pytest.approx(0.0, abs=0.1)
    far = plan(name, costs, (1.0, 1.0, 0.0), (4.0, 3.0, 0.0), tolerance=0.5)
    assert far.refusal is Refusal.GOAL_OCCUPIED and "within 0.5 m" in far.reason


@pytest.mark.parametrize("name", POINT)
def test_a_goal_that_is_shut_in_is_moved_to_the_nearest_place_that_can_be_reached(name):
    cells = np.zeros((60, 80), dtype=np.int8)
    cells[20:40, 50:52] = cells[20:40, 68:70] = cells[20:22, 50:70] = cells[38:40, 50:70] = 100
    costs, start, goal = costmap(cells, SMALL), (1.0, 3.0, 0.0), (5.8, 3.0, 0.0)
    assert plan(name, costs, start, goal).refusal is Refusal.NO_VALID_PATH
    found = plan(name, costs, start, goal, tolerance=2.0)
    assert found.path is not None, found.reason
    assert found.path[-1, :2] == pytest.approx((4.95, 2.95), abs=0.11)
    assert plan(name, costs, goal, start).refusal is Refusal.NO_VALID_PATH


@EVERY
def test_unknown_ground_is_crossed_only_where_it_is_allowed(name):
    cells = np.zeros((60, 120), dtype=np.int8)
    cells[:, 50:70] = -1
    costs, start, goal = costmap(cells, BURGER), (2.0, 3.0, 0.0), (10.0, 3.2, 0.0)
    found = plan(name, costs, start, goal)
    assert found.refusal is Refusal.NO_VALID_PATH and found.reason.startswith("no way leads to the goal")
    over = plan(name, costs, start, goal, GlobalPlannerSettings(unknown_cost=2.0))
    assert over.path is not None, over.reason


@EVERY
def test_keep_out_cells_are_heeded(name):
    cells = np.zeros((60, 120), dtype=np.int8)
    cells[15:45, 50:70] = 100  # a zone drawn on the map, as an obstacle is
    costs, start, goal = costmap(cells, BURGER), (2.0, 1.5, 0.0), (10.0, 3.2, 0.0)
    found = plan(name, costs, start, goal)
    if name == "potential_field" and found.path is None:
        return
    columns, rows = (found.path[:, :2] / SIDE).astype(int).T
    assert (costs.values[rows, columns] != LETHAL).all() and (costs.distance[rows, columns] * SIDE > 0.2).all()


@EVERY
def test_who_is_there_stays(name):
    costs = costmap(np.zeros((40, 40), dtype=np.int8), BURGER)
    here = plan(name, costs, (2.0, 2.0, 0.7), (2.0, 2.0, 0.7))
    assert here.path.tolist() == [[2.0, 2.0, pytest.approx(0.7)]] and here.length == 0.0


@pytest.mark.parametrize("name", POINT)
def test_within_a_cell(name):
    costs = costmap(np.zeros((40, 40), dtype=np.int8), BURGER)
    found = plan(name, costs, (2.01, 2.02, 0.7), (2.08, 2.03, 1.0))
    assert found.length == pytest.approx(math.hypot(0.07, 0.01)) and found.path[-1, 2] == 1.0


@EVERY
@pytest.mark.parametrize(("shape", "value"), [((1, 1), 0), ((1, 30), 0), ((30, 1), 0), ((2, 2), -1), ((25, 25), -1), ((25, 25), 100)])
def test_strange_maps(name, shape, value):
    costs = costmap(np.full(shape, value, dtype=np.int8), SMALL)
    start, goal = pose((0, 0)), pose((shape[0] - 1, shape[1] - 1), 0.0 if shape[0] == 1 else math.pi / 2)
    found = plan(name, costs, start, goal)
    if value:
        assert found.refusal is Refusal.START_OCCUPIED
    elif name in POINT:
        check(costs, found.path, start, goal)
    else:
        assert (found.path is None) == bool(found.reason)


@EVERY
def test_a_map_far_away(name):
    cells, start, goal = WORLDS["comb"]
    near = plan(name, costmap(cells, BURGER), start, goal)
    far = plan(name, costmap(cells, BURGER, (-5000.0, 800.0)), *((x - 5000.0, y + 800.0, yaw) for x, y, yaw in (start, goal)))
    assert near.refusal is far.refusal
    assert far.length == pytest.approx(near.length, rel=0.02 if name in (*SAMPLING, *HYBRID) else 1e-6)


@pytest.mark.parametrize("name", ["rrt", "rrt_star", "rrt_connect", "prm"])
def test_the_seed_decides(name):
    costs, start, goal = world("boxes 1")
    one, same, other = (plan(name, costs, start, goal, seed=seed).path for seed in (4, 4, 5))
    assert np.array_equal(one, same) and not np.array_equal(one, other)


@pytest.mark.parametrize("name", ["rrt", "rrt_star", "rrt_connect", "visibility_graph"])
def test_time_that_has_run_out_is_told(name):
    costs, start, goal = world("rooms")
    found = make_global_planner(name, costs).plan(PathQuery(start, goal, seconds=0.0))
    assert found.refusal is Refusal.TIMED_OUT and "no way was found" in found.reason


def test_an_unknown_name_names_the_nearest():
    with pytest.raises(ValueError, match=r"no 'a_star'.*astar"):
        make_global_planner("a_star", costmap(np.zeros((3, 3))))


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: PathQuery((math.nan, 0, 0), (0, 0, 0)), r"start: .* is no configuration"),
        (lambda: PathQuery((0, 0, 0), (0, math.inf, 0)), r"goal: .* is no configuration"),
        (lambda: PathQuery((0, 0, 0), (0, 0, 0), tolerance=-1.0), r"tolerance: -1\.0 m"),
        (lambda: PathQuery((0, 0, 0), (0, 0, 0), seconds=math.nan), r"seconds: nan s"),
        (lambda: PathQuery((0, 0, 0), (0, 0, 0), seed=-1), r"seed: -1"),
        (lambda: GlobalPlannerSettings(cost_travel_multiplier=math.nan), r"cost_travel_multiplier: nan"),
        (lambda: GlobalPlannerSettings(unknown_cost=0.5), r"unknown_cost: 0\.5"),
        (lambda: GlobalPlannerSettings(minimum_turning_radius=0.0), r"turning radius"),
    ],
)
def test_what_makes_no_sense_is_refused(make, why):
    with pytest.raises(ValueError, match=why):
        make()
