"""The planner step by step: goals, what it does without inputs, what it does when blocked."""

import numpy as np
import pytest

from schemas.messages import (
    CancelRequest,
    Fence,
    FenceZone,
    GoalRequest,
    LaserScan,
    Mission,
    MissionItem,
    MissionProgress,
    Mode,
    NavDirective,
    NavReport,
    NavStatus,
    PoseInFrame,
    PreviewRequest,
    Vector3,
    VehicleStatus,
)
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planner_service import PlannerService
from services.planner.scan_placing import ScanPlacer
from services.planner.tracker_service import FARTHEST
from tests.runtime.stepping import recall, stale, stepped
from tests.services.live_params import all_settable_are_read
from tests.services.planner.plans import room
from uvf.maths.se3 import Transform
from uvf.planning import global_planner
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.search.grid_search import GridSearch
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp
from uvf.sensors.sweeping import AT_ONCE

READY = VehicleStatus(mode=Mode.MODE_MISSION, armed=True, command_source="planner")
NOTHING = dict.fromkeys(("scan", "report", "mission", "progress", "bounds", "rally"))
START = (10.0, 20.0, np.pi / 2)
"""The map lies here in the world, turned: map x is world y."""


def planner(explores=False, offset=0.0):
    """Of a round vehicle of 0.1 m with a lidar ``offset`` [m] ahead of its centre."""
    placer = ScanPlacer(Transform(np.array((1.0, 0.0, 0.0, 0.0)), np.array((offset, 0.0, 0.1))), AT_ONCE, FARTHEST)
    return PlannerService(START, PlannedVehicle(RobotFootprint.circle(0.1), placer, 0.45, explores), PlannerParams())


CANCEL = CancelRequest(source="test")


class Bench:
    """Steps a planner at 4 Hz in a room of 4 x 3 m; the vehicle stands at ``here`` [m, map] unless it is moved."""

    def __init__(self, explores=False):
        self.service = planner(explores)
        self.t = 0.0
        self.here = (1.0, 1.0)
        self.yaw = START[2]  # rad, world
        self.grid = occupancy_grid(room(4.0, 3.0), 0.05, 0.0, 0.0, "v/map", 0.0)
        self.said = {}
        self.events = []
        self.asked = []

    def step(self, n=1, status=READY, goal=(), cancel=(), preview=(), **heard):
        for _ in range(n):
            self.t += 0.25
            pose = PoseInFrame(timestamp=stamp(self.t), pose=planar_pose(*world(*self.here), self.yaw))
            asks = {"goal": list(goal), "cancel": list(cancel), "preview": list(preview)}
            told = NOTHING | {"status": status, "pose": [pose], "map": self.grid} | asks | heard
            self.said = stepped(self.service, self.t, **told)
            self.events += [e.text for e in self.said["events"]]
            self.asked += self.said["set_mode"]
        return self

    @property
    def state(self):
        return self.said["nav_status"].state


def world(x, y):
    return (START[0] - y, START[1] + x)


def asked(x, y, yaw=float("nan")):
    position = world(x, y)
    return GoalRequest(position=Vector3(x=position[0], y=position[1]), yaw=yaw, source="test")


def preview(x, y):
    position = world(x, y)
    return PreviewRequest(position=Vector3(x=position[0], y=position[1]), source="test")


@pytest.mark.parametrize("explores", [False, True])
def test_on_a_map_too_large_to_plan_on_the_vehicle_stands_and_says_why(explores):
    bench = Bench(explores).step(4)
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


RECOVERIES = ["forgetting obstacles farther", "turning round", "forgetting all obstacles", "backing up", "waiting"]


def test_a_goal_is_given_up_when_the_vehicle_gets_nowhere_whatever_is_tried():
    bench = Bench().step(goal=[asked(3.0, 2.0)]).step(4 * 60)
    told = [event for event in bench.events if "does not move" in event]
    assert [event.startswith(recovery) for event, recovery in zip(told, RECOVERIES, strict=True)] == [True] * 5
    assert "goal: goal given up" in bench.events
    assert bench.said["nav_status"].job == "idle"


def test_trembling_about_the_heading_where_angles_wrap_is_not_getting_anywhere():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    for i in range(4 * 60):
        bench.yaw = START[2] + np.pi + (0.01 if i % 2 else -0.01)
        bench.step()
    assert "goal: goal given up" in bench.events


def test_what_the_tracker_is_to_do_goes_with_the_path():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    following = bench.said["directive"]
    assert (following.action, len(bench.said["path"].poses) > 10) == (NavDirective.FOLLOW, True)
    assert bench.step().said["directive"].number == following.number
    while bench.state != NavStatus.RECOVERING:
        bench.step()
    resetting = bench.said["directive"]
    assert (resetting.action, resetting.clear_beyond) == (NavDirective.STOP, 3.0)
    assert resetting.number > following.number
    assert (bench.state, len(bench.said["path"].poses)) == (NavStatus.RECOVERING, 0)
    assert bench.said["nav_status"].recoveries == 1


def test_a_recovery_ends_when_the_tracker_says_so():
    bench = Bench().step(goal=[asked(3.0, 2.0)])
    while bench.said["directive"].action != NavDirective.SPIN:
        bench.step()
    spin = bench.said["directive"]
    bench.step(report=NavReport(number=spin.number - 1, done=True))
    assert bench.said["directive"].number == spin.number
    bench.step(report=NavReport(number=spin.number, done=True))
    assert bench.said["directive"].action == NavDirective.FOLLOW


def wall_seen(bench, x):
    """A scan of a vehicle that looks along the map's x, with a wall across its way ``x`` [m] ahead, as wide as the room but for a gap."""
    angles = np.radians(np.arange(-60.0, 61.0))
    across = x * np.tan(angles)
    ranges = np.where((across > -0.95) & (across < 1.0), x / np.cos(angles), 0.0)
    return LaserScan(timestamp=stamp(bench.t), start_angle=angles[0], end_angle=angles[-1], ranges=ranges.tolist())


def test_what_the_lidar_sees_and_the_map_does_not_is_gone_round():
    bench = Bench().step(goal=[asked(3.0, 1.0)]).step(2)
    highest = max(pose.position.x for pose in bench.said["path"].poses)
    bench.step(scan=wall_seen(bench, 1.0)).step(4)
    path = np.array([(pose.position.y - START[1], START[0] - pose.position.x) for pose in bench.said["path"].poses])
    assert highest == pytest.approx(START[0] - 1.0, abs=0.1)
    assert path[np.abs(path[:, 0] - 2.0) < 0.3, 1].min() > 2.0


def test_a_preview_tells_the_way_without_driving_it():
    bench = Bench().step()
    bench.step(preview=[preview(3.0, 2.0), preview(0.07, 1.0)])
    good, bad = bench.said["preview"]
    assert (good.accepted, bench.said["nav_status"].job) == (True, "idle")
    assert good.length == pytest.approx(np.hypot(2.0, 1.0), rel=0.1)
    assert good.duration == pytest.approx(good.length / 0.45)
    assert good.clearance == pytest.approx(0.9, abs=0.15)
    assert (good.poses[-1].position.x, good.poses[-1].position.y) == pytest.approx(world(3.0, 2.0))
    assert (bad.accepted, bad.reason, len(bad.poses)) == (False, "the goal lies in an obstacle", 0)


def test_a_flood_of_previews_is_answered_in_part():
    bench = Bench().step().step(preview=[preview(2.0, 2.0)] * 50)
    answers = bench.said["preview"]
    assert [answer.accepted for answer in answers] == [True] * 4 + [False] * 46
    assert "ask again" in answers[-1].reason


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
    assert bench.step(2).state == NavStatus.DRIVING
