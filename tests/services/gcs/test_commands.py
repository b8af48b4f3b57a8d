"""What is asked on the page is checked, sent once, and followed until it is answered."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import ArmRequest, GoalRequest, Mode, ModeRequest
from services.gcs.actions.maps import BeginMap
from services.gcs.actions.page import Command, Layer, Point, ReleaseStop, RunClock, Select, StopAll, ground_point
from services.gcs.orders.orders import ANSWER_WITHIN
from services.gcs.state.session import CONFIRM_WITHIN, OLD_AFTER
from services.gcs.state.wording import describe
from tests.services.gcs.fakes import ME, Station, click
from tests.services.gcs.scripted import UAV, UGV
from uvf.runtime.state.stop_all import StopVoice


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
    station.go(4.0, 3.0)
    ((name, goal),) = station.script.asked
    assert name == UGV
    assert (goal.position.x, goal.position.y, goal.source) == (pytest.approx(4.0), pytest.approx(3.0), "gcs")
    assert np.isnan(goal.yaw)
    assert station.model.vehicles[UGV].order.state == "accepted"


def test_a_vehicle_on_hold_is_put_into_mission_mode_to_go(station):
    station.script.mode[UGV] = Mode.MODE_HOLD
    station.run(0.2)
    station.go(4.0, 3.0)
    assert {type(m) for _, m in station.script.asked} == {GoalRequest, ModeRequest}
    assert next(m for _, m in station.script.asked if isinstance(m, ModeRequest)).mode == Mode.MODE_MISSION


def test_a_refused_goal_leaves_the_mode_as_it_was(station):
    station.script.mode[UGV] = Mode.MODE_HOLD
    station.script.accept = False
    station.run(0.2)
    station.go(4.0, 3.0)
    station.run(0.3)
    modes = [m.mode for _, m in station.script.asked if isinstance(m, ModeRequest)]
    assert modes == [Mode.MODE_MISSION, Mode.MODE_HOLD]


def test_a_goal_that_would_move_nothing_is_refused_with_the_mend(station):
    station.script.armed[UGV] = False
    station.run(0.2)
    station.go(4.0, 3.0)
    assert "arm it first" in station.model.vehicles[UGV].order.reason
    station.press(StopAll(ME))
    station.go(4.0, 3.0)
    assert "release it first" in station.model.vehicles[UGV].order.reason
    assert station.script.asked == []


def test_a_refusal_is_shown_with_its_reason():
    station = Station(accept=False)
    station.run(0.5)
    station.go(4.0, 3.0)
    order = station.model.vehicles[UGV].order
    assert (order.state, order.reason) == ("refused", "the <goal> lies inside a wall")
    assert "inside a wall" in list(station.model.log)[-1].text
    assert station.model.vehicles[UGV].goal_asked is None


def test_what_was_commanded_after_a_goal_is_not_taken_back_when_the_goal_is_refused():
    station = Station(accept=False)
    station.script.mode[UGV] = Mode.MODE_MANUAL
    station.run(0.5)
    station.press(click(4.0, 3.0), Point(ME, "go"), Command(ME, UGV, "hold"), seconds=0.5)
    modes = [m.mode for _, m in station.script.asked if isinstance(m, ModeRequest)]
    assert modes == [Mode.MODE_MISSION, Mode.MODE_HOLD]


def test_a_click_opens_a_menu_and_sends_nobody(station):
    station.press(click(4.0, 3.0), seconds=0.4)
    assert station.script.asked == []
    assert {"Go here: burger", "Go here and look …", "Measure from here", "Set home here", "Close"} <= station.page.now.words.keys()
    assert "data-x='4.000' data-y='3.000'" in station.page.now.html["menu"]


def test_the_menu_says_how_long_the_way_is_and_the_scene_shows_it(station):
    station.press(click(4.0, 3.0), seconds=0.4)
    assert "4.2 m, 9 s, 0.30 m clear" in station.page.now.html["menu"]
    assert station.page.now.own["/own/way"].points[-1][:2] == pytest.approx((4.0, 3.0))
    station.press(Point(ME, ""), seconds=0.4)
    assert station.page.now.own == {} and station.page.now.html["menu"] == ""


def test_a_place_without_a_way_says_so_before_anything_is_sent():
    station = Station(accept=False)
    station.run(0.5)
    station.press(click(4.0, 3.0), seconds=0.4)
    assert "no way" in station.page.now.html["menu"]
    assert station.script.asked == []


def test_a_second_click_says_where_the_vehicle_looks_at_the_goal(station):
    station.press(click(4.0, 3.0), Point(ME, "face"), click(4.0, 5.0))
    ((_, goal),) = station.script.asked
    assert (goal.position.x, goal.position.y, goal.yaw) == (pytest.approx(4.0), pytest.approx(3.0), pytest.approx(np.pi / 2))


def test_a_distance_is_measured_between_two_clicks(station):
    station.press(click(4.0, 3.0), Point(ME, "measure"), click(7.0, 7.0), seconds=0.4)
    assert "5.00 m" in station.page.now.html["menu"] and "bearing 037°" in station.page.now.html["menu"]
    assert station.script.asked == []


def test_home_is_set_where_it_was_clicked(station):
    station.press(click(4.0, 3.0), Point(ME, "home"))
    ((name, request),) = station.script.asked
    assert (name, request.home.position.x, request.home.position.y) == (UGV, pytest.approx(4.0), pytest.approx(3.0))


def test_an_aircraft_circles_where_it_is_sent_as_high_as_it_flies(station):
    station.press(Select(ME, UAV))
    station.go(50.0, 30.0)
    ((name, goal),) = station.script.asked
    assert (name, goal.position.x, goal.position.y) == (UAV, pytest.approx(50.0), pytest.approx(30.0))
    assert goal.position.z == pytest.approx(60.0, abs=3.0)


def test_a_menu_of_one_vehicle_does_not_send_another(station):
    station.press(click(4.0, 3.0), Select(ME, UAV), Point(ME, "go"))
    assert station.script.asked == []


def test_a_click_far_outside_is_refused_here(station):
    station.go(400.0, 3.0)
    assert station.script.asked == []
    assert "too far" in station.model.vehicles[UGV].order.reason


def test_a_vehicle_that_fell_silent_gets_no_orders(station):
    station.run(6.0, silent=True)
    station.page.clicks += [click(4.0, 3.0), Point(ME, "go")]
    station.run(0.1, silent=True)
    assert station.script.asked == []
    assert "no link" in station.model.vehicles[UGV].order.reason


def test_arming_wants_a_second_press(station):
    station.press(Command(ME, UGV, "disarm"))
    assert station.script.asked == []
    station.press(Command(ME, UGV, "disarm"))
    ((name, request),) = station.script.asked
    assert (name, request.arm, request.force) == (UGV, False, False)


@pytest.mark.parametrize("between", [[Select(ME, UAV), Select(ME, UGV)], [Command(ME, UAV, "disarm")]])
def test_a_second_press_counts_only_for_the_same_question(station, between):
    station.press(Command(ME, UGV, "disarm"), *between, Command(ME, UGV, "disarm"))
    assert station.script.asked == []


def test_a_second_press_must_come_soon(station):
    station.press(Command(ME, UGV, "disarm"))
    station.run(CONFIRM_WITHIN)
    station.press(Command(ME, UGV, "disarm"))
    assert station.script.asked == []


def test_modes_go_to_the_chosen_vehicle(station):
    station.press(Select(ME, UAV), Command(ME, UAV, "return"))
    ((name, request),) = station.script.asked
    assert (name, request.mode) == (UAV, Mode.MODE_RETURN)


def test_a_page_that_shows_what_is_old_does_nothing_risky(station):
    station.page.asleep = True
    station.run(OLD_AFTER + 0.2)
    station.press(Command(ME, UGV, "disarm"), Command(ME, UGV, "disarm"))
    assert station.script.asked == []
    assert "is 2 s old" in station.model.vehicles[UGV].order.reason
    station.press(BeginMap(ME, UGV, "hector"), BeginMap(ME, UGV, "hector"), RunClock(ME, "reset"), RunClock(ME, "reset"))
    assert station.script.asked == [] and "is 2 s old" in station.model.order.reason
    station.press(StopAll(ME))
    assert station.script.stops[-1].engaged
    station.press(Command(ME, UGV, "hold"))
    assert [type(m) for _, m in station.script.asked] == [ModeRequest]


def test_what_is_greyed_out_is_refused_whoever_asks_for_it(station):
    station.script.armed[UGV] = False
    station.run(0.4)
    assert station.page.now.greyed("Mission") and not station.page.now.greyed("Hold")
    station.press(Command(ME, UGV, "mission"))
    assert station.script.asked == []
    assert "disarmed: arm it first" in station.model.vehicles[UGV].order.reason


@pytest.mark.parametrize(
    "action", [Command(ME, UGV, "return"), Command(ME, UGV, "nonsense"), Select(ME, "nobody"), Layer(ME, "nothing", True)]
)
def test_what_a_page_cannot_ask_is_not_sent(station, action):
    layers = station.model.layers
    station.press(action)
    assert station.script.asked == []
    assert station.page.now.vehicle == UGV
    assert station.model.layers == layers


def test_stop_all_goes_out_at_once_and_holds_until_released(station):
    station.press(StopAll(ME), seconds=0.05)
    assert [(s.engaged, s.source) for s in station.script.stops] == [(True, "gcs")]
    station.run(1.0)
    assert station.model.stopped
    station.press(ReleaseStop(ME), seconds=0.2)
    assert [s.engaged for s in station.script.stops] == [True, False]
    assert not station.model.stopped


def test_another_source_may_release_our_stop_and_engage_its_own(station):
    station.press(StopAll(ME), seconds=0.5)
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
    station.press(ReleaseStop(ME), seconds=0.3)
    assert [(one.source, one.id) for one in station.script.stops[-1].releases] == [("launcher", engagement.id)]
    assert not station.model.stopped


def test_stop_all_needs_no_link(station):
    station.run(60.0, silent=True)
    station.page.clicks.append(StopAll(ME))
    station.run(0.05, silent=True)
    assert station.script.stops[-1].engaged


def test_an_order_that_nobody_answers_ends_as_refused(station):
    station.script.bus._servers.clear()
    station.script.bus.serve("uvf/*/srv/goal", lambda query: None)
    station.go(4.0, 3.0)
    assert station.model.vehicles[UGV].order.state == "sent"
    station.run(ANSWER_WITHIN + 0.1)
    assert station.model.vehicles[UGV].order.reason == "no answer"


def test_an_order_without_a_server_is_refused_with_the_reason(station):
    station.script.bus._servers.clear()
    station.press(Command(ME, UGV, "hold"))
    assert "nobody answers" in station.model.vehicles[UGV].order.reason


def test_requests_are_described_in_words():
    goal = GoalRequest()
    goal.position.x, goal.position.y = 1.04, -2.0
    assert describe(goal) == "go to (1.0, -2.0) m"
    assert describe(ModeRequest(mode=Mode.MODE_RETURN)) == "mode Return"
    assert [describe(ArmRequest(arm=a)) for a in (True, False)] == ["arm", "disarm"]
