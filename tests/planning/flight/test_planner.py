"""Ways for aircraft in worlds of several kinds, looked at by a check that knows only areas and heights."""

import math

import numpy as np
import pytest

from uvf.maths.zones import Disc, Overlap, Polygon, Region
from uvf.planning.flight import Airspace, FlightLimits, Prism, box, cylinder, rrt_flight, rrt_star_flight
from uvf.planning.sampling import Budget

LIMITS = FlightLimits(radius=40.0, climb=0.15, sink=0.12, aside=8.0, above=6.0)
PLANNERS = [rrt_flight, rrt_star_flight]
BUDGET = Budget(4000)


def towers():
    rng = np.random.default_rng(0)
    places = [(x, y + rng.uniform(-20, 20)) for x in range(100, 900, 130) for y in range(-300, 300, 130)]
    return Airspace(tuple(box((x, y), (x + 60, y + 60), 0.0, rng.uniform(60, 200)) for x, y in places), floor=10.0, ceiling=150.0)


def wall():
    """With a gap of 60 m, and too high to be flown over."""
    return Airspace((box((400, -2000), (430, 170), 0, 500), box((400, 230), (430, 2000), 0, 500)), floor=10.0, ceiling=120.0)


def bridge():
    """A slab to pass below; over it is no room."""
    return Airspace((box((300, -2000), (600, 2000), 60.0, 300.0),), floor=10.0, ceiling=120.0)


def fenced():
    """An L-shaped fence with two zones to keep out of, one round and one that is no rectangle."""
    area = Polygon([(-100, -100), (900, -100), (900, 900), (500, 900), (500, 300), (-100, 300)])
    slanted = Polygon([(600, 100), (760, 180), (700, 420), (560, 300)])
    return Airspace((), Region((area,), (Disc((300, 60), 90), slanted)), floor=20.0, ceiling=100.0)


def overlapping():
    """Two fences that add up, the second an overlap of two areas, and a cylinder where they meet."""
    east = Overlap((Disc((800, 0), 500), Polygon([(300, -250), (1300, -250), (1300, 250), (300, 250)])))
    return Airspace((cylinder((420, 30), 50, 0, 300),), Region((Disc((100, 0), 450), east)), floor=0.0, ceiling=250.0)


WORLDS = {
    "towers": (towers, ((0.0, 0.0, 40.0, 0.0), (1000.0, 20.0, 60.0, 0.0))),
    "wall": (wall, ((0.0, 0.0, 60.0, 2.0), (800.0, 0.0, 60.0, -2.0))),
    "bridge": (bridge, ((0.0, 0.0, 100.0, 0.0), (1000.0, 0.0, 100.0, 0.0))),
    "fenced": (fenced, ((0.0, 0.0, 40.0, 0.0), (750.0, 800.0, 80.0, math.pi / 2))),
    "overlapping": (overlapping, ((0.0, 0.0, 40.0, 0.0), (1000.0, 0.0, 160.0, 0.0))),
}


def check(airspace, path, start, goal):
    found = path.sampled(0.5)
    points, heights = found[:, :2], found[:, 2]
    assert (airspace.fence.clearance(points) >= LIMITS.aside).all()
    assert heights.min() >= airspace.floor + LIMITS.above and heights.max() <= airspace.ceiling - LIMITS.above
    for prism in airspace.obstacles:
        beside = -prism.area.inside(points) >= LIMITS.aside
        assert (beside | (heights <= prism.floor - LIMITS.above) | (heights >= prism.ceiling + LIMITS.above)).all()
    assert found[0] == pytest.approx(start, abs=1e-9)
    assert found[-1, :3] == pytest.approx(goal[:3], abs=1e-6)
    assert math.remainder(found[-1, 3] - goal[3], math.tau) == pytest.approx(0.0, abs=1e-6)
    steps = np.hypot(*np.diff(points, axis=0).T)
    assert steps.max() <= 0.5 + 1e-9 and steps.sum() == pytest.approx(path.length, rel=1e-3)
    rises = np.diff(heights)
    assert (rises <= math.tan(LIMITS.climb) * steps * 1.001 + 1e-6).all()
    assert (rises >= -math.tan(LIMITS.sink) * steps * 1.001 - 1e-6).all()
    turns = np.abs(np.remainder(np.diff(found[:, 3]) + math.pi, math.tau) - math.pi)
    assert (turns <= steps / LIMITS.radius * 1.001 + 1e-6).all()
    assert path.waypoints[0] == pytest.approx(start) and path.waypoints[-1, :3] == pytest.approx(goal[:3])


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize("world", WORLDS)
def test_every_way_stays_clear_and_can_be_flown(planner, world):
    make, query = WORLDS[world]
    for seed in range(4):
        plan = planner(make(), LIMITS, query, BUDGET, seed)
        assert plan.path is not None, plan.reason
        check(make(), plan.path, *query)


def test_below_the_bridge_and_not_over_it():
    plan = rrt_star_flight(bridge(), LIMITS, WORLDS["bridge"][1], BUDGET, 0)
    found = plan.path.sampled(5.0)
    inside = (found[:, 0] > 292) & (found[:, 0] < 608)
    assert inside.any() and found[inside, 2].max() <= 54.0


def test_rrt_star_is_shorter_and_never_worse_with_more():
    make, query = WORLDS["towers"]
    first = rrt_flight(make(), LIMITS, query, BUDGET, 1).cost
    costs = [rrt_star_flight(make(), LIMITS, query, Budget(n), 1).cost for n in (1000, 4000, 16_000)]
    assert first > costs[-1] and costs == sorted(costs, reverse=True)
    assert costs[-1] < 1.2 * math.dist(query[0][:2], query[1][:2])


@pytest.mark.parametrize("rise", [60.0, 400.0, -60.0, -400.0])
def test_what_is_too_high_or_low_takes_circles(rise):
    start, goal = (0.0, 0.0, 500.0, 0.0), (200.0, 0.0, 500.0 + rise, 0.0)
    plan = rrt_star_flight(Airspace(), LIMITS, (start, goal), Budget(300), 0)
    check(Airspace(), plan.path, start, goal)
    steep = math.tan(LIMITS.climb if rise > 0 else LIMITS.sink)
    assert abs(rise) / steep <= plan.cost + 1e-9 <= abs(rise) / steep + 2.1 * math.pi * LIMITS.radius


def test_in_free_air_the_way_is_the_dubins_path():
    plan = rrt_flight(Airspace(), LIMITS, ((0.0, 0.0, 50.0, 0.0), (500.0, 0.0, 60.0, 0.0)), Budget(10), 0)
    assert plan.cost == pytest.approx(500.0) and len(plan.path.waypoints) == 2


@pytest.mark.parametrize("planner", PLANNERS)
def test_the_same_seed_the_same_way(planner):
    make, query = WORLDS["fenced"]
    one, same = (planner(make(), LIMITS, query, Budget(1500), 3) for _ in range(2))
    assert np.array_equal(one.path.pieces, same.path.pieces)


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize(
    ("airspace", "start", "why"),
    [
        (Airspace((cylinder((0.0, 0.0), 50.0, 0.0, 100.0),)), (10.0, 0.0, 50.0, 0.0), "the start lies within obstacle or excluded zone 0"),
        (Airspace((cylinder((0.0, 0.0), 50.0, 0.0, 100.0),)), (0.0, 0.0, 103.0, 0.0), "the start is too near to obstacle"),
        (Airspace((), Region((), (Disc((0.0, 0.0), 30.0),))), (0.0, 0.0, 50.0, 0.0), "the start lies within obstacle or excluded zone 0"),
        (Airspace((), Region((Disc((800.0, 0.0), 300.0),))), (0.0, 0.0, 50.0, 0.0), "the start lies outside of the fence"),
        (Airspace(floor=100.0, ceiling=200.0), (0.0, 0.0, 50.0, 0.0), "the start is at 50 m; with the margin, heights from 106 to 194 m"),
    ],
)
def test_where_it_may_not_be_it_says_why(planner, airspace, start, why):
    plan = planner(airspace, LIMITS, (start, (800.0, 0.0, 150.0, 0.0)), Budget(100), 0)
    assert plan.path is None and plan.reason.startswith(why)


@pytest.mark.parametrize("planner", PLANNERS)
def test_no_way_is_said_and_not_made_up(planner):
    area = Polygon([(-300, -600), (1100, -600), (1100, 600), (-300, 600)])
    shut = Airspace((box((400, -700), (430, 700), -100, 500),), Region((area,)), floor=10.0, ceiling=120.0)
    plan = planner(shut, LIMITS, WORLDS["wall"][1], Budget(1000), 0)
    assert plan.path is None and "no way was found" in plan.reason and plan.iterations == 1000
    islands = Airspace((), Region((Disc((0.0, 0.0), 200.0), Disc((800.0, 0.0), 200.0))))
    assert planner(islands, LIMITS, WORLDS["wall"][1], Budget(1000), 0).path is None


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda: Airspace(floor=10.0, ceiling=5.0), "airspace: its floor, 10 m, is not below its ceiling, 5 m"),
        (lambda: Airspace((Prism(Disc((0, 0), 5), 10.0, 10.0),)), "obstacle: its floor"),
        (lambda: FlightLimits(0.0, 0.1, 0.1, 1.0, 1.0), "turning radius of 0 m"),
        (lambda: FlightLimits(10.0, 0.0, 0.1, 1.0, 1.0), "angles of 0 rad to climb"),
        (lambda: FlightLimits(10.0, 0.1, 0.1, -1.0, 1.0), "margins of -1 m aside"),
        (lambda: rrt_flight(Airspace(), LIMITS, ((0, 0, math.nan, 0), (1, 1, 1, 1)), Budget(1), 0), "start: .* four finite numbers"),
        (lambda: rrt_flight(Airspace(), LIMITS, ((0, 0, 0, 0), (1, 1, 1, 1)), Budget(-1), 0), "a budget of -1 iterations"),
    ],
)
def test_what_makes_no_sense_is_refused(call, why):
    with pytest.raises(ValueError, match=why):
        call()
