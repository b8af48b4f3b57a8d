"""Two people at one ground station: what one chooses is his own, and a command goes to the vehicle that he was shown."""

import pytest

from schemas.messages import ArmRequest, GoalRequest, Mode, ModeRequest
from services.gcs.actions import Arm, ClickGround, Join, Layer, Leave, Looking, Select, SetMode, ShowCamera, Steer, TakeWheel
from services.gcs.by_hand import PATIENCE
from services.gcs.state.session import ROOTS
from tests.services.gcs.fakes import ME, OTHER, Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, with_eyes


@pytest.fixture
def station():
    """One shows the rover, the other one the aircraft."""
    station = Station(site=with_eyes(demo_site()))
    station.run(0.5)
    station.press(Join(OTHER), Select(OTHER, UAV))
    return station


def button(station, page, label):
    return next(b for b in station.page.seen_by(page).buttons if b.label == label)


def asked(station, kind):
    return [name for name, message in station.script.asked if isinstance(message, kind)]


def test_each_sees_its_own_vehicle_at_once(station):
    mine, theirs = (station.page.seen_by(page) for page in (ME, OTHER))
    assert (mine.vehicle, theirs.vehicle) == (UGV, UAV)
    assert "gcs-drive" in mine.html["instrument"] and "gcs-pfd" in theirs.html["instrument"]
    assert f"data-name='{UGV}'" in mine.html["bar"] and f"data-name='{UAV}'" in theirs.html["bar"]
    assert "throttle" in theirs.html["facts"] and "throttle" not in mine.html["facts"]
    assert {b.label for b in theirs.buttons} - {b.label for b in mine.buttons} == {"Return", f"Disarm {UAV}"}


def test_no_word_about_the_one_stands_under_the_name_of_the_other(station):
    for chosen in (UGV, UAV, UGV):
        station.press(Select(OTHER, chosen), seconds=0.05)
        shown = station.page.seen_by(OTHER)
        assert ("gcs-pfd" in shown.html["instrument"], "throttle" in shown.html["facts"]) == (chosen == UAV, chosen == UAV)


def test_the_same_button_means_the_vehicle_of_him_who_presses_it(station):
    station.press(button(station, ME, "Hold").action, seconds=0.2)
    assert asked(station, ModeRequest) == [UGV]
    station.press(button(station, OTHER, "Hold").action)
    assert asked(station, ModeRequest) == [UGV, UAV]


def test_a_button_pressed_as_the_vehicle_changes_means_the_one_it_was_shown_for(station):
    hold = button(station, ME, "Hold").action
    station.press(Select(ME, UAV), hold)
    assert asked(station, ModeRequest) == [UGV]
    assert not {b.key for b in station.page.seen_by(ME).buttons if UGV in b.key}


def tracks(station):
    return [name for name in station.page.now.nodes if name.startswith("/track/")]


def test_each_hides_layers_for_itself_and_what_nobody_shows_is_not_drawn(station):
    station.press(Layer(OTHER, "Tracks", False))
    assert "/track" in station.page.seen_by(OTHER).hidden and "/track" not in station.page.seen_by(ME).hidden
    assert tracks(station)
    station.press(Layer(ME, "Tracks", False))
    assert not tracks(station)
    station.press(Leave(OTHER), Join(OTHER))
    assert tracks(station) and "/track" in station.page.seen_by(ME).hidden and "/track" not in station.page.seen_by(OTHER).hidden


def test_all_that_is_drawn_of_a_vehicle_but_itself_hangs_below_a_layer(station):
    roots = [root + "/" for roots in ROOTS.values() for root in roots]
    station.press(*(Layer(ME, name, True) for name in ROOTS))
    outside = {name.split("/")[1] for name in station.page.now.nodes if not name.startswith(tuple(roots))}
    assert outside == {"world", "vehicles"}


def test_a_click_on_the_floor_sends_the_vehicle_of_him_who_clicks(station):
    station.press(Select(OTHER, UGV), Select(ME, UAV), ClickGround(UGV, (4.0, 3.0, 9.0), (0.0, 0.0, -1.0)))
    assert asked(station, GoalRequest) == [UGV]
    assert station.model.vehicles[UAV].order is None


def test_nobody_confirms_what_another_one_has_asked_for(station):
    station.press(Select(OTHER, UGV), Arm(ME, UGV, False), Arm(OTHER, UGV, False))
    assert asked(station, ArmRequest) == []
    assert all(button(station, page, f"Confirm: disarm {UGV}") for page in (ME, OTHER))
    station.press(Arm(OTHER, UGV, False))
    assert asked(station, ArmRequest) == [UGV]


def test_cameras_are_chosen_and_looked_at_by_each_alone(station):
    station.model.vehicles[UAV].chase = station.model.vehicles[UAV].gimbal = None
    station.press(Select(ME, UAV), ShowCamera(ME, "chase"), Looking(ME), seconds=0.4)
    assert "data-gcs='camera:chase' aria-pressed='true'" in station.page.seen_by(ME).html["cameras"]
    assert "data-gcs='camera:gimbal' aria-pressed='true'" in station.page.seen_by(OTHER).html["cameras"]
    assert station.page.seen_by(ME).gimbal is None and station.page.seen_by(OTHER).gimbal.vehicle == UAV


def test_one_drives_while_the_other_one_looks_around(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0))
    assert station.script.drives[-1][0] > 0
    station.press(Select(OTHER, UGV), SetMode(UAV, "Hold"), Steer(ME, 1.0, 0.0), Steer(OTHER, -1.0, 0.0))
    assert station.script.drives[-1][0] > 0
    assert "data-driver='mine'" in station.page.seen_by(ME).html["wheel"]
    assert "driven from another page" in station.page.seen_by(OTHER).html["wheel"]


def test_whoever_goes_lets_go_at_once_and_is_forgotten(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0))
    station.press(Leave(ME), seconds=0.05)
    assert station.script.drives[-1] == (0.0, 0.0)
    assert set(station.page.pictures[-1].panels) == {OTHER} == set(station.model.sessions)
    station.press(Steer(ME, 1.0, 0.0), TakeWheel(ME, UGV), Select(ME, UAV), seconds=PATIENCE)
    assert all(drive == (0.0, 0.0) for drive in station.script.drives[-5:])
    assert station.service._commander.by_hand.holder(UGV) is None


def test_another_ones_leaving_does_not_stop_the_driver(station):
    station.press(TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0))
    station.press(Leave(OTHER), Steer(ME, 1.0, 0.0))
    assert station.script.drives[-1][0] > 0


def test_nobody_drives_what_he_does_not_see(station):
    station.press(Select(ME, UAV), TakeWheel(ME, UGV), Steer(ME, 1.0, 0.0))
    assert station.script.drives == [] and Mode.MODE_MANUAL not in station.script.mode.values()
