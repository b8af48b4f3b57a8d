"""Vehicles that cannot turn on the spot: nothing that is planned, tried or driven is tighter than they steer."""

from dataclasses import replace

import numpy as np
import pytest

from services.planner.build import build
from tests.planning.local.grounds import BODY, DT, LIMITS, drive, gap, ground
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2
from uvf.models.scenario import load_scenario
from uvf.models.yaml_data import BadInput
from uvf.planning.costmap.bumps import Bump
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import STOP, State, fastest_turn, within
from uvf.planning.navigation.directive import Action, Directive, Report
from uvf.planning.navigation.execution import Executor
from uvf.planning.navigation.failures import Failure, Recovery, recoveries
from uvf.planning.navigation.navigator import NavigationGoal, Navigator, NavigatorSettings, Route, Status
from uvf.planning.navigation.retreat import Retreat

RADIUS = 0.7
CAR = LIMITS._replace(max_speed=0.6, min_speed=-0.4, max_turn_rate=0.6 / RADIUS, turning_radius=RADIUS)


@pytest.mark.parametrize(("speed", "most"), [(0.0, 0.0), (0.35, 0.5), (-0.35, 0.5), (0.6, 0.6 / RADIUS)])
def test_it_turns_no_faster_than_its_speed_over_its_radius(speed, most):
    assert fastest_turn(CAR, speed) == pytest.approx(most)
    turn = within(CAR, State(0.0, 0.0, 0.0, speed, 2.0), Twist(speed, 2.0), 0.05).angular
    assert turn <= most + 1e-9


def test_it_drives_round_to_a_goal_behind_it():
    planner = Mppi(CAR, BODY, MppiSettings(samples=400, steps=75), 3)
    states = drive(planner, ground(), (-2.0, 0.3), start=State(0.0, 0.0, 0.0, 0.0, 0.0), limits=CAR)
    assert np.hypot(states[-1].x + 2.0, states[-1].y - 0.3) < 0.15
    for state in states:
        assert abs(state.turn_rate) * RADIUS <= abs(state.speed) + 1e-6


def test_it_keeps_off_a_wall_that_stands_where_others_would_turn():
    wall = (0.9, -3.0, 1.1, 3.0)
    planner = Mppi(CAR, BODY, MppiSettings(samples=400, steps=75), 3)
    states = drive(planner, ground(wall), (-2.0, 1.0), start=State(0.2, 0.0, 0.0, 0.0, 0.0), limits=CAR)
    assert np.hypot(states[-1].x + 2.0, states[-1].y - 1.0) < 0.15
    assert min(gap(wall, state) for state in states) > 0.0
    assert len(states) * DT < 30.0


@pytest.mark.parametrize("failure", list(Failure))
def test_its_recoveries_back_up_where_others_turn(failure):
    tried = recoveries(failure, 0.3, RADIUS)
    assert len(tried) == len(recoveries(failure, 0.3))
    assert all(attempt.recovery != Recovery.CLEARING_ROTATION for attempt in tried)
    assert all(attempt.amount >= RADIUS for attempt in tried if attempt.recovery == Recovery.BACK_UP)


class Straight:
    """A way straight to the goal, whatever stands there."""

    def plan(self, pose, goal):
        return Route(np.array((pose[:2], (goal.x, goal.y))))

    def is_free(self, path):
        return True

    def has_room_to_turn(self, pose):
        return True

    def reset(self):
        pass


@pytest.mark.parametrize(("radius", "status"), [(0.0, Status.FOLLOWING), (RADIUS, Status.REACHED)])
def test_it_comes_to_a_goal_heading_anywhere(radius, status):
    navigator = Navigator(Straight(), NavigatorSettings(turning_radius=radius))
    navigator.start(0.0, NavigationGoal(2.0, 0.0, 1.5))
    assert navigator.step(0.0, Pose2(0.0, 0.0, 0.0), Report(0)).heading == (None if radius else 1.5)
    navigator.step(1.0, Pose2(2.0, 0.0, 0.0), Report(0))
    assert navigator.feedback.status == status


def seen_ahead(limits):
    """A controller that has seen open floor before it, and nothing behind."""
    controller = LocalController(BODY, limits, Mppi(limits, BODY, MppiSettings(samples=50, steps=20)), ControllerSettings())
    angles = np.linspace(-2.0, 2.0, 400)
    points = 5.0 * np.column_stack((np.cos(angles), np.sin(angles)))
    for t in (0.0, 0.1):
        controller.see(t, Pose2(0.0, 0.0, 0.0), (0.0, 0.0), points, np.zeros(400))
    return controller


def test_it_backs_up_only_onto_ground_that_has_been_seen():
    executor, back = Executor(seen_ahead(CAR)), Directive(1, Action.BACK_UP, amount=0.3)
    for i in range(15):
        assert executor.step(0.1 * i, Pose2(0.0, 0.0, 0.0), STOP, back) == STOP
    assert executor.report.impossible
    assert executor.controller.knows_behind(Pose2(2.0, 0.0, 0.0))
    assert executor.step(2.0, Pose2(2.0, 0.0, 0.0), STOP, replace(back, number=2)).linear < 0.0


def test_it_draws_back_from_a_touch_without_turning():
    bump = Bump(Pose2(0.0, 0.0, 0.0), (0.0, 1.0), np.array(((0.3, 0.1),)))
    assert Retreat(0.0, Pose2(0.0, 0.0, 0.0), bump).wanted().angular != 0.0
    away = Retreat(0.0, Pose2(0.0, 0.0, 0.0), bump, turns_on_the_spot=False).wanted()
    assert away.linear < 0.0 and away.angular == 0.0


def test_a_local_planner_that_turns_on_the_spot_is_refused_for_it(tmp_path):
    mission = tmp_path / "car.yaml"
    mission.write_text(
        "about: a car\nworld: empty\nvehicles:\n"
        "  car: {model: minicar, system_id: 1, start: {x: 0, y: 0, yaw: 0}, params: {tracker: {local_planner: pid}}}\n"
    )
    with pytest.raises(BadInput, match=r"pid turns on the spot, which a car cannot; take mppi, dwa, trajectory_rollout"):
        build(load_scenario(mission))
