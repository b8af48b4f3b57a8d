"""Hybrid-A*: outline and turns looked at by other means, what cannot be reached is told soon, strangers' vehicles and maps."""

import math
import time

import numpy as np
import pytest

from tests.planning.search.driving import CAR, SIDE, blocks, check_turns, costmap, covered, filled_in
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import cost_factors
from uvf.planning.search.hybrid_astar import HybridAStar, SteeredVehicle

RADIUS = 0.8
FORWARDS, BOTH = SteeredVehicle(RADIUS, False), SteeredVehicle(RADIUS, True)
VEHICLES = pytest.mark.parametrize("vehicle", [FORWARDS, BOTH], ids=["dubins", "reeds_shepp"])
QUERY = (1.5, 1.5, 0.4), (18.4, 10.4, -0.9)
GROWN = 0.3 * SIDE
"""Of the outline: half a cell is kept on the poses that are looked at, something less between them."""


def planner(cells, vehicle, footprint=CAR):
    return HybridAStar(costmap(cells, footprint), cost_factors(2.0), vehicle)


def check(costs, vehicle, plan, query, grown=GROWN, exact=True):
    start, goal = query
    assert plan.path is not None, plan.reason
    assert math.dist(plan.path[0, :2], start[:2]) < 1e-9 and abs(math.remainder(plan.path[0, 2] - start[2], math.tau)) < 1e-9
    off = math.dist(plan.path[-1, :2], goal[:2]), abs(math.remainder(plan.path[-1, 2] - goal[2], math.tau))
    assert off[0] <= (1e-6 if exact else SIDE * math.sqrt(2)) and off[1] <= (1e-6 if exact else math.tau / 64)
    assert set(np.unique(plan.direction)) <= ({1.0, -1.0} if vehicle.reverses else {1.0})
    check_turns(plan.path, plan.direction, max(vehicle.minimum_turning_radius, costs.resolution))
    assert covered(costs, filled_in(plan.path, 6), grown) == 0
    steps = np.hypot(*np.diff(plan.path[:, :2], axis=0).T)
    assert steps.max(initial=0.0) <= 0.6 * costs.resolution + 1e-9
    assert plan.cost >= steps.sum() * (1 - 1e-6) and steps.sum() >= (math.dist(start[:2], goal[:2]) - off[0]) * (1 - 1e-6)


@VEHICLES
@pytest.mark.parametrize("seed", range(6))
def test_paths_hold_among_boxes(vehicle, seed):
    cells = blocks(seed)
    search = planner(cells, vehicle)
    rng, met = np.random.default_rng(seed), 0
    queries = [QUERY, *[tuple((*rng.uniform((0.6, 0.6), (19.4, 11.4)), rng.uniform(-4, 4)) for _ in range(2)) for _ in range(5)]]
    for query in queries:
        plan = search.plan(*query)
        assert plan.path is None or not plan.reason
        if plan.path is not None:
            check(search._costs, vehicle, plan, query, 0.0, exact=False)
            met += 1
        again = HybridAStar(search._costs, cost_factors(2.0), vehicle).plan(*query)
        assert (plan.path is None) == (again.path is None)
        assert plan.path is None or np.array_equal(plan.path, again.path)
    check(search._costs, vehicle, search.plan(*QUERY), QUERY, exact=False)
    assert met >= 2


@VEHICLES
def test_in_the_open_the_path_is_nearly_the_shortest_curve(vehicle):
    search = planner(np.zeros((150, 150)), vehicle)
    straight = search.plan((2.0, 2.0, 0.0), (9.0, 2.0, 0.0))
    assert straight.cost == pytest.approx(7.0, rel=1e-6)
    turned = search.plan((5.0, 5.0, 0.0), (5.0, 5.0 + 2 * RADIUS, math.pi))
    assert math.pi * RADIUS * 0.999 <= turned.cost / 1.2 <= math.pi * RADIUS * 1.02
    check(search._costs, vehicle, turned, ((5.0, 5.0, 0.0), (5.0, 5.0 + 2 * RADIUS, math.pi)))


def test_only_who_reverses_gets_out_of_a_dead_end():
    cells = np.zeros((60, 160))
    cells[:22, :120] = cells[-22:, :120] = cells[:, :3] = 100
    query = (1.5, 3.0, math.pi), (14.0, 3.0, 0.0)
    search = planner(cells, BOTH)
    plan = search.plan(*query)
    check(search._costs, BOTH, plan, query)
    assert -1.0 in plan.direction
    stuck = planner(cells, FORWARDS).plan(*query)
    assert stuck.path is None and "no room to turn" in stuck.reason


def test_reversing_costs_what_it_is_said_to():
    search = planner(np.zeros((60, 160)), SteeredVehicle(RADIUS, True, reverse_penalty=3.0))
    plan = search.plan((8.0, 3.0, 0.0), (7.0, 3.0, 0.0))
    assert plan.cost == pytest.approx(3.0, rel=1e-3) and (plan.direction == -1.0).all()


@VEHICLES
def test_what_is_shut_off_is_told_at_once(vehicle):
    cells = np.zeros((300, 300))
    cells[180:260, 180:183] = cells[180:260, 257:260] = cells[180:183, 180:260] = cells[257:260, 180:260] = 100
    search = planner(cells, vehicle)
    search.plan((2.0, 2.0, 0.0), (4.0, 2.0, 0.0))
    for start, goal in (((2.0, 2.0, 0.0), (22.0, 22.0, 0.0)), ((22.0, 22.0, 0.0), (2.0, 2.0, 0.0))):
        begun = time.thread_time()
        plan = search.plan(start, goal)
        assert plan.path is None and plan.reason.startswith("no way leads to the goal") and plan.expanded == 0
        assert time.thread_time() - begun < 1.0


def test_a_goal_that_cannot_be_come_to_in_its_heading_is_told_soon():
    cells = np.zeros((300, 300))
    cells[100:111, 100:200] = cells[119:130, 100:200] = cells[:, 197:203] = 100
    start, goal = (5.0, 20.0, 0.0), (18.5, 11.5, math.pi)  # in a blind alley, looking out
    forwards = planner(cells, FORWARDS)
    forwards.plan(start, (5.0, 21.0, 0.0))
    begun = time.thread_time()
    plan = forwards.plan(start, goal)
    assert time.thread_time() - begun < 1.0
    assert plan.path is None and plan.reason.endswith("no room to come to it in that heading")
    check(forwards._costs, FORWARDS, forwards.plan(start, (18.0, 11.5, 0.0)), (start, (18.0, 11.5, 0.0)))
    both = planner(cells, BOTH)
    check(both._costs, BOTH, both.plan(start, goal), (start, goal))


@VEHICLES
def test_a_gap_for_the_disc_within_but_not_for_the_outline_is_none(vehicle):
    cells = np.zeros((100, 200))
    cells[:, 95:110] = 100
    cells[48:53, 95:110] = 0  # 0.5 m, as wide as the car, with half a cell less on either side
    plan = planner(cells, vehicle).plan((3.0, 5.0, 0.0), (17.0, 5.0, 0.0))
    assert plan.path is None
    cells[46:55, 95:110] = 0
    search = planner(cells, vehicle)
    check(search._costs, vehicle, search.plan((3.0, 5.0, 0.0), (17.0, 5.0, 0.0)), ((3.0, 5.0, 0.0), (17.0, 5.0, 0.0)))


@VEHICLES
def test_ends_that_are_not_free(vehicle):
    cells = np.zeros((100, 100))
    cells[40:60, 40:60] = 100
    cells[:, 90:] = -1
    search, free = planner(cells, vehicle), (2.0, 2.0, 0.0)
    for at, why in (
        ((5.0, 5.0, 0.0), "the {} lies in an obstacle"),
        ((9.5, 5.0, 0.0), "the {} lies in an obstacle"),
        ((3.5, 5.0, 0.0), "the vehicle's outline touches an obstacle at the {}"),
        ((-0.1, 5.0, 0.0), "the {} lies outside the map"),
        ((5.0, 1e9, 0.0), "the {} lies outside the map"),
    ):
        for what, query in (("start", (at, free)), ("goal", (free, at))):
            plan = search.plan(*query)
            assert plan.path is None and plan.reason.startswith(why.format(what)) and plan.expanded == 0
    beside = search.plan(free, (3.5, 5.0, math.pi))
    assert beside.path is not None or "room" in beside.reason


@VEHICLES
def test_who_is_there_stays(vehicle):
    search, here = planner(np.zeros((60, 60)), vehicle), (3.0, 3.0, 0.7)
    plan = search.plan(here, here)
    assert plan.path.shape == (1, 3) and plan.cost == 0.0 and plan.direction.shape == (1,)
    assert plan.path[0] == pytest.approx(here)


@VEHICLES
@pytest.mark.parametrize("cells", [np.full((80, 80), -1), np.full((80, 80), 100), np.full((1, 1), -1)], ids=["unknown", "full", "a cell"])
def test_maps_with_nowhere_to_be(vehicle, cells):
    plan = planner(cells, vehicle).plan((0.05, 0.05, 0.0), (0.06, 0.06, 1.0))
    assert plan.path is None and plan.reason.startswith("the start lies in an obstacle")


@VEHICLES
@pytest.mark.parametrize("shape", [(1, 1), (1, 40), (3, 2), (40, 1)])
def test_tiny_maps(vehicle, shape):
    search = planner(np.zeros(shape), vehicle, RobotFootprint.circle(0.05))
    here, there = (0.05, 0.05, 0.0), ((shape[1] - 0.5) * SIDE, (shape[0] - 0.5) * SIDE, 0.0)
    plan = search.plan(here, there)
    assert (plan.path is None) == bool(plan.reason)
    if plan.path is not None:
        check(search._costs, vehicle, plan, (here, there), 0.0, exact=False)
    if shape == (1, 40):
        assert plan.cost == pytest.approx(3.9)


def test_unknown_ground_is_crossed_where_it_is_allowed():
    cells = np.zeros((60, 120))
    cells[:, 50:70] = -1
    costs, query = costmap(cells), ((2.0, 3.0, 0.0), (10.0, 3.0, 0.0))
    assert HybridAStar(costs, cost_factors(2.0), FORWARDS).plan(*query).path is None
    plan = HybridAStar(costs, cost_factors(2.0, 3.0), FORWARDS).plan(*query)
    assert plan.cost == pytest.approx(6.0 + 2.0 * 3.0, rel=0.1)


THIN = RobotFootprint.polygon(np.array(((1.9, 0.04), (1.9, -0.04), (-1.9, -0.04), (-1.9, 0.04))))
AXLE_BEHIND = RobotFootprint.polygon(np.array(((1.4, 0.3), (1.4, -0.3), (-0.1, -0.3), (-0.1, 0.3))))
AXLE_AHEAD = RobotFootprint.polygon(np.array(((0.1, 0.3), (0.1, -0.3), (-1.4, -0.3), (-1.4, 0.3))))
LOPSIDED = RobotFootprint.polygon(np.array(((0.3, 0.7), (0.4, -0.1), (-0.3, -0.1))))


@VEHICLES
@pytest.mark.parametrize("footprint", [THIN, AXLE_BEHIND, AXLE_AHEAD, LOPSIDED], ids=["thin", "axle behind", "axle ahead", "lopsided"])
def test_odd_outlines(vehicle, footprint):
    cells = np.zeros((140, 200))
    cells[:80, 70:78] = cells[70:, 130:138] = 100
    search, query = planner(cells, vehicle, footprint), ((2.2, 3.0, 1.5), (17.0, 11.0, 0.3))
    check(search._costs, vehicle, search.plan(*query), query)


@VEHICLES
def test_a_map_far_from_the_origin_and_a_turning_radius_below_a_cell(vehicle):
    small = SteeredVehicle(0.02, vehicle.reverses)
    costs = costmap(blocks(3), CAR, (-1000.0, 500.0))
    query = tuple((x - 1000.0, y + 500.0, yaw) for x, y, yaw in QUERY)
    check(costs, small, HybridAStar(costs, cost_factors(2.0), small).plan(*query), query, exact=False)


def test_costs_keep_paths_away_from_walls():
    cells = np.zeros((100, 200))
    cells[:50, 60:140] = 100
    query = (2.0, 5.35, 0.0), (18.0, 5.35, 0.0)
    room = [planner_with(cells, multiplier, query) for multiplier in (0.0, 8.0)]
    assert room[1] > room[0] + 0.05


def planner_with(cells, multiplier, query):
    costs = costmap(cells)
    path = HybridAStar(costs, cost_factors(multiplier), FORWARDS).plan(*query).path
    return min(costs.clearance_at(costs.cell(x, y)) for x, y, _ in path)


@pytest.mark.parametrize("at", [(math.nan, 1.0, 0.0), (1.0, math.inf, 0.0), (1.0, 1.0, math.nan)])
def test_what_is_no_pose_is_an_error(at):
    search = planner(np.zeros((30, 30)), BOTH)
    with pytest.raises(ValueError, match=r"start: .* is no configuration"):
        search.plan(at, (1.0, 1.0, 0.0))
    with pytest.raises(ValueError, match=r"goal: .* is no configuration"):
        search.plan((1.0, 1.0, 0.0), at)


def test_figures_that_make_no_sense_are_errors():
    with pytest.raises(ValueError, match="turning radius"):
        SteeredVehicle(0.0, True)
    with pytest.raises(ValueError, match=r"reverse_penalty: 0\.5"):
        SteeredVehicle(1.0, True, reverse_penalty=0.5)
    with pytest.raises(ValueError, match="256 finite numbers"):
        HybridAStar(costmap(np.zeros((9, 9))), np.full(256, np.nan), BOTH)
