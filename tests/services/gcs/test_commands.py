"""What is asked on the page is checked, sent once, and followed until it is answered."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import ArmRequest, GoalRequest, Mode, ModeRequest
from services.gcs.actions import Arm, ClickGround, Layer, Select, SetMode, StopAll, ground_point
from services.gcs.commands import ANSWER_WITHIN, CONFIRM_WITHIN, describe
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.runtime.state.stop_all import StopVoice


def click(x, y, vehicle=UGV):
    """A click that looks at the point from the south-west, 10 m up."""
    return ClickGround(vehicle, (x - 5.0, y - 7.0, 10.0), (5.0, 7.0, -10.0))


@pytest.fixture
def station():
    station = Station()
    station.run(0.5)
    return station


def test_a_ray_meets_the_ground():
    assert ground_point((1, 2, 10), (0.5, 0, -1)) == pytest.approx((6, 2))


@pytest.mark.parametrize(
    "ray",
    [((0, 0, 5), (1, 0, 0)), ((0, 0, 5), (0, 0, 1)), ((0, 0, 5), (0, 0, np.nan)), ((0, 0), (1, 1)), ((0, 0, np.inf), (0, 0, -1))],
)
def test_a_ray_into_the_sky_or_nowhere_meets_nothing(ray):
    assert ground_point(*ray) is None


def test_a_click_sends_the_chosen_ground_vehicle_there(station):
    station.press(click(4.0, 3.0))
    ((name, goal),) = station.script.asked
    assert name == UGV
    assert (goal.position.x, goal.position.y, goal.source) == (pytest.approx(4.0), pytest.approx(3.0), "gcs")
    assert np.isnan(goal.yaw)
    assert station.model.vehicles[UGV].order.state == "accepted"


def test_a_vehicle_on_hold_is_put_into_mission_mode_to_go(station):
    station.script.mode[UGV] = Mode.MODE_HOLD
    station.run(0.2)
    station.press(click(4.0, 3.0))
    assert {type(m) for _, m in station.script.asked} == {GoalRequest, ModeRequest}
    assert next(m for _, m in station.script.asked if isinstance(m, ModeRequest)).mode == Mode.MODE_MISSION


def test_a_refused_goal_leaves_the_mode_as_it_was(station):
    station.script.mode[UGV] = Mode.MODE_HOLD
    station.script.accept = False
    station.run(0.2)
    station.press(click(4.0, 3.0))
    station.run(0.3)
    modes = [m.mode for _, m in station.script.asked if isinstance(m, ModeRequest)]
    assert modes == [Mode.MODE_MISSION, Mode.MODE_HOLD]


def test_a_goal_that_would_move_nothing_is_refused_with_the_mend(station):
    station.script.armed[UGV] = False
    station.run(0.2)
    station.press(click(4.0, 3.0))
    assert "arm it first" in station.model.vehicles[UGV].order.reason
    station.press(StopAll(True))
    station.press(click(4.0, 3.0))
    assert "release it first" in station.model.vehicles[UGV].order.reason
    assert station.script.asked == []


def test_a_refusal_is_shown_with_its_reason():
    station = Station(accept=False)
    station.run(0.5)
    station.press(click(4.0, 3.0))
    order = station.model.vehicles[UGV].order
    assert (order.state, order.reason) == ("refused", "the <goal> lies inside a wall")
    assert "inside a wall" in list(station.model.log)[-1].text
    assert station.model.vehicles[UGV].goal_asked is None


def test_a_click_does_not_send_an_aircraft(station):
    station.press(click(4.0, 3.0, UAV))
    assert station.script.asked == []
    assert station.model.vehicles[UAV].order.state == "refused"


def test_a_click_far_outside_is_refused_here(station):
    station.press(click(400.0, 3.0))
    assert station.script.asked == []
    assert "too far" in station.model.vehicles[UGV].order.reason


def test_a_vehicle_that_fell_silent_gets_no_orders(station):
    station.run(6.0, silent=True)
    station.page.clicks.append(click(4.0, 3.0))
    station.run(0.1, silent=True)
    assert station.script.asked == []
    assert "no link" in station.model.vehicles[UGV].order.reason


def test_arming_wants_a_second_press(station):
    station.press(Arm(ME, UGV, False))
    assert station.script.asked == []
    station.press(Arm(ME, UGV, False))
    ((name, request),) = station.script.asked
    assert (name, request.arm, request.force) == (UGV, False, False)


@pytest.mark.parametrize("between", [[Select(ME, UAV), Select(ME, UGV)], [Arm(ME, UGV, True)]])
def test_a_second_press_counts_only_for_the_same_question(station, between):
    station.press(Arm(ME, UGV, False), *between, Arm(ME, UGV, False))
    assert station.script.asked == []


def test_a_second_press_must_come_soon(station):
    station.press(Arm(ME, UGV, False))
    station.run(CONFIRM_WITHIN)
    station.press(Arm(ME, UGV, False))
    assert station.script.asked == []


def test_modes_go_to_the_chosen_vehicle(station):
    station.press(Select(ME, UAV), SetMode(UAV, "Return"))
    ((name, request),) = station.script.asked
    assert (name, request.mode) == (UAV, Mode.MODE_RETURN)


@pytest.mark.parametrize("action", [SetMode(UGV, "Return"), SetMode(UGV, "nonsense"), Select(ME, "nobody"), Layer(ME, "nothing", True)])
def test_what_a_page_cannot_ask_is_not_sent(station, action):
    layers = station.model.layers
    station.press(action)
    assert station.script.asked == []
    assert station.page.now.vehicle == UGV
    assert station.model.layers == layers


def test_stop_all_goes_out_at_once_and_holds_until_released(station):
    station.press(StopAll(True), seconds=0.05)
    assert [(s.engaged, s.source) for s in station.script.stops] == [(True, "gcs")]
    station.run(1.0)
    assert station.model.stopped
    station.press(StopAll(False), seconds=0.2)
    assert [s.engaged for s in station.script.stops] == [True, False]
    assert not station.model.stopped


def test_another_source_may_release_our_stop_and_engage_its_own(station):
    station.press(StopAll(True), seconds=0.5)
    client = StopVoice("client")
    for said, stopped in ((client.release(0, station.model.stops), False), (client.engage(0, ""), True)):
        station.script.put("sys", topics.STOP.by("client"), said, station.t)
        station.script.stops.append(said)
        station.run(0.3)
        assert station.model.stopped is stopped


def test_the_page_releases_by_name_what_others_have_engaged(station):
    station.script.put("sys", topics.STOP.by("launcher"), StopVoice("launcher").engage(0, "slam was given up"), station.t)
    station.run(0.3)
    (engagement,) = station.model.stops
    station.press(StopAll(False), seconds=0.3)
    assert [(one.source, one.id) for one in station.script.stops[-1].releases] == [("launcher", engagement.id)]
    assert not station.model.stopped


def test_stop_all_needs_no_link(station):
    station.run(60.0, silent=True)
    station.page.clicks.append(StopAll(True))
    station.run(0.05, silent=True)
    assert station.script.stops[-1].engaged


def test_an_order_that_nobody_answers_ends_as_refused(station):
    station.script.bus._servers.clear()
    station.script.bus.serve("uvf/*/srv/goal", lambda query: None)
    station.press(click(4.0, 3.0))
    assert station.model.vehicles[UGV].order.state == "sent"
    station.run(ANSWER_WITHIN + 0.1)
    assert station.model.vehicles[UGV].order.reason == "no answer"


def test_an_order_without_a_server_is_refused_with_the_reason(station):
    station.script.bus._servers.clear()
    station.press(SetMode(UGV, "Hold"))
    assert "nobody answers" in station.model.vehicles[UGV].order.reason


def test_requests_are_described_in_words():
    goal = GoalRequest()
    goal.position.x, goal.position.y = 1.04, -2.0
    assert describe(goal) == "go to (1.0, -2.0) m"
    assert describe(ModeRequest(mode=Mode.MODE_RETURN)) == "mode Return"
    assert [describe(ArmRequest(arm=a)) for a in (True, False)] == ["arm", "disarm"]
