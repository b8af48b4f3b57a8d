"""A map that another vehicle has made leads beyond the own one, and a broken one does no harm."""

import msgspec
import numpy as np
import pytest

from schemas.messages import Grid
from tests.services.planner.planner_bench import START, Bench, asked, planner
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.runtime.messages.convert import occupancy_cells, occupancy_grid, planar_frame, planar_pose
from uvf.runtime.messages.maps.height_grids import heights_message, heights_of

SIDE = 0.25
BEYOND = (7.0, 1.0)
"""m, map: the own map ends at 4 m."""


def corridor(wall=None):
    """World heights of a level strip, from 2 m before the map to 10 m behind it.

    wall: how high [m] it is that stands at 5 m (map x), from 0.5 m (map y) on.
    """
    ground = np.zeros((round(12.0 / SIDE), round(3.0 / SIDE)), dtype=np.float32)
    top = ground.copy()
    if wall is not None:
        top[round(7.0 / SIDE), : round(2.5 / SIDE)] = wall
    return heights_message(top, ground, SIDE, (START[0] - 3.0, START[1] - 2.0), 0.0)


def open_room():
    """The own map: free as far as 3 m, nothing known from there on."""
    cells = np.zeros((60, 80), dtype=np.int8)
    cells[:, 60:] = -1
    return occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)


def bench():
    made = Bench()
    made.grid = open_room()
    return made


def test_without_it_a_goal_beyond_the_own_map_is_refused_and_with_it_driven_to():
    assert not bench().step(goal=[asked(*BEYOND)]).said["goal"][0].accepted
    led = bench().step(shared=corridor()).step(goal=[asked(*BEYOND)], shared=corridor())
    assert led.said["goal"][0].accepted
    led.step(2, shared=corridor())
    assert led.path[-1] == pytest.approx(BEYOND, abs=0.1) and abs(led.path[:, 1] - 1.0).max() < 0.2


@pytest.mark.parametrize("wall", [0.6, 2.0])
def test_what_stands_on_the_shared_ground_is_driven_round(wall):
    shared = corridor(wall)
    led = bench().step(2, shared=shared).step(goal=[asked(*BEYOND)], shared=shared).step(2, shared=shared)
    across = led.path[np.abs(led.path[:, 0] - 5.0) < 0.1]
    assert len(across) and (across[:, 1] < 0.4).all()


def test_a_low_step_is_driven_over():
    shared = corridor(0.1)
    led = bench().step(2, shared=shared).step(goal=[asked(*BEYOND)], shared=shared).step(2, shared=shared)
    assert abs(led.path[:, 1] - 1.0).max() < 0.2


def test_who_stands_under_a_crown_gets_out_the_way_that_it_came_and_others_do_not_drive_there():
    """A roof of 1.4 m about (2, 1), which the lidar does not see; from outside the vehicle has driven to its middle."""
    shared = corridor()
    top, ground = (part.copy() for part in heights_of(shared))
    rows, columns = np.indices(top.shape)
    x, y = rows * SIDE - 2.0, START[0] - (START[0] - 3.0 + (columns + 0.5) * SIDE)
    top[np.hypot(x + SIDE / 2 - 2.0, y - 1.0) < 0.8] = 4.0
    roofed = heights_message(top, ground, SIDE, (START[0] - 3.0, START[1] - 2.0), 0.0)
    come = bench()
    for along in np.linspace(0.5, 2.0, 16):
        come.here = (float(along), 1.0)
        come.step()
    come.step(2, shared=roofed).step(goal=[asked(0.5, 1.0)], shared=roofed)
    assert come.said["goal"][0].accepted, come.said["goal"][0].reason
    come.step(2, shared=roofed)
    assert come.path[-1] == pytest.approx((0.5, 1.0), abs=0.1) and abs(come.path[:, 1] - 1.0).max() < 0.15
    other = bench()
    other.here = (0.5, 1.0)
    other.step(2, shared=roofed).step(goal=[asked(3.5, 1.0)], shared=roofed).step(2, shared=roofed)
    assert not len(other.path) or np.hypot(*(other.path - (2.0, 1.0)).T).min() > 0.8


@pytest.mark.parametrize("outline", ["round", "long"])
def test_a_ditch_is_not_crossed_however_often_the_vehicle_has_stood_before_it(outline):
    """0.5 m wide and 1 m deep, at 2.5 m (map x); the own map is free, for a lidar looks over it."""
    shared = corridor()
    top, ground = (part.copy() for part in heights_of(shared))
    at = round((2.5 + 2.0) / SIDE)
    top[at : at + 2] = ground[at : at + 2] = -1.0
    ditch = heights_message(top, ground, SIDE, (START[0] - 3.0, START[1] - 2.0), 0.0)
    made = bench()
    if outline == "long":
        made.service = planner(footprint=RobotFootprint.polygon(np.array(((0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)))))
    for _ in range(3):
        for along in np.linspace(0.6, 2.1, 8):
            made.here = (float(along), 1.0)
            made.step(shared=ditch)
    assert not made.step(goal=[asked(3.5, 1.0)], shared=ditch).said["goal"][0].accepted


def test_a_grid_of_another_ground_vehicle_serves_as_well():
    cells = np.zeros((240, 60), dtype=np.int8)
    shared = occupancy_grid(cells, 0.05, START[0] - 3.0, START[1] - 2.0, "world", 0.0)
    assert bench().step(shared=shared).step(goal=[asked(*BEYOND)], shared=shared).said["goal"][0].accepted


@pytest.mark.parametrize("broken", ["rows", "squares", "nothing", "far away"])
def test_a_broken_map_is_left_out_and_told_once(broken):
    shared = corridor()
    if broken == "rows":
        shared.data = shared.data[:-3]
    elif broken == "squares":
        shared.cell_size.y = 0.5
    elif broken == "nothing":
        shared = Grid()
    else:
        shared.pose.CopyFrom(planar_pose(9e5, -9e5, 0.0))
    made = bench().step(3, shared=shared)
    assert made.events.count("the map of another vehicle is left out") == 1
    assert made.step(goal=[asked(2.0, 1.0)], shared=shared).said["goal"][0].accepted


def test_other_limits_are_heeded_at_once():
    shared = corridor(0.2)
    made = bench().step(2, shared=shared).step(goal=[asked(*BEYOND)], shared=shared).step(2, shared=shared)
    assert abs(made.path[:, 1] - 1.0).max() < 0.2
    made.service.params = msgspec.structs.replace(made.service.params, max_step=0.1)
    made.step(6, shared=shared)
    across = made.path[np.abs(made.path[:, 0] - 5.0) < 0.1]
    assert len(across) and (across[:, 1] < 0.4).all()


TEAM_FROM_MAP = Pose2(-1.0, 4.0, np.pi / 2)


def of_team(shape=(240, 60), place=TEAM_FROM_MAP, first="mate"):
    """A merged map, all of it free, as wide as the vehicle's own one, that reaches from 2 m before that to 10 m ahead."""
    grid = occupancy_grid(np.zeros(shape, dtype=np.int8), 0.05, -4.0, 2.0, f"{first}/map", 0.0)
    return {"team_map": {first: grid}, "team_place": planar_frame(0.0, f"{first}/map", "v/map", place)}


def test_the_merged_map_of_its_team_leads_where_others_have_been():
    led = bench().step(**of_team()).step(goal=[asked(*BEYOND)], **of_team())
    assert led.said["goal"][0].accepted, led.said["goal"][0].reason
    led.step(2, **of_team())
    assert led.path[-1] == pytest.approx(BEYOND, abs=0.1) and abs(led.path[:, 1] - 1.0).max() < 0.2


def test_what_others_have_mapped_is_no_frontier():
    walls = np.full((240, 60), 100, dtype=np.int8)
    walls[1:-1, 1:-1] = 0
    shared = of_team()
    shared["team_map"]["mate"].data = walls.tobytes()
    found = {}
    for name, heard in {"alone": {}, "of a team": shared}.items():
        made = Bench(explores=True)
        cells = occupancy_cells(open_room()).copy()
        cells[(0, -1), :60] = 100
        made.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)
        found[name] = made.step(20, **heard).said["nav_status"].explored
    assert found["alone"] < 0.9
    assert found["of a team"] > 0.98


def test_who_is_alone_again_knows_what_it_knows_itself():
    made = bench().step(**of_team()).step(**of_team((1, 1), Pose2(0.0, 0.0, 0.0), "v"))
    assert not made.step(goal=[asked(*BEYOND)], **of_team((1, 1), Pose2(0.0, 0.0, 0.0), "v")).said["goal"][0].accepted
    made = bench().step(**of_team()).step()
    assert not made.step(goal=[asked(*BEYOND)]).said["goal"][0].accepted


@pytest.mark.parametrize("fault", ["nowhere", "of another one", "without a map", "broken"])
def test_a_team_that_cannot_be_led_to_is_none(fault):
    told = of_team(place=Pose2(np.nan, 0.0, 0.0) if fault == "nowhere" else TEAM_FROM_MAP)
    if fault == "of another one":
        told["team_place"].child_frame_id = "w/map"
    elif fault == "without a map":
        told["team_map"] = {}
    elif fault == "broken":
        told["team_map"]["mate"].row_stride = 7
    made = bench().step(**told)
    events = [event.text for event in made.said.get("events", [])]
    assert ("the map of another vehicle is left out" in events) == (fault == "broken")
    assert not made.step(goal=[asked(*BEYOND)], **told).said["goal"][0].accepted


def test_a_map_that_was_handed_over_comes_first():
    wall = corridor(2.0)
    led = bench().step(2, shared=wall, **of_team()).step(goal=[asked(*BEYOND)], shared=wall, **of_team()).step(2, shared=wall, **of_team())
    across = led.path[np.abs(led.path[:, 0] - 5.0) < 0.1]
    assert len(across) and (across[:, 1] < 0.4).all()
