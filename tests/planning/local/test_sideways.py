"""Vehicles that drive sideways: the local planner makes use of it where that is shorter, and the stop looks there, too."""

import numpy as np
import pytest

from tests.planning.local.grounds import BODY, LIMITS, drive, gap, ground
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import State, within

MECANUM = LIMITS._replace(side_speed=0.6, max_speed=1.0, min_speed=-0.5)
AHEAD = MECANUM._replace(side_speed=0.0)
STAND = State(0.0, 0.0, 0.0, 0.0, 0.0)


def mppi(limits=MECANUM):
    return Mppi(limits, BODY, MppiSettings(), 3)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_place_beside_it_is_gone_to_sooner_than_by_turning_first(side):
    states = drive(mppi(), ground(), (0.1, 1.2 * side), start=STAND, limits=MECANUM)
    assert np.hypot(states[-1].x - 0.1, states[-1].y - 1.2 * side) < 0.15
    assert max(side * state.side for state in states) > 0.3
    turning = drive(mppi(AHEAD), ground(), (0.1, 1.2 * side), start=STAND, limits=AHEAD)
    assert len(states) < 0.9 * len(turning)


def test_a_long_way_is_still_driven_ahead():
    states = drive(mppi(), ground(), (3.0, 2.0), start=STAND, limits=MECANUM)
    assert np.hypot(states[-1].x - 3.0, states[-1].y - 2.0) < 0.15
    far = states[len(states) // 3 : -10]
    assert np.mean([abs(state.side) for state in far]) < 0.3 * np.mean([state.speed for state in far])


def test_it_goes_round_what_stands_beside_it():
    box = (-0.4, 0.6, 0.4, 0.9)
    states = drive(mppi(), ground(box), (0.0, 1.6), start=STAND, limits=MECANUM)
    assert np.hypot(states[-1].x, states[-1].y - 1.6) < 0.15
    assert min(gap(box, state) for state in states) > 0.0


def test_who_cannot_go_sideways_is_never_told_to():
    states = drive(mppi(AHEAD), ground(), (0.1, 1.2), start=STAND, limits=AHEAD)
    assert all(state.side == 0.0 for state in states)


def test_its_speed_to_the_side_keeps_its_limits():
    wanted = within(MECANUM, STAND, Twist(0.0, 0.0, 5.0), 0.05)
    assert wanted == Twist(0.0, 0.0, pytest.approx(MECANUM.acceleration * 0.05))
    fast = State(0.0, 0.0, 0.0, 0.0, 0.0, 0.6)
    assert within(MECANUM, fast, Twist(0.0, 0.0, 5.0), 0.05).lateral == pytest.approx(0.6)
    assert within(LIMITS, STAND, Twist(0.0, 0.0, 5.0), 0.05).lateral == 0.0


@pytest.mark.parametrize(("side", "goes"), [(0.6, False), (-0.6, True)])
def test_the_stop_holds_it_before_what_it_would_be_driven_into_sideways(side, goes):
    controller = LocalController(BODY, MECANUM, mppi(), ControllerSettings())
    wall = np.column_stack((np.linspace(-1.0, 1.0, 81), np.full(81, 0.24)))
    here = Pose2(0.0, 0.0, 0.0)
    controller.see(0.0, here, (0.0, 0.0), wall, np.hypot(*wall.T))
    command = controller.made_safe(Twist(0.0, 0.0, side), Twist(0.0, 0.0))
    assert (command.lateral == side) == goes and abs(command.lateral) <= abs(side)
