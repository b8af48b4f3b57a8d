"""Two people at one ground station: what one chooses is his own, and a command goes to the vehicle that he was shown."""

import pytest

from schemas.messages import ArmRequest, GoalRequest, Mode, ModeRequest
from services.gcs.actions.page import (
    Command,
    FleetTable,
    Hello,
    Join,
    Layer,
    Leave,
    Looking,
    OpenTab,
    Select,
    ShowCamera,
    Steer,
    TakeWheel,
)
from services.gcs.orders.by_hand import PATIENCE
from services.gcs.state.control import ANSWER_WITHIN
from services.gcs.state.session import ROOTS, SHED_AFTER
from tests.services.gcs.fakes import ME, OPERATORS, OTHER, Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, with_eyes


@pytest.fixture
def station():
    """One shows the rover, the other one the aircraft."""
    station = Station(site=with_eyes(demo_site()))
    station.run(0.5)
    station.join_other()
    station.press(Select(OTHER, UAV), OpenTab(OTHER, "fly"), OpenTab(ME, "drive"), seconds=0.4)
    return station


def asked(station, kind):
    return [name for name, message in station.script.asked if isinstance(message, kind)]


def test_each_sees_its_own_vehicle_at_once(station):
    mine, theirs = (station.page.seen_by(page) for page in (ME, OTHER))
    assert (mine.vehicle, theirs.vehicle) == (UGV, UAV)
    assert "gcs-drive" in mine.html["instrument"] and "gcs-pfd" in theirs.html["instrument"]
    assert f"data-name='{UGV}'" in mine.html["bar"] and f"data-name='{UAV}'" in theirs.html["bar"]
    assert "throttle" in theirs.html["facts"] and "throttle" not in mine.html["facts"]
    assert "Return" in theirs.words and "Return" not in mine.words


def test_no_word_about_the_one_stands_under_the_name_of_the_other(station):
    for chosen in (UGV, UAV, UGV):
        station.press(Select(OTHER, chosen), seconds=0.05)
        shown = station.page.seen_by(OTHER)
        assert ("gcs-pfd" in shown.html["instrument"], "throttle" in shown.html["facts"]) == (chosen == UAV, chosen == UAV)


def test_the_same_button_means_the_vehicle_of_him_who_presses_it(station):
    station.push("Hold", seconds=0.2)
    assert asked(station, ModeRequest) == [UGV]
    station.push("Hold", OTHER)
    assert asked(station, ModeRequest) == [UGV, UAV]


def test_a_button_pressed_as_the_vehicle_changes_means_the_one_it_was_shown_for(station):
    hold = station.page.now.words["Hold"]
    station.press(Select(ME, UAV), Command(ME, *hold[1:]))
    assert asked(station, ModeRequest) == [UGV]
    assert UGV not in station.page.now.html["commands"]


def tracks(station):
    return [name for name in station.page.now.nodes if name.startswith("/track/")]


def test_each_hides_layers_for_itself_and_what_nobody_shows_is_not_drawn(station):
    station.press(Layer(OTHER, "Tracks", False))
    assert "/track" in station.page.seen_by(OTHER).hidden and "/track" not in station.page.seen_by(ME).hidden
    assert tracks(station)
    station.press(Layer(ME, "Tracks", False))
    assert not tracks(station)
    station.press(Leave(OTHER))
    station.join_other()
    assert tracks(station) and "/track" in station.page.seen_by(ME).hidden and "/track" not in station.page.seen_by(OTHER).hidden


def test_all_that_is_drawn_of_a_vehicle_but_itself_hangs_below_a_layer(station):
    roots = [root + "/" for roots in ROOTS.values() for root in roots]
    station.press(*(Layer(ME, name, True) for name in ROOTS))
    outside = {name.split("/")[1] for name in station.page.now.nodes if not name.startswith(tuple(roots))}
    assert outside == {"world", "vehicles"}


def test_a_click_on_the_floor_sends_the_vehicle_of_him_who_clicks(station):
    station.press(Select(OTHER, UGV), Select(ME, UAV))
    station.go(4.0, 3.0, OTHER)
    assert asked(station, GoalRequest) == [UGV]
    assert station.model.vehicles[UAV].order is None


def test_nobody_confirms_what_another_one_has_asked_for(station):
    station.press(Select(OTHER, UGV), Command(ME, UGV, "disarm"), Command(OTHER, UGV, "disarm"))
    assert asked(station, ArmRequest) == []
    assert all(f"Confirm: disarm {UGV}" in station.page.seen_by(page).words for page in (ME, OTHER))
    station.press(Command(OTHER, UGV, "disarm"))
    assert asked(station, ArmRequest) == [UGV]


def test_cameras_are_chosen_and_looked_at_by_each_alone(station):
    station.model.vehicles[UAV].chase = station.model.vehicles[UAV].gimbal = None
    station.press(Select(ME, UAV), ShowCamera(ME, "chase"), Looking(ME), seconds=0.6)
    mine, theirs = (station.page.seen_by(page).html["cameras"] for page in (ME, OTHER))
    assert "aria-pressed='true' >chase" in mine and "aria-pressed='true' >gimbal" in theirs
    assert "type='range'" not in mine and "type='range'" in theirs


def test_one_drives_while_the_other_one_looks_around(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0))
    assert station.script.drives[-1][0] > 0
    station.press(
        Select(OTHER, UGV), OpenTab(OTHER, "drive"), Command(ME, UAV, "hold"), Steer(ME, 1.0, 0.0, 0.0), Steer(OTHER, -1.0, 0.0, 0.0)
    )
    assert station.script.drives[-1][0] > 0
    assert "data-driver='mine'" in station.page.seen_by(ME).html["wheel"]
    assert "driven from another page" in station.page.seen_by(OTHER).html["wheel"]


def test_who_has_lost_control_drives_no_longer(station):
    station.press(Select(OTHER, UGV), TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0))
    assert station.script.drives[-1][0] > 0
    station.model.control.holders[UGV] = OPERATORS[OTHER]
    station.press(Steer(ME, 1.0, 0.0, 0.0), seconds=0.2)
    assert station.script.drives[-1] == (0.0, 0.0)
    assert station.service._commander.by_hand.held_by(ME) == ""


def control(station):
    return station.model.control.holders


def test_the_first_command_takes_control_and_another_operators_is_refused(station):
    station.press(Select(OTHER, UGV))
    station.push("Hold")
    assert control(station) == {UGV: OPERATORS[ME]}
    station.push("Mission", OTHER)
    assert asked(station, ModeRequest) == [UGV]
    assert "operator aaaa controls burger" in station.model.vehicles[UGV].order.reason
    station.run(0.4)
    assert "you control burger" in station.page.seen_by(ME).html["bar"]
    assert "operator aaaa controls burger" in station.page.seen_by(OTHER).html["bar"]


def test_control_is_asked_for_and_handed_over(station):
    station.press(Select(OTHER, UGV))
    station.push("Hold", seconds=0.4)
    station.push("Ask for control", OTHER, seconds=0.4)
    assert control(station) == {UGV: OPERATORS[ME]}
    station.push("Hand over", seconds=0.4)
    assert control(station) == {UGV: OPERATORS[OTHER]}
    station.push("Mission", OTHER)
    assert asked(station, ModeRequest) == [UGV, UGV]
    said = [line.text for line in station.model.log if line.of_operator]
    assert "operator bbbb asks for control" in said and "operator bbbb controls it from now on" in said


def test_control_may_be_kept(station):
    station.press(Select(OTHER, UGV))
    station.push("Hold", seconds=0.4)
    station.push("Ask for control", OTHER, seconds=0.4)
    station.push("Keep", seconds=ANSWER_WITHIN + 0.5)
    assert control(station) == {UGV: OPERATORS[ME]}


def test_who_does_not_answer_gives_control_away(station):
    station.press(Select(OTHER, UGV))
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0), seconds=0.4)
    station.push("Ask for control", OTHER, seconds=ANSWER_WITHIN + 0.2)
    assert control(station) == {UGV: OPERATORS[OTHER]}
    assert station.service._commander.by_hand.holder(UGV) is None


def test_whose_page_is_gone_controls_nothing_any_more(station):
    station.push("Hold")
    station.press(Select(OTHER, UGV), Leave(ME))
    station.push("Mission", OTHER)
    assert control(station) == {UGV: OPERATORS[OTHER]}
    assert asked(station, ModeRequest) == [UGV, UGV]


def test_anybody_stops_all(station):
    station.push("Hold")
    station.push("■ STOP ALL", OTHER)
    assert station.script.stops[-1].engaged
    assert "by operator bbbb" in "".join(line.text for line in station.model.log)


def test_whoever_goes_lets_go_at_once_and_is_forgotten(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0))
    station.press(Leave(ME), seconds=0.05)
    assert station.script.drives[-1] == (0.0, 0.0)
    assert set(station.page.pictures[-1].panels) == {OTHER} == set(station.model.sessions)
    station.press(Steer(ME, 1.0, 0.0, 0.0), TakeWheel(ME, UGV), Select(ME, UAV), seconds=PATIENCE)
    assert all(drive == (0.0, 0.0) for drive in station.script.drives[-5:])
    assert station.service._commander.by_hand.holder(UGV) is None


def test_another_ones_leaving_does_not_stop_the_driver(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0))
    station.press(Leave(OTHER), Steer(ME, 1.0, 0.0, 0.0))
    assert station.script.drives[-1][0] > 0


def test_nobody_drives_what_he_does_not_see(station):
    station.press(Select(ME, UAV), TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0, 0.0))
    assert station.script.drives == [] and Mode.MODE_MANUAL not in station.script.mode.values()


def test_a_browser_that_falls_behind_keeps_its_picture_and_gets_its_words(station):
    station.join_other()
    station.press(Looking(ME), OpenTab(ME, "drive"), Looking(OTHER), OpenTab(OTHER, "drive"), seconds=1.0)
    station.page.asleep = True
    station.run(SHED_AFTER + 0.5)
    before = station.page.now
    station.run(2.0)
    assert station.page.now.html["picture"] == before.html["picture"]
    assert station.page.now.html["instrument"] != before.html["instrument"]


def test_the_fleet_is_a_table_for_who_asks_for_it(station):
    station.join_other()
    station.press(FleetTable(ME, True), seconds=0.5)
    table = station.page.now.html["table"]
    assert "<caption>All vehicles</caption>" in table and all(f"<th scope='row'>{name}</th>" in table for name in (UGV, UAV))
    assert not station.page.seen_by(OTHER).html["table"]
    station.press(FleetTable(ME, False), seconds=0.5)
    assert not station.page.now.html["table"]


def test_while_nobody_looks_the_scene_is_drawn_once_a_second_and_at_once_for_who_comes(station):
    station.press(Leave(ME), Leave(OTHER), seconds=0.05)
    before = len(station.page.pictures)
    station.run(3.0)
    assert len(station.page.pictures) - before == 3
    station.run(0.5)
    station.press(Join(ME), Hello(ME, OPERATORS[ME], ""), seconds=0.05)
    assert station.page.pictures[-1].panels.keys() == {ME}
    before = len(station.page.pictures)
    station.run(1.0)
    assert len(station.page.pictures) - before == 20
