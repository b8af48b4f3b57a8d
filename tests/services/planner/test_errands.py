"""Routes and following: what a person asks for beyond a single goal, and what becomes of it."""

import numpy as np
import pytest

from schemas.messages import FollowRequest, NavStatus, PoseInFrame, RouteRequest, Vector3
from services.planner.params import PlannerParams
from tests.runtime.stepping import recall
from tests.services.planner.planner_bench import CANCEL, READY, Bench, world
from tests.services.planner.plans import room
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

PLACES = ((2.0, 0.6), (3.4, 1.0), (3.4, 2.4))
WAIT = int(PlannerParams().wait_at_goal * 4) + 2


def asked(kind, *places, **more):
    return RouteRequest(kind=kind, places=[Vector3(x=x, y=y) for x, y in (world(*place) for place in places)], source="test", **more)


def going_to(bench):
    goal = bench.said["nav_status"].goal
    return next(place for place in PLACES if np.allclose(world(*place), (goal.x, goal.y)))


def arrive(bench, place):
    bench.here = place
    bench.step(2)


def test_waypoints_are_driven_to_in_turn_and_stood_at():
    bench = Bench().step(route=[asked(RouteRequest.WAYPOINTS, *PLACES)])
    assert bench.said["route"][0].accepted
    for place in PLACES:
        assert (bench.said["nav_status"].job, going_to(bench)) == ("waypoints", place)
        arrive(bench, place)
        assert bench.state == NavStatus.REACHED
        bench.step(WAIT)
    assert bench.said["nav_status"].job == "idle"
    assert bench.events.count("goal reached") == 3


def test_a_patrol_begins_again_until_it_is_cancelled():
    bench = Bench().step(route=[asked(RouteRequest.PATROL, *PLACES[:2])])
    for place in (*PLACES[:2], *PLACES[:2]):
        assert going_to(bench) == place
        arrive(bench, place)
        bench.step(WAIT)
    bench.step(cancel=[CANCEL])
    assert bench.said["cancel"][0].accepted
    bench.step(WAIT)
    assert bench.said["nav_status"].job == "idle"


def test_between_two_places_of_a_route_it_is_never_without_its_job_nor_already_there():
    """Who waits for the end of the route, as the executive does, would take that for something else, or for the end."""
    bench = Bench().step(route=[asked(RouteRequest.WAYPOINTS, *PLACES)])
    arrive(bench, PLACES[0])
    said = []
    for _ in range(WAIT):
        status = bench.step().said["nav_status"]
        said.append((status.job, status.route_at, status.state))
    assert set(said) == {("waypoints", 0, NavStatus.REACHED), ("waypoints", 1, NavStatus.DRIVING)}


def test_a_route_asked_for_in_the_step_in_which_the_wait_at_a_goal_ends_is_not_lost():
    for early in range(4):
        bench = Bench().step(route=[asked(RouteRequest.WAYPOINTS, PLACES[0])])
        arrive(bench, PLACES[0])
        bench.step(WAIT - 4 + early)
        bench.step(route=[asked(RouteRequest.WAYPOINTS, PLACES[1])])
        bench.step(2)
        assert (bench.said["nav_status"].job, going_to(bench)) == ("waypoints", PLACES[1])


def test_a_patrol_can_be_cancelled_while_it_stands_at_a_place():
    bench = Bench().step(route=[asked(RouteRequest.PATROL, *PLACES[:2])])
    arrive(bench, PLACES[0])
    bench.step(cancel=[CANCEL])
    assert bench.said["cancel"][0].accepted
    bench.step(WAIT)
    assert bench.said["nav_status"].job == "idle"


def test_places_to_pass_lie_on_the_path_and_are_struck_off():
    bench = Bench().step(route=[asked(RouteRequest.THROUGH, *PLACES)])
    path = bench.path
    for place in PLACES:
        assert np.hypot(*(path - place).T).min() < 0.05
    bench.here = PLACES[0]
    bench.step()
    bench.here = (2.6, 0.8)
    bench.step(5)
    path = bench.path
    assert np.hypot(*(path - PLACES[0]).T).min() > 0.3
    assert np.hypot(*(path - PLACES[1]).T).min() < 0.05
    assert bench.state == NavStatus.DRIVING


def test_the_last_place_does_not_count_as_reached_before_the_others_are_passed():
    bench = Bench()
    bench.step(route=[asked(RouteRequest.THROUGH, PLACES[2], bench.here)])
    assert bench.state == NavStatus.DRIVING


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (asked(RouteRequest.WAYPOINTS), "no places"),
        (asked(RouteRequest.WAYPOINTS, PLACES[0], (50.0, 1.0)), "place 2 of 2: the goal lies outside the map"),
        (asked(7, PLACES[0]), "no kind 7"),
        (asked(RouteRequest.PATROL, PLACES[0], yaw=float("nan")), "heading"),
        (asked(RouteRequest.PATROL, (float("nan"), 1.0)), "place 1 of 1"),
    ],
    ids=["empty", "outside", "unknown kind", "no heading", "no place"],
)
def test_a_route_that_cannot_be_driven_is_refused_with_the_place(request_, why):
    bench = Bench().step(route=[request_])
    assert why in bench.said["route"][0].reason
    assert bench.said["nav_status"].job == "idle"


def test_started_again_it_goes_on_with_its_route_where_it_was():
    bench = Bench().step(route=[asked(RouteRequest.PATROL, *PLACES)])
    arrive(bench, PLACES[0])
    bench.step(WAIT)
    assert going_to(bench) == PLACES[1]
    other = Bench()
    recall(other.service, nav_status=bench.said["nav_status"])
    other.step()
    assert (other.said["nav_status"].job, going_to(other)) == ("patrol", PLACES[1])


def team(bench, **places):
    return {name: PoseInFrame(timestamp=stamp(bench.t), pose=planar_pose(*world(*place), 0.0)) for name, place in places.items()}


def lead(bench, *places, **more):
    """Steps with the leader at the places, one after the other."""
    for place in places:
        bench.step(team=team(bench, v=bench.here, leader=place), **more)
        more = {}


def test_it_follows_on_the_track_of_the_leader_and_stands_when_near():
    bench = Bench()
    lead(bench, (2.2, 1.0), follow=[FollowRequest(vehicle="leader", distance=0.8)])
    assert bench.said["follow"][0].accepted
    lead(bench, *((2.2 + 0.1 * k, 1.0) for k in range(11)), *((3.2, 1.0 + 0.1 * k) for k in range(1, 13)))
    goal = bench.said["nav_status"].goal
    assert (goal.x, goal.y) == pytest.approx(world(3.2, 2.2 - 0.8), abs=0.35)
    assert bench.path[-1] == pytest.approx((3.2, 1.4), abs=0.35)
    bench.here = (3.2, 1.5)
    lead(bench, (3.2, 2.2), (3.2, 2.2))
    assert bench.said["nav_status"].reason == "near enough to leader"
    assert len(bench.said["path"].poses) == 0
    lead(bench, *((3.2 - 0.1 * k, 2.2) for k in range(12)))
    assert bench.state == NavStatus.DRIVING


def test_a_place_in_an_obstacle_does_not_end_following_for_the_leader_goes_on():
    bench = Bench()
    cells = room(4.0, 3.0)
    cells[16:25, 40:50] = 100  # where the leader stood when the map was drawn
    bench.grid = occupancy_grid(cells, 0.05, 0.0, 0.0, "v/map", 0.0)
    lead(bench, (2.2, 1.0), follow=[FollowRequest(vehicle="leader", distance=0.8)])
    lead(bench, *((2.2 + 0.1 * k, 1.0) for k in range(9)), *[(3.0, 1.0)] * 60)
    assert (bench.said["nav_status"].job, bench.said["nav_status"].reason) == ("follow", "the goal lies in an obstacle")
    assert "follow: goal given up" not in bench.events
    lead(bench, *((3.2, 1.0 + 0.1 * k) for k in range(1, 13)))
    assert bench.state == NavStatus.DRIVING
    assert bench.path[-1] == pytest.approx((3.2, 1.4), abs=0.35)


def test_without_word_of_the_leader_it_stands_and_says_so():
    bench = Bench()
    lead(bench, (3.0, 1.0), (3.2, 1.0), follow=[FollowRequest(vehicle="leader")])
    assert bench.state == NavStatus.DRIVING
    bench.step(2)
    assert bench.said["nav_status"].reason == "nothing is heard of leader"
    assert len(bench.said["path"].poses) == 0


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (FollowRequest(vehicle="lader"), "there are leader"),
        (FollowRequest(vehicle="v"), "nothing is heard of a vehicle 'v'"),
        (FollowRequest(vehicle="leader", distance=-1.0), "a distance of -1 m"),
        (FollowRequest(vehicle="leader", distance=float("nan")), "a distance of nan m"),
    ],
)
def test_what_cannot_be_followed_is_refused(request_, why):
    bench = Bench()
    lead(bench, (3.0, 1.0), follow=[request_])
    assert why in bench.said["follow"][0].reason


def test_following_goes_on_after_a_start_and_ends_when_cancelled():
    bench = Bench()
    lead(bench, (3.0, 1.0), (3.2, 1.0), follow=[FollowRequest(vehicle="leader")])
    other = Bench()
    recall(other.service, nav_status=bench.said["nav_status"])
    lead(other, (3.2, 1.0), (3.3, 1.0))
    assert (other.said["nav_status"].job, other.state) == ("follow", NavStatus.DRIVING)
    lead(other, (3.3, 1.0), cancel=[CANCEL])
    lead(other, *[(3.3, 1.0)] * WAIT)
    assert other.said["nav_status"].job == "idle"
    assert READY.armed
