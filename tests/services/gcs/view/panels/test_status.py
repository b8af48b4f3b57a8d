"""What wants attention stands over the scene as long as it lasts, and no longer."""

import pytest

from schemas import topics
from schemas.messages import Clock, Event, ExternalVehicle, NavStatus, Process, Processes, StopCommand, Timestamp, VehicleStatus
from services.gcs.actions.page import OpenTab, ReleaseStop, StopAll
from services.gcs.state.event_log import ALARMED_FOR
from services.gcs.view.panels.status import ALERT_LENGTH, ALERTS_SHOWN, alerts
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV


@pytest.fixture
def station():
    station = Station()
    station.run(1.0)
    return station


def told(station):
    return [text for _, text, _ in alerts(station.model, station.t)]


def test_a_normal_run_wants_no_attention(station):
    assert told(station) == []


def test_a_held_clock_is_told_until_it_runs_again(station):
    warning = Event(
        text="simulation clock held at 1.00 s: waiting for slam", severity=Event.WARNING, source="conductor", timestamp=Timestamp(seconds=1)
    )
    station.script.put("sys", topics.SYSTEM_EVENTS.by("conductor"), warning, 1.0)
    station.script.put("sys", topics.CLOCK, Clock(t_ns=10**9, waiting_for="slam"), 1.0)
    station.run(0.3, silent=True)
    assert told(station) == ["⚠ simulation clock held: waiting for slam"]
    station.run(0.3)
    station.press(OpenTab(ME, "log"), seconds=0.8)
    assert told(station) == [] and "clock held" not in station.page.now.html["alerts"]
    assert "clock held at 1.00 s" in station.page.now.html["log"]


def test_a_grave_event_is_the_alarm_for_a_while_and_leads_to_its_vehicle(station):
    station.run(0.3)
    assert "no alarm" in station.page.now.html["bar"]
    station.script.say(UAV, "<b>engine</b> fails", Event.ERROR, t=station.t)
    station.run(0.5)
    bar = station.page.now.html["bar"]
    assert f"✖ {UAV}: &lt;b&gt;engine&lt;/b&gt; fails" in bar and f"data-name='{UAV}'" in bar
    station.run(ALARMED_FOR)
    assert "no alarm" in station.page.now.html["bar"]


def test_the_first_start_is_not_told_as_a_fault(station):
    station.script.put("sys", topics.CLOCK, Clock(t_ns=0, waiting_for="slam"), 1.0)
    station.run(0.3, silent=True)
    assert told(station) == ["starting (the first start compiles, about a minute): waiting for slam"]


def test_a_process_is_told_of_until_it_runs_again(station):
    for state, expected in (
        (Process.RESTARTING, ["⚠ slam is started again: exit code -9"]),
        (Process.FAILED, ["✖ slam has failed for good: exit code -9"]),
        (Process.RUNNING, []),
    ):
        process = Process(name="slam", state=state, reason="exit code -9")
        station.script.put("sys", topics.PROCESSES.by("launcher"), Processes(processes=[process]), station.t)
        station.run(0.2)
        assert told(station) == expected


def test_a_blocked_vehicle_is_told_of_with_the_reason(station):
    station.model.vehicles[UGV].nav_status = NavStatus(state=NavStatus.BLOCKED, reason="no way there")
    assert told(station) == [f"⚠ {UGV} is blocked: no way there"]


def test_a_lost_vehicle_is_named(station):
    station.run(7.0, silent=True)
    assert [text.split(":")[0] for text in told(station)] == [f"✖ {UGV}", f"✖ {UAV}"]


def test_stop_all_says_since_when_by_whom_and_who_heeds_it(station):
    assert "Release STOP" not in station.page.now.html["stop"]
    station.press(StopAll(ME), seconds=0.5)
    stop = station.page.now.html["stop"]
    assert "by this page (pressed on the page), 00:00:01" in stop and f"heeded by {UGV}, {UAV}" in stop and "Release STOP" in stop
    station.press(ReleaseStop(ME), seconds=0.5)
    assert "Release STOP" not in station.page.now.html["stop"] and "STOP ALL" in station.page.now.html["stop"]


def test_a_stop_of_somebody_else_is_theirs_and_stands_in_the_log(station):
    command = StopCommand(engaged=True, source="launcher", reason="slam was given up", timestamp=Timestamp(seconds=1))
    station.script.put("sys", topics.STOP.by("launcher"), command, 1.0)
    station.press(OpenTab(ME, "log"), seconds=0.8)
    assert told(station) == ["■ STOP ALL ENGAGED by the launcher (slam was given up), 00:00:01"]
    assert f"not confirmed by {UGV}, {UAV}" in station.page.now.html["stop"]
    assert "STOP ALL engaged by launcher (slam was given up)" in station.page.now.html["log"]


def test_many_failed_processes_and_lost_guests_hide_no_vehicle_of_the_mission(station):
    failed = [Process(name=f"a{i}", state=Process.FAILED, reason="you must land now " * 100) for i in range(200)]
    station.model.processes.hear(station.t, [Processes(processes=failed)])
    station.model.hear_external_vehicles(station.t, {f"ghost{i}": ExternalVehicle(model="burger") for i in range(50)})
    station.model.hear(station.t - 100.0, "status", {f"ghost{i}": VehicleStatus() for i in range(2)})
    station.model.vehicles[UGV].nav_status = NavStatus(state=NavStatus.BLOCKED, reason="no way there " * 100)
    shown = told(station)
    assert shown[0].startswith(f"⚠ {UGV} is blocked: no way there") and shown[0].endswith("…")
    assert [line.split()[1] for line in shown[1:3]] == ["ghost0:", "ghost1:"]
    assert len(shown) == ALERTS_SHOWN + 1 and shown[-1] == "and 198 more"
    assert max(map(len, shown)) == ALERT_LENGTH
    assert station.page.now.html["alerts"].count("g-alert") <= ALERTS_SHOWN + 1
    station.model.vehicles[UAV].heard_at = {"status": -100.0}
    assert told(station)[0].startswith(f"✖ {UAV}: LINK LOST"), "the gravest first"
