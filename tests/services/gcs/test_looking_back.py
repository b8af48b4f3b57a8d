"""A page looks back while the run goes on: it shows what was, commands nothing, and others see the present."""

import numpy as np
import pytest

from services.gcs.actions.page import ClickGround, Command, FleetTable, Layer, OpenTab, Select, StopAll, TakeWheel
from services.gcs.actions.times import ExportMinute, PlayPast, PlayRate, ShowLive, ShowMoment, ShowPast, StepEvent
from tests.services.gcs.fakes import ME, OTHER, Station
from tests.services.gcs.scripted import UAV, UGV


@pytest.fixture
def station():
    station = Station()
    station.places = {}
    for n in range(400):
        station.run(0.05)
        station.places[n] = station.page.now.places[f"/vehicles/{UGV}"].position
    return station


def place(station, page=ME):
    return station.page.seen_by(page).own_places[f"/past/vehicles/{UGV}"].position


def moment(station):
    return station.model.sessions[ME].past


def test_it_shows_where_everybody_was(station):
    station.press(ShowMoment(ME, 10.0))
    at = round(10.0 / 0.05) - 1
    assert min(np.linalg.norm(place(station) - station.places[at + d]) for d in (-1, 0, 1)) < 1e-6
    assert np.linalg.norm(place(station) - station.places[399]) > 0.05
    assert f"/past/track/{UGV}/" in " ".join(station.page.now.own)


def test_the_present_is_hidden_there_and_only_there(station):
    station.join_other()
    station.press(ShowPast(ME, -5.0))
    assert "/vehicles" in station.page.now.hidden and "/vehicles" not in station.page.seen_by(OTHER).hidden
    assert not station.page.seen_by(OTHER).own_places
    station.press(Layer(ME, "Tracks", False))
    assert {"/track", "/past/track"} <= station.page.now.hidden


def test_it_says_so_and_offers_no_command(station):
    station.press(ShowPast(ME, -5.0))
    assert "PAST" in station.page.now.html["bar"] and "REC" not in station.page.now.html["bar"]
    assert "nothing is commanded" in station.page.now.html["commands"]
    assert "−0:05" in station.page.now.html["time"]


def test_the_table_shows_the_same_moment_as_the_cards(station):
    station.script.armed[UGV] = False
    station.press(FleetTable(ME, True), seconds=1.0)
    assert "DISARMED" in station.page.now.html["table"] or "disarmed" in station.page.now.html["table"]
    station.press(ShowPast(ME, -10.0), seconds=0.5)
    assert "disarmed" not in station.page.now.html["table"].lower()


@pytest.mark.parametrize("action", (Command(ME, UGV, "hold"), TakeWheel(ME, UGV), ClickGround(ME, (2.0, 2.0, 5.0), (0.0, 0.0, -1.0))))
def test_the_server_refuses_what_a_page_of_the_past_asks_for(station, action):
    station.press(ShowPast(ME, -5.0))
    before = len(station.script.asked)
    station.press(action, seconds=0.5)
    assert len(station.script.asked) == before
    assert station.model.sessions[ME].pointed is None and station.service._commander.by_hand.held_by(ME) == ""


def test_stop_all_works_in_the_past_too(station):
    station.press(ShowPast(ME, -5.0), StopAll(ME), seconds=0.3)
    assert station.model.stopped


def test_who_drives_by_hand_lets_go_when_he_looks_back(station):
    station.press(TakeWheel(ME, UGV), seconds=0.3)
    assert station.service._commander.by_hand.held_by(ME) == UGV
    station.press(ShowPast(ME, -5.0))
    assert station.service._commander.by_hand.held_by(ME) == ""


def test_it_stands_still_until_it_is_played_and_runs_into_the_present(station):
    station.press(ShowPast(ME, -10.0))
    then = moment(station).t
    station.run(1.0)
    assert moment(station).t == then
    station.press(PlayPast(ME, True), seconds=1.0)
    assert moment(station).t == pytest.approx(then + 1.0, abs=0.11)
    station.press(PlayRate(ME, "× 16"), seconds=1.5)
    assert moment(station) is None and "/past/vehicles" not in " ".join(station.page.now.own_places)


def test_going_back_and_forth_gives_the_same_picture(station):
    station.press(ShowMoment(ME, 8.0))
    first = place(station), station.page.now.html["fleet"]
    for t in (15.0, 3.0, 8.0):
        station.press(ShowMoment(ME, t), seconds=0.5)
    assert np.array_equal(place(station), first[0]) and station.page.now.html["fleet"] == first[1]


def test_there_is_no_time_before_the_first_and_none_after_the_last(station):
    station.press(ShowPast(ME, -1e6))
    assert moment(station).t == station.service._history.begin
    for nonsense in (1e9, float("nan"), float("inf")):
        station.press(ShowMoment(ME, nonsense))
        assert moment(station) is None


def test_events_are_steps(station):
    station.press(Command(ME, UGV, "hold"), seconds=1.0)
    at = station.service._history.ticks(1e6)[-1].t
    station.run(5.0)
    station.press(StepEvent(ME, -1))
    assert moment(station).t == pytest.approx(at, abs=0.01)
    station.press(StepEvent(ME, -1), StepEvent(ME, 1))
    assert moment(station).t == pytest.approx(at, abs=0.01)


def test_each_tab_and_each_vehicle_can_be_looked_at(station):
    station.press(ShowPast(ME, -5.0))
    for vehicle in (UAV, UGV):
        for tab in ("fly", "drive", "plan", "plot", "graph", "log", "run", "help"):
            station.press(Select(ME, vehicle), OpenTab(ME, tab))
            assert station.page.now.vehicle == vehicle
    station.press(ShowLive(ME))
    assert "nothing is commanded" not in station.page.now.html["commands"]


def test_the_minute_around_the_moment_is_kept(station):
    station.press(ExportMinute(ME, "mcap"))
    station.press(ShowPast(ME, -45.0))
    station.press(ShowMoment(ME, 1.0), ExportMinute(ME, "html"))
    now, (live, past) = station.t, station.exporter.begun
    assert live == ("mcap", pytest.approx(0.0, abs=0.1), 60.0)
    assert past == ("html", pytest.approx(0.0 if now < 31 else now - 31.0, abs=0.2), 60.0)
