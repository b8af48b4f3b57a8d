"""Driving by hand from a page: one driver, a held direction counts half a second, everything else ends in standing and silence."""

import pytest

from schemas.messages import CancelRequest, Mode, ModeRequest, NavStatus
from services.gcs.actions.page import Command, Hello, Join, Leave, LeaveWheel, Rescale, Select, Steer, StopAll, TakeWheel
from services.gcs.orders.by_hand import PATIENCE, ManualDriving
from services.gcs.page.words import action_in
from services.gcs.view.panels.vehicle.teleoperation import wheel
from tests.services.gcs.fakes import ME, OPERATORS, OTHER, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.control.teleop_drive import START_ANGULAR, START_LINEAR, STILL, ZEROS
from uvf.maths.kinematics import Twist

START = Twist(START_LINEAR, START_ANGULAR)


@pytest.fixture
def station():
    station = Station()
    station.run(0.5)
    return station


@pytest.fixture
def driven(station):
    station.press(TakeWheel(ME, UGV))
    return station


def modes_asked(station):
    return [m.mode for _, m in station.script.asked if isinstance(m, ModeRequest)]


def test_taking_the_wheel_asks_for_mode_manual_and_sends_nothing_yet(driven):
    assert modes_asked(driven) == [Mode.MODE_MANUAL]
    assert driven.script.drives == []
    assert "data-driver='mine'" in driven.page.now.html["wheel"]


def test_a_held_direction_drives_at_the_scales_of_teleop(driven):
    driven.press(Steer(ME, 1.0, 0.0, 0.0))
    assert driven.script.drives[-1] == pytest.approx((START.linear, 0.0))
    driven.press(Steer(ME, 0.0, -1.0, 0.0))
    assert driven.script.drives[-1] == pytest.approx((0.0, -START.angular))


def test_without_a_word_it_is_told_to_stand_after_half_a_second_and_then_nothing_more(driven):
    driven.press(Steer(ME, 1.0, 0.0, 0.0), seconds=PATIENCE + ZEROS + 0.5)
    ways = [linear > 0 for linear, _ in driven.script.drives]
    assert ways == sorted(ways, reverse=True)
    assert 0.4 <= ways.count(True) * 0.05 <= 0.55
    assert 0.0 < ways.count(False) * 0.05 <= ZEROS


@pytest.mark.parametrize(
    "action",
    [
        Steer(ME, 0.0, 0.0, 0.0),
        LeaveWheel(ME),
        Leave(ME),
        Select(ME, UAV),
        Command(ME, UGV, "hold"),
        StopAll(ME),
        Command(ME, UGV, "mission"),
    ],
)
def test_it_is_told_to_stand_at_once_when(driven, action):
    driven.press(Steer(ME, 1.0, 0.0, 0.0))
    driven.press(action, seconds=0.05)
    assert driven.script.drives[-1] == (0.0, 0.0)


def test_only_the_driver_is_heard_and_another_page_of_the_same_operator_may_take_over(driven):
    driven.press(Steer(OTHER, 1.0, 0.0, 0.0), Rescale(OTHER, "f"))
    assert driven.script.drives == []
    driven.press(Join(OTHER), Hello(OTHER, OPERATORS[ME], ""), TakeWheel(OTHER, UGV), Steer(OTHER, 1.0, 0.0, 0.0))
    assert driven.script.drives[-1] == pytest.approx((START.linear, 0.0))


def test_another_operator_has_to_be_given_control_first(driven):
    driven.join_other()
    driven.press(TakeWheel(OTHER, UGV), Steer(OTHER, 1.0, 0.0, 0.0))
    assert driven.script.drives == []
    assert "controls burger: ask for control first" in driven.model.vehicles[UGV].order.reason


def test_the_scales_change_by_a_tenth_within_what_the_vehicle_can(driven):
    driven.press(Rescale(ME, "f"), Rescale(ME, "t"), Rescale(ME, "x"), Steer(ME, 1.0, 1.0, 0.0))
    assert driven.script.drives[-1] == pytest.approx((START.linear / 1.1, START.angular * 1.1))


@pytest.mark.parametrize("hindered", ["disarmed", "stopped", "aircraft"])
def test_nobody_takes_the_wheel_of_what_would_not_move(station, hindered):
    if hindered == "disarmed":
        station.script.armed[UGV] = False
        station.run(0.2)
    station.press({"stopped": StopAll(ME), "aircraft": Select(ME, UAV)}.get(hindered, Select(ME, UGV)))
    station.press(TakeWheel(ME, UAV if hindered == "aircraft" else UGV))
    station.press(Steer(ME, 1.0, 0.0, 0.0))
    assert station.script.drives == [] and modes_asked(station) == []


def test_the_panel_says_when_the_vehicle_does_not_obey(driven):
    driven.run(0.3)
    assert "goes while a key" in driven.page.now.html["wheel"]
    driven.script.mode[UGV] = Mode.MODE_HOLD
    driven.run(0.3)
    assert "its mode is Hold, not Manual" in driven.page.now.html["wheel"]


@pytest.mark.parametrize(("sideways", "sent"), [(0.8, (0.0, 0.0, -START_LINEAR)), (0.0, STILL)])
def test_what_goes_sideways_has_keys_for_it_and_moves_there_at_the_linear_scale(station, sideways, sent):
    by_hand = ManualDriving({UGV: Twist(0.8, 2.0, sideways)})
    by_hand.take(0.0, ME, UGV)
    by_hand.steer(0.0, ME, Twist(0.0, 0.0, -1.0))
    panel = str(wheel(station.model.vehicles[UGV], by_hand, ME))
    assert ("data-keys='D' data-steer='0 0 -1'" in panel) == (sideways > 0)
    assert by_hand.commands(0.1)[UGV] == sent


def test_commands_of_nobody_are_none():
    assert ManualDriving({"one": STILL}).commands(0.0) == {}


@pytest.mark.parametrize(
    ("said", "action"),
    [
        ('[1, "take-wheel", "burger"]', TakeWheel(ME, UGV)),
        ('[1, "leave-wheel"]', LeaveWheel(ME)),
        ('[1, "steer", 1, -0.5, 0]', Steer(ME, 1.0, -0.5, 0.0)),
        ('[1, "scale", "r"]', Rescale(ME, "r")),
        ('[1, "select", "burger"]', Select(ME, "burger")),
        ('[1, "steer", 2, 0, 0]', None),
        ('[1, "steer", NaN, 0, 0]', None),
        ('[1, "steer", 1, 0]', None),
        ('[1, "steer", "1", 0, 0]', None),
        ('[1, "steer", 1, 0, 0, 0]', None),
        ('["select", "burger"]', None),
        ('[1, "page", 7]', None),
        ("{", None),
    ],
)
def test_the_words_of_the_page_are_read(said, action):
    assert action_in(said, ME) == action


def test_a_goal_can_be_cancelled_while_it_is_driven_to(station):
    assert "Cancel goal" not in station.page.now.words
    station.script.job = "goal"
    station.run(0.2)
    assert station.model.vehicles[UGV].nav_status.state == NavStatus.DRIVING
    station.push("Cancel goal")
    assert [(n, m.source) for n, m in station.script.asked if isinstance(m, CancelRequest)] == [(UGV, "gcs")]
    assert station.model.vehicles[UGV].order.text == "cancel the goal"
