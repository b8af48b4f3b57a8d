"""The tables of the log and of the processes."""

import re

import pytest

from schemas import topics
from schemas.messages import Event, Health, Process, Processes, Refusal
from services.gcs.actions.page import OpenTab
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV


@pytest.fixture
def station():
    station = Station()
    station.run(0.5)
    station.press(OpenTab(ME, "graph"), seconds=0.1)
    return station


def rows(html):
    """The words of each row of a table."""
    return [re.sub(r"<[^>]+>", " ", row).split() for row in re.findall(r"<tr[^>]*>(.*?)</tr>", html)]


def report(station, t, cpu, **more):
    station.script.put("sys", topics.HEALTH.by("slam"), Health(service="slam", pid=7, cpu_time=cpu, **more), t)
    station.run(1.0)


def test_a_process_stands_in_one_row_with_its_figures(station):
    listed = [Process(name="slam", state=Process.RUNNING, restarts=2)]
    station.script.put("sys", topics.PROCESSES.by("launcher"), Processes(processes=listed), 0.5)
    report(station, 0.5, 3.0, steps=1000, late=4)
    report(station, 1.5, 3.25, steps=1100, late=11, worst_lateness=0.0731, gaps={"a": 3, "b": 1})
    _, slam, together = rows(station.page.now.html["processes"])
    assert slam == ["slam", "running", "2", "25", "1.0", "73", "4"]
    assert together == ["together", "25"]


def test_a_process_that_nobody_supervises_and_one_that_falls_silent_are_told(station):
    report(station, 0.5, 3.0)
    assert rows(station.page.now.html["processes"])[1][:4] == ["slam", "by", "hand", "–"]
    station.run(4.0)
    assert rows(station.page.now.html["processes"])[1][1:4] == ["silent", "5", "s"]


def test_what_a_running_process_waits_for_stands_under_it(station):
    listed = [Process(name="slam", state=Process.RUNNING)]
    station.script.put("sys", topics.PROCESSES.by("launcher"), Processes(processes=listed), 0.5)
    report(station, 0.5, 3.0, missing=["slam:scan"])
    assert rows(station.page.now.html["processes"])[2] == ["waits", "for", "slam:scan"]


def test_what_the_operator_did_stays_on_top_of_any_number_of_events(station):
    station.press(OpenTab(ME, "log"))
    station.push("Hold")
    for i in range(300):
        station.script.say(UAV, f"mission item {i} reached", Event.INFO, t=float(i))
        station.run(0.05)
    log = station.page.now.html["log"]
    assert log.index("mode Hold: accepted") < log.index("mission item")


def test_each_event_bears_the_class_that_the_page_filters_by(station):
    for severity in (Event.INFO, Event.NOTICE, Event.ERROR):
        station.script.say(UAV, "x", severity, t=1.0)
    station.press(OpenTab(ME, "log"), seconds=0.8)
    assert re.findall(r"g-k-(\w+)", station.page.now.html["log"]) == ["warning", "notice", "routine"]


def test_what_a_process_has_not_taken_stands_below_by_key_with_the_reason(station):
    assert "g-refusals" not in station.page.now.html["processes"]
    report(station, 0.5, 3.0, refusals=[Refusal(key="uvf/<b>/scan", count=12, why="9 bytes")])
    html = station.page.now.html["processes"]
    assert rows(html)[-1] == ["slam", "uvf/&lt;b&gt;/scan", "12", "9", "bytes"]
