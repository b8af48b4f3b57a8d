"""The simulation's clock and the start of other missions, asked for on the page."""

import json

import pytest

from schemas import topics
from schemas.messages import Clock, ClockRequest, LaunchRequest, Reply
from services.gcs.actions.page import LaunchMission, OpenTab, RunClock, SetRate
from services.gcs.page.words import action_in
from tests.services.gcs.fakes import ME, Station


@pytest.fixture
def station():
    """A conductor and a launcher that do what they are asked."""
    station = Station()
    station.heard = []
    for request in (topics.CLOCK_REQUEST, topics.LAUNCH):
        station.script.bus.serve(request.at("sys"), lambda query, r=request: answer(station, r, query))
    station.run(0.5)
    station.press(OpenTab(ME, "run"), seconds=0.3)
    return station


def answer(station, request, query):
    message = request.message.FromString(query.payload)
    station.heard.append(message)
    known = not isinstance(message, LaunchRequest) or message.mission == "circuit"
    reply = Reply(accepted=known, reason="" if known else "no such mission")
    query.answer(reply.SerializeToString(deterministic=True), query.stamp_ns)


def test_the_clock_is_paused_resumed_and_stepped(station):
    station.push("❚❚ Pause")
    station.script.put("sys", topics.CLOCK, Clock(t_ns=10**9, state=Clock.PAUSED, tick=99), 1.0)
    station.run(0.4, silent=True)
    assert "paused at 00:00:01" in station.page.now.html["run"]
    station.page.clicks += [RunClock(ME, "step"), RunClock(ME, "resume")]
    station.run(0.3, silent=True)
    assert [m.action for m in station.heard] == [ClockRequest.PAUSE, ClockRequest.STEP, ClockRequest.RESUME]
    assert "resume the simulation – accepted" in station.page.now.html["run"]


def test_the_rate_is_set(station):
    station.push("×2")
    assert [(m.action, m.rate) for m in station.heard] == [(ClockRequest.SET_RATE, 2.0)]
    station.press(SetRate(ME, 0.0))
    assert station.heard[-1].rate == 0.0


def test_a_reset_wants_a_second_click(station):
    station.push("↺ Reset", seconds=0.3)
    assert station.heard == []
    station.push("Confirm: start afresh")
    assert [m.action for m in station.heard] == [ClockRequest.RESET]


def test_the_missions_of_the_project_are_listed_and_started_with_two_clicks(station):
    panel = station.page.now.html["run"]
    assert "The burger explores the house on its own" in panel and "runs now" in panel
    station.push("Start circuit", seconds=0.3)
    assert station.heard == []
    station.push("Confirm: end this run, start circuit", seconds=0.3)
    assert [m.mission for m in station.heard] == ["circuit"]
    assert "start mission circuit – accepted" in station.page.now.html["run"]


def test_a_mission_that_is_not_there_is_refused_with_the_reason(station):
    station.press(LaunchMission(ME, "../etc"), LaunchMission(ME, "../etc"), seconds=0.4)
    assert "refused: no such mission" in station.page.now.html["run"]


def test_without_a_launcher_the_request_says_so():
    station = Station()
    station.run(0.5)
    station.press(OpenTab(ME, "run"), LaunchMission(ME, "circuit"), LaunchMission(ME, "circuit"), seconds=0.5)
    assert "nobody answers" in station.page.now.html["run"]


def wind(station, direction, speed):
    station.script.bus.serve(topics.WIND.at("sys"), lambda query: answer(station, topics.WIND, query))
    station.press(action_in(json.dumps([1, "wind", {"direction": direction, "speed": speed}]), ME), seconds=0.4)


def test_wind_comes_from_where_it_is_said_to(station):
    wind(station, "270", "5.5")
    ((request,)) = station.heard
    assert (request.velocity.x, request.velocity.y) == pytest.approx((5.5, 0.0))
    assert "wind of 5.5 m/s from 270° – accepted" in station.page.now.html["run"]


@pytest.mark.parametrize(("direction", "speed"), (("north", "3"), ("nan", "3"), ("10", "inf"), ("10", "")))
def test_wind_of_no_numbers_is_refused(station, direction, speed):
    wind(station, direction, speed)
    assert station.heard == [] and "refused" in station.page.now.html["run"]
