"""Missions of planned paths: what the autopilot flies between the items is clear, and no steeper than allowed."""

import math

import numpy as np
import pytest

from tests.planning.flight.test_planner import bridge, fenced, overlapping, towers, wall
from uvf.guidance.clothoid_dubins import smooth_dubins_path
from uvf.maths.zones import Polygon, Region
from uvf.planning.flight import Airspace, DubinsAirplanePath, FlightLimits, FlownTurns, box, flight_items, rrt_star_flight
from uvf.planning.sampling import Budget

PLANNED = FlightLimits(radius=46.0, climb=0.15, sink=0.12, aside=12.0, above=6.0)
LIMITS = FlightLimits(radius=40.0, climb=0.15, sink=0.12, aside=8.0, above=6.0)
TURNS = FlownTurns(40.0, 25.0, 8.0)
WORLDS = {
    "towers": (towers, ((0.0, 0.0, 40.0, 0.0), (1000.0, 20.0, 60.0, 0.0))),
    "wall": (wall, ((0.0, 0.0, 60.0, 2.0), (800.0, 0.0, 60.0, -2.0))),
    "bridge": (bridge, ((0.0, 0.0, 100.0, 0.0), (1000.0, 0.0, 100.0, 0.0))),
    "fenced": (fenced, ((0.0, 0.0, 40.0, 0.0), (750.0, 800.0, 70.0, math.pi / 2))),
    "overlapping": (overlapping, ((0.0, 0.0, 40.0, 0.0), (1000.0, 0.0, 160.0, 0.0))),
}


def flown(start, items):
    """(n, 3) places between the items; along a circle all of it, at the height before and after, and left at its far side."""
    parts, here = [], start
    for item in items:
        if item.kind == "orbit":
            angles = np.arange(0.0, math.tau, 0.01)
            r = abs(item.radius)
            ring = np.column_stack((item.x + r * np.cos(angles), item.y + r * np.sin(angles)))
            low, high = sorted((here[2], item.z))
            parts += [np.column_stack((ring, np.full(len(ring), z))) for z in np.arange(low, high + 1.0, 1.0).clip(low, high)]
            side = -math.copysign(1.0, item.radius)
            course = here[3] + math.pi
            here = (item.x + side * r * math.sin(course), item.y - side * r * math.cos(course), item.z, course)
            continue
        path = smooth_dubins_path((here[0], here[1], here[3]), (item.x, item.y, item.course), TURNS.radius, TURNS.ramp)
        heights = here[2] + (item.z - here[2]) * path.s / path.length
        steep = math.tan(LIMITS.climb if item.z > here[2] else LIMITS.sink)
        assert abs(item.z - here[2]) <= steep * path.length * 1.001 + 0.05
        parts.append(np.column_stack((path.points, heights)))
        here = (item.x, item.y, item.z, item.course)
    return np.concatenate(parts), here


def check(airspace, start, goal, items):
    places, end = flown(start, items)
    slack = 0.1  # of rounded figures
    assert (airspace.fence.clearance(places[:, :2]) >= LIMITS.aside - slack).all()
    assert places[:, 2].min() >= airspace.floor + LIMITS.above - slack and places[:, 2].max() <= airspace.ceiling - LIMITS.above + slack
    for prism in airspace.obstacles:
        beside = -prism.area.inside(places[:, :2]) >= LIMITS.aside - slack
        over = (places[:, 2] <= prism.floor - LIMITS.above + slack) | (places[:, 2] >= prism.ceiling + LIMITS.above - slack)
        assert (beside | over).all()
    assert end[:3] == pytest.approx(goal[:3], abs=0.01)
    assert math.remainder(end[3] - goal[3], math.tau) == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("world", WORLDS)
def test_what_is_flown_between_the_items_is_clear(world):
    make, query = WORLDS[world]
    missions = 0
    for seed in range(3):
        path = rrt_star_flight(make(), PLANNED, query, Budget(3000), seed).path
        items = flight_items(path, make(), LIMITS, TURNS) if path else None
        if items is not None:
            missions += 1
            check(make(), *query, items)
            assert len(items) < len(path.waypoints) + 3
    assert missions >= 2


def path_of(*nodes):
    return DubinsAirplanePath(np.zeros((0, 7)), np.array(nodes))


@pytest.mark.parametrize(("height", "order"), [(300.0, ["orbit", "waypoint"]), (20.0, ["waypoint", "orbit", "waypoint"])])
def test_a_climb_that_is_too_steep_is_circled_before_it_and_a_descent_behind(height, order):
    start, goal = (0.0, 0.0, 150.0, 0.0), (400.0, 0.0, height, 0.0)
    items = flight_items(path_of(start, goal), Airspace(), LIMITS, TURNS)
    assert [item.kind for item in items] == order
    circle = items[order.index("orbit")]
    assert circle.to_altitude and circle.z == height and abs(circle.radius) >= LIMITS.radius
    check(Airspace(), start, goal, items)


def test_where_there_is_no_room_to_circle_before_the_climb_it_circles_behind():
    airspace = Airspace((box((-200, -150), (100, 150), 200.0, 400.0),))
    start, goal = (0.0, 0.0, 150.0, 0.0), (600.0, 0.0, 350.0, 0.0)
    items = flight_items(path_of(start, goal), airspace, LIMITS, TURNS)
    assert [item.kind for item in items] == ["waypoint", "orbit", "waypoint"]
    check(airspace, start, goal, items)


def test_heights_do_not_wander():
    nodes = [(0.0, 0.0, 50.0, 0.0), (300.0, 0.0, 90.0, 0.0), (600.0, 0.0, 45.0, 0.0), (900.0, 0.0, 80.0, 0.0)]
    items = flight_items(path_of(*nodes), Airspace((box((290, -9), (310, 9), 0, 30),)), LIMITS, TURNS)
    assert [(item.x, item.z) for item in items] == [(900.0, 80.0)]


def test_a_way_that_is_not_clear_makes_no_mission():
    shut = Airspace((box((300, -900), (330, 900), 0.0, 900.0),))
    assert flight_items(path_of((0.0, 0.0, 50.0, 0.0), (600.0, 0.0, 50.0, 0.0)), shut, LIMITS, TURNS) is None


def test_a_straight_line_between_items_does_not_cut_the_fence():
    """As the autopilot tests a mission: the curve may be clear where the line is not."""
    corner = Polygon([(-100, -100), (600, -100), (600, 600), (420, 600), (420, 80), (-100, 80)])
    start, goal = (0.0, 0.0, 50.0, 0.0), (520.0, 500.0, 50.0, math.pi / 2)
    airspace = Airspace(fence=Region((corner,)))
    assert flight_items(path_of(start, goal), airspace, LIMITS, TURNS) is None
    items = flight_items(path_of(start, (450.0, 0.0, 50.0, 0.3), goal), airspace, LIMITS, TURNS)
    assert items is not None and len(items) == 2
    check(airspace, start, goal, items)
