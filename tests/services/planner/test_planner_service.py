"""The planner step by step: goals, what it does without inputs, what it does when blocked."""

from math import ceil

import numpy as np
import pytest

from schemas.messages import (
    Fence,
    FenceZone,
    GoalRequest,
    Mission,
    MissionItem,
    MissionProgress,
    Mode,
    NavStatus,
    Vector3,
    VehicleStatus,
)
from services.planner.exploration_goals import SETTLING
from services.planner.params import PlannerParams
from services.planner.planner_service import PlannerService
from tests.runtime.stepping import recall, stale
from tests.services.live_params import all_settable_are_read
from tests.services.planner.planner_bench import CANCEL, START, Bench, asked, planner, preview, world
from tests.services.planner.plans import room
from uvf.planning import global_planner
from uvf.planning.search.grid_search import GridSearch
from uvf.runtime.messages.convert import cost_cells, occupancy_grid

SETTLED = 4 + ceil(SETTLING * PlannerService.hz)  # steps after which who explores no longer stands for its gyroscope


@pytest.mark.parametrize("explores", [False, True])
def test_on_a_map_too_large_to_plan_on_the_vehicle_stands_and_says_why(explores):
    bench = Bench(explores).step(SETTLED)
    bench.grid = occupancy_grid(np.zeros((4001, 4000), dtype=np.int8), 0.05, 0.0, 0.0, "v/map", 1.0)
    bench.step(goal=[asked(2.0, 2.0)])
    reply = bench.said["goal"][0]
    assert not reply.accepted and reply.reason.startswith("the map is too large to plan on")
    assert not bench.said["path"].poses
    assert explores == bench.said["nav_status"].reason.startswith("the map is too large to plan on")


def test_a_goal_beyond_the_fence_is_refused():
    x, y = world(3.0, 2.0)
    fence = Fence(zones=[FenceZone(centre=Vector3(x=x, y=y), radius=0.5)])
    for goal, why in ((asked(2.0, 2.0), "0.5 m outside of the fence"), (asked(3.0, 1.55), "0.05 m from the fence")):
        bench = Bench().step(bounds=fence, goal=[goal])
        assert why in bench.said["goal"][0].reason
    assert Bench().step(bounds=fence, goal=[asked(3.0, 2.0)]).said["goal"][0].accepted
    beyond, inside = Bench().step(bounds=fence, preview=[preview(3.0, 2.0, start) for start in ((2.0, 2.0), (3.2, 2.0))]).said["preview"]
    assert "the start is 0.5 m outside of the fence" in beyond.reason
    assert inside.accepted


def test_a_goal_gets_a_path_in_the_world_frame():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step()
    path = bench.said["path"]
    assert path.frame_id == "world"
    assert (path.poses[0].position.x, path.poses[0].position.y) == pytest.approx(world(1.0, 1.0))
    assert (path.poses[-1].position.x, path.poses[-1].position.y) == pytest.approx(world(3.0, 2.0))
    assert bench.state == NavStatus.DRIVING
    assert bench.said["nav_status"].distance_left == pytest.approx(np.hypot(2.0, 1.0), rel=0.1)


def test_a_goal_in_a_wall_is_refused():
    reply = Bench().step(goal=[asked(0.07, 1.0)]).said["goal"][0]
    assert (reply.accepted, reply.reason) == (False, "the goal lies in an obstacle")


@pytest.mark.parametrize("x", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("position", [lambda x: Vector3(x=x, y=21.0), lambda x: Vector3(x=8.0, y=x)])
def test_a_goal_that_is_no_place_is_refused(x, position):
    bench = Bench().step(goal=[GoalRequest(position=position(x), yaw=np.nan)])
    assert (bench.said["goal"][0].accepted, "coordinates must be finite" in bench.said["goal"][0].reason) == (False, True)
    assert bench.step().said["nav_status"].job == "idle"


def test_a_goal_at_the_end_of_the_numbers_lies_outside_the_map():
    reply = Bench().step(goal=[GoalRequest(position=Vector3(x=1e308, y=-1e308), yaw=np.nan)]).said["goal"][0]
    assert (reply.accepted, reply.reason) == (False, "the goal lies outside the map")


def test_an_infinite_heading_is_refused():
    bench = Bench().step(goal=[asked(2.0, 2.0, yaw=np.inf)])
    assert "the heading is infinite" in bench.said["goal"][0].reason
    assert bench.step().said["nav_status"].job == "idle"


def test_a_mission_item_that_is_no_place_is_never_reached():
    mission = Mission(id=9, items=[MissionItem(position=Vector3(x=np.nan, y=1.0))])
    bench = Bench().step(4, mission=mission, progress=MissionProgress(state=MissionProgress.ACTIVE, mission_id=9))
    assert bench.state == NavStatus.BLOCKED
    assert "not a place" in bench.said["nav_status"].reason


def test_a_goal_while_holding_is_refused_with_the_mend():
    reply = Bench().step(goal=[asked(3.0, 2.0)], status=VehicleStatus(mode=Mode.MODE_HOLD, armed=True)).said["goal"][0]
    assert reply.reason == "the mode is HOLD: change it to MISSION first"


def test_a_goal_interrupts_exploring_and_exploring_goes_on_after_a_while():
    bench = Bench(explores=True)
    cells = room(4.0, 3.0)
    cells[20:40, -2:] = 0
    cells[20:40, -1] = -1
    bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)
    assert bench.step(2).said["nav_status"].job == "explore"
    bench.step(goal=[asked(2.0, 2.0)])
    assert bench.step().said["nav_status"].job == "goal"
    bench.here = (2.0, 2.0)
    bench.step()
    assert bench.state == NavStatus.REACHED
    bench.step(int(4 * PlannerParams().wait_at_goal) - 2)
    assert bench.said["nav_status"].job == "goal"
    assert len(bench.said["path"].poses) == 0
    bench.step(4)
    assert (bench.said["nav_status"].job, bench.state) == ("explore", NavStatus.DRIVING)


def test_a_cancelled_goal_leaves_no_path_and_says_so_until_the_job_goes_on():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step(4)
    bench.step(cancel=[CANCEL])
    assert bench.said["cancel"][0].accepted
    assert len(bench.said["path"].poses) == 0
    assert (bench.state, bench.said["nav_status"].reason) == (NavStatus.CANCELLED, "goal cancelled, asked by test")
    bench.step(int(4 * PlannerParams().wait_at_goal) - 1)
    assert (bench.state, len(bench.said["path"].poses)) == (NavStatus.CANCELLED, 0)
    assert bench.step(2).said["nav_status"].job == "idle"
    assert bench.events.count("goal cancelled") == 1


def test_a_goal_that_is_cancelled_in_the_step_it_is_asked_for_is_never_begun():
    bench = Bench().step(goal=[asked(3.0, 2.0)], cancel=[CANCEL])
    assert (bench.state, len(bench.said["path"].poses)) == (NavStatus.CANCELLED, 0)


def test_the_same_place_can_be_asked_for_again_at_once():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step(cancel=[CANCEL]).step(goal=[asked(3.0, 2.0)])
    assert bench.state == NavStatus.DRIVING


@pytest.mark.parametrize("before", ["nothing", "cancelled", "reached", "exploring"])
def test_without_a_goal_there_is_nothing_to_cancel(before):
    bench = Bench(explores=before == "exploring").step()
    if before == "cancelled":
        bench.step(goal=[asked(3.0, 2.0)]).step(cancel=[CANCEL])
    elif before == "reached":
        bench.step(goal=[asked(1.0, 1.0)]).step()
    reply = bench.step(cancel=[CANCEL]).said["cancel"][0]
    assert (reply.accepted, reply.reason) == (False, "there is no goal to cancel")


def test_a_goal_that_waits_behind_the_way_home_can_be_cancelled_too():
    home = VehicleStatus(mode=Mode.MODE_RETURN, armed=True)
    bench = Bench()
    bench.grid = occupancy_grid(room(4.0, 3.0), 0.05, -1.0, -1.0, "v/map", 0.0)
    bench.step(goal=[asked(2.0, 1.0)]).step(status=home)
    assert bench.step(status=home, cancel=[CANCEL]).said["nav_status"].job == "return"
    assert bench.step(2).said["nav_status"].job == "idle"


def test_a_flood_of_goals_costs_one_search_and_the_last_good_one_counts():
    bench = Bench().step()
    flood = [asked(0.5 + 0.01 * i, 1.5) for i in range(255)] + [asked(0.07, 1.0)]
    searches = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(global_planner, "GridSearch", lambda values, factors: searches.append(values) or GridSearch(values, factors))
        bench.step(goal=flood)
    replies = bench.said["goal"]
    assert [r.accepted for r in replies] == [True] * 255 + [False]
    assert len(searches) <= 2  # one for all refusals, one for the path
    assert bench.events == ["goal (8.5, 23.0)", "job: goal"]
    assert bench.said["path"].poses[-1].position.x == pytest.approx(world(3.04, 1.5)[0])


def test_a_wanted_heading_is_part_of_the_goal():
    bench = Bench().step(goal=[asked(2.0, 2.0, yaw=0.0)]).step()
    assert bench.said["path"].poses[-1].HasField("orientation")
    bench.here = (2.0, 2.0)
    assert bench.step(2).state == NavStatus.DRIVING


def test_standing_while_a_person_drives_is_not_getting_nowhere():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    bench.step(100, status=VehicleStatus(mode=Mode.MODE_MANUAL, armed=True, command_source="gcs"))
    assert "goal: goal given up" not in bench.events


def test_the_mission_is_driven_to_its_current_item():
    x, y = world(3.0, 2.0)
    mission = Mission(id=9, items=[MissionItem(position=Vector3(x=x, y=y))])
    progress = MissionProgress(state=MissionProgress.ACTIVE, mission_id=9)
    bench = Bench().step(2, mission=mission, progress=progress)
    assert bench.said["nav_status"].job == "mission"
    assert bench.said["path"].poses[-1].position.x == pytest.approx(x)


def test_a_mission_item_that_cannot_be_reached_ends_in_hold_and_is_tried_again_by_and_by():
    x, y = world(0.0, 1.0)  # in the wall
    mission = Mission(id=9, items=[MissionItem(position=Vector3(x=x, y=y))])
    progress = MissionProgress(state=MissionProgress.ACTIVE, mission_id=9)
    bench = Bench().step(4, mission=mission, progress=progress)
    assert bench.asked == []
    bench.step(4 * 35, mission=mission, progress=progress)
    assert [(r.mode, r.source) for r in bench.asked] == [(Mode.MODE_HOLD, "planner")]
    assert bench.events[-1] == "mission: holding"
    assert bench.state == NavStatus.BLOCKED
    bench.step(4 * 45, mission=mission, progress=progress)
    assert len(bench.asked) == 2


def test_a_vehicle_that_is_pushed_away_from_its_mission_item_drives_back():
    x, y = world(1.0, 1.0)
    mission = Mission(id=9, items=[MissionItem(position=Vector3(x=x, y=y))])
    progress = MissionProgress(state=MissionProgress.ACTIVE, mission_id=9)
    bench = Bench().step(4, mission=mission, progress=progress)
    assert bench.state == NavStatus.REACHED
    bench.here = (2.0, 1.0)
    assert bench.step(2, mission=mission, progress=progress).state == NavStatus.DRIVING


def test_return_leads_to_the_start():
    bench = Bench()
    bench.grid = occupancy_grid(room(4.0, 3.0), 0.05, -1.0, -1.0, "v/map", 0.0)
    bench.step(status=VehicleStatus(mode=Mode.MODE_RETURN, armed=True)).step(status=VehicleStatus(mode=Mode.MODE_RETURN, armed=True))
    end = bench.said["path"].poses[-1].position
    assert (end.x, end.y) == pytest.approx(START[:2])


def test_an_obstacle_that_appears_in_the_map_is_gone_round():
    bench = Bench().step(goal=[asked(3.0, 1.0)]).step()
    before = len(bench.said["path"].poses)
    cells = room(4.0, 3.0)
    cells[4:30, 38:42] = 100
    bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 1.0)
    bench.step()
    assert len(bench.said["path"].poses) > before + 5


def test_started_again_it_still_drives_to_the_persons_goal():
    old = Bench().step(goal=[asked(3.0, 2.0)]).step()
    new = Bench()
    recall(new.service, nav_status=old.said["nav_status"])
    end = new.step().said["path"].poses[-1].position
    assert (end.x, end.y) == pytest.approx(world(3.0, 2.0))


def test_started_again_a_cancelled_goal_stays_cancelled():
    old = Bench().step(goal=[asked(3.0, 2.0)]).step().step(cancel=[CANCEL])
    new = Bench()
    recall(new.service, nav_status=old.said["nav_status"])
    assert new.step().said["nav_status"].job == "idle"


def test_without_pose_or_map_there_is_no_path():
    outputs = stale(Bench().service, 1.0, ("pose", "map"))
    assert len(outputs["path"].poses) == 0
    assert outputs["nav_status"].reason == "waiting for pose, map"


def test_every_parameter_of_the_planner_is_read_while_running():
    bench = Bench(explores=True)
    with all_settable_are_read(bench.service):
        bench.step(2).step(2, goal=[asked(3.0, 2.0)]).step(4)
        bench.here = (3.0, 2.0)
        bench.step(40)


@pytest.mark.parametrize("change", [{"inflation_radius": 1.5, "cost_scaling_factor": 3.0, "cost_travel_multiplier": 30.0}, {"margin": 0.6}])
def test_the_path_keeps_farther_from_walls_when_that_is_set_while_driving(change):
    bench = Bench()
    cells = room(4.0, 3.0)
    cells[4:20, 38:42] = 100
    bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)
    bench.step(goal=[asked(3.0, 1.0)]).step()
    block = np.array(world(2.0, 1.0))  # the middle of its upper side

    def nearest():
        return min(np.hypot(*(np.array((pose.position.x, pose.position.y)) - block)) for pose in bench.said["path"].poses)

    before = nearest()
    bench.service.params = PlannerParams(**change)
    bench.step()
    assert nearest() > before + 0.08


def test_a_comfort_below_the_radius_does_not_spoil_the_costs():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step()
    bench.service.params = PlannerParams(inflation_radius=0.13)
    assert bench.step(2).state == NavStatus.DRIVING
    assert np.isfinite(bench.service._planner.costs.distance).all()


@pytest.mark.parametrize(("here", "why"), [((0.5, 1.0), "on ground that is not mapped"), ((-3.0, 1.0), "outside its map")])
def test_where_nothing_can_be_planned_nothing_counts_as_explored_and_it_is_said_once(here, why):
    bench = Bench(explores=True)
    cells = room(4.0, 3.0)
    cells[:, :30] = -1
    bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)
    bench.here = here
    bench.step(20)
    said = bench.said["nav_status"]
    assert (said.state, said.explored) == (NavStatus.BLOCKED, 0.0)
    assert why in said.reason
    assert bench.events.count("explore: nothing can be planned") == 1
    bench.here = (3.0, 1.0)
    bench.step(20)
    assert bench.said["nav_status"].explored > 0.0 and bench.state == NavStatus.DRIVING


def test_a_lidar_ahead_of_the_vehicle_shows_enough_to_begin_with():
    bench = Bench(explores=True)
    cells = room(4.0, 3.0)
    bench.service = planner(True, 0.2)
    bench.grid = occupancy_grid(cells[:, 24:], 0.05, 1.2, 0.0, "v/map", 0.0)
    assert bench.step(SETTLED).state == NavStatus.DRIVING


@pytest.mark.parametrize("name", ["dijkstra", "jump_points", "theta_star", "rrt_star", "rrt_connect", "prm", "visibility_graph", "voronoi"])
def test_the_path_is_that_of_the_planner_that_was_chosen(name):
    bench = Bench()
    bench.service.params = PlannerParams(global_planner=name)
    walled = room(4.0, 3.0)
    walled[:40, 38:42] = 100
    bench.grid = occupancy_grid(walled, 0.05, 0.0, 0.0, "v/map", 0.0)
    bench.step(goal=[asked(3.0, 1.0)])
    assert bench.said["goal"][0].accepted
    path = bench.path
    assert path[0] == pytest.approx((1.0, 1.0), abs=0.06)
    assert path[-1] == pytest.approx((3.0, 1.0), abs=0.06)
    assert path[np.abs(path[:, 0] - 2.0) < 0.1, 1].min() > 2.0 + 0.1


def test_people_see_what_it_plans_on_every_two_seconds_at_most():
    bench, told = Bench(), []
    for n in range(24):
        if n == 4:
            cells = room(4.0, 3.0)
            cells[40:, 60:] = 100
            bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", bench.t)
        bench.step()
        told += [(bench.t, bench.said["costmap"])] if bench.said.get("costmap") is not None else []
    (first, _), (second, grid) = told
    assert second - first >= 2.0
    values, costs = cost_cells(grid), bench.service._planner.costs
    assert grid.frame_id == "v/map" and grid.fields[0].name == "cost" and np.array_equal(values, costs.values)
    assert {0, 254} <= set(np.unique(values).tolist())
