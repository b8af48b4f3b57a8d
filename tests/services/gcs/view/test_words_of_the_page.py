"""The page's words are true, complete and safe."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Clock, Event, NavState, Process, Processes, Vector3
from services.gcs.actions.page import OpenTab, ReleaseStop, Select, StopAll
from services.gcs.view.panels import status
from services.gcs.view.panels.vehicle import facts
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.maths.rotations import from_euler
from uvf.runtime.messages.convert import quaternion

EVIL = "<img src=x onerror=alert(1)>"


@pytest.fixture
def station():
    station = Station()
    station.run(1.0)
    return station


def all_html(station):
    return "".join(station.page.now.html.values())


def test_the_bar_tells_link_time_and_vehicles(station):
    bar = station.page.now.html["bar"]
    assert "● LIVE" in bar and "2 of 2 vehicles" in bar
    assert status.clock_text(3723.9) == "01:02:03"


def test_silence_is_shown_as_stale_then_as_lost(station):
    station.run(3.0, silent=True)
    assert "STALE" in station.page.now.html["bar"] and "0 of 2 vehicles" in station.page.now.html["bar"]
    station.run(5.0, silent=True)
    assert "LINK LOST" in station.page.now.html["bar"] and "LINK LOST" in station.page.now.html["fleet"]


def test_a_paused_clock_is_not_a_lost_link(station):
    for i in range(10):
        station.script.put("sys", topics.CLOCK, Clock(t_ns=10**9, state=Clock.PAUSED, tick=i), 1.0)
        station.run(0.5, silent=True)
    assert "● PAUSED" in station.page.now.html["bar"]


def test_the_one_who_is_waited_for_is_named(station):
    station.script.put("sys", topics.CLOCK, Clock(t_ns=10**9, waiting_for="sim_ground"), 1.0)
    station.run(0.5, silent=True)
    assert "waiting for sim_ground" in station.page.now.html["alerts"] and "waiting for sim_ground" in station.page.now.html["bar"]


def test_stop_all_is_shown_until_released(station):
    station.press(StopAll(ME), seconds=0.8)
    assert "STOP ALL ENGAGED" in station.page.now.html["alerts"] and "■ STOPPED" in station.page.now.html["fleet"]
    station.press(ReleaseStop(ME), seconds=0.5)
    assert "STOP ALL ENGAGED" not in station.page.now.html["alerts"]


def test_a_warning_stands_in_the_bar_and_later_only_in_the_log(station):
    station.script.say(UGV, "wheel slip", Event.WARNING, t=1.0)
    station.run(0.8)
    assert "wheel slip" in station.page.now.html["notices"]
    station.press(OpenTab(ME, "log"), seconds=16.0)
    assert "wheel slip" not in station.page.now.html["notices"]
    assert "wheel slip" in station.page.now.html["log"]


def test_cards_show_what_matters_for_each_kind(station):
    fleet = station.page.now.html["fleet"]
    for word in ("0.21 m/s", "explore", "mapped floor", "24.3 m/s", "1 of 4", "▶ MISSION", "Select burger", "Select milvus"):
        assert word in fleet
    assert fleet.count("g-chosen") == 1


def test_a_card_says_disarmed_before_its_mode(station):
    station.script.armed[UAV] = False
    station.run(0.8)
    assert "■ DISARMED" in station.page.now.html["fleet"]


def test_the_instrument_is_that_of_the_chosen_vehicle(station):
    assert "gcs-drive" in station.page.now.html["instrument"]
    station.press(Select(ME, UAV))
    assert "gcs-pfd" in station.page.now.html["instrument"]


def test_attitude_comes_out_of_enu_and_flu_with_the_pilots_signs(station):
    nose_up_right_wing_down_to_north = from_euler(np.radians(20), np.radians(-5), np.radians(90))
    vehicle = station.model.vehicles[UAV]
    vehicle.nav = NavState(orientation=quaternion(nose_up_right_wing_down_to_north), airspeed=22.0, position=Vector3(z=61.0))
    assert "roll 20 deg, pitch 5 deg, heading 000, 22.0 m/s, 61 m" in facts.instrument(vehicle)


def test_crosswind_shows_as_an_angle_between_nose_and_course(station):
    vehicle = station.model.vehicles[UAV]
    east = quaternion(from_euler(0, 0, 0))
    vehicle.nav = NavState(orientation=east, velocity=Vector3(x=20, y=-20), wind=Vector3(y=-20))
    assert "<td>course − heading</td><td>+45°</td>" in facts.facts(vehicle, 0.0)


def test_the_last_order_is_shown_with_its_fate(station):
    station.press(OpenTab(ME, "log"))
    station.go(4.0, 3.0)
    station.run(0.8)
    assert "✓ go to (4.0, 3.0) m – accepted" in station.page.now.html["commands"]
    assert "go to (4.0, 3.0) m: accepted" in station.page.now.html["log"]


def test_a_refused_order_is_shown_escaped():
    station = Station(accept=False)
    station.run(0.5)
    station.go(4.0, 3.0)
    station.run(0.8)
    assert "refused: the &lt;goal&gt; lies inside a wall" in station.page.now.html["commands"]
    assert "refused: the &lt;goal&gt; lies inside a wall" in station.page.now.html["notices"]


def test_processes_are_listed_with_their_state(station):
    listed = [Process(name="slam", state=Process.RUNNING), Process(name="gcs", state=Process.FAILED, restarts=3, reason="port")]
    station.script.put("sys", topics.PROCESSES.by("launcher"), Processes(processes=listed), 1.0)
    station.press(OpenTab(ME, "graph"))
    station.run(0.8)
    html = station.page.now.html["processes"]
    assert "slam" in html and "running" in html and "failed" in html and "<td>3</td>" in html and "port" in html


def test_what_several_launchers_tell_is_one_list_and_the_newest_word_counts(station):
    def told(launcher, t, *processes):
        station.script.put("sys", topics.PROCESSES.by(launcher), Processes(processes=processes), t)

    station.press(OpenTab(ME, "graph"))
    told("launcher.slam", 1.0, Process(name="slam", state=Process.RUNNING))
    told("launcher.planner", 1.0, Process(name="planner", state=Process.RUNNING))
    station.run(0.5)
    told("launcher.slam", 1.5, Process(name="slam", state=Process.FAILED, restarts=2))
    station.press(OpenTab(ME, "graph"))
    station.run(0.8)
    html = station.page.now.html["processes"]
    assert html.index("planner") < html.index("running") < html.index("slam") < html.index("failed") < html.index("<td>2</td>")
    assert html.count("running") == 1


def test_the_newest_event_is_on_top(station):
    station.script.say(UAV, "first", t=1.0)
    station.script.say(UAV, "second", t=2.0)
    station.press(OpenTab(ME, "log"), seconds=0.8)
    log = station.page.now.html["log"]
    assert log.index("second") < log.index("first")


def test_text_from_the_bus_is_never_markup(station):
    station.script.say(UGV, EVIL, Event.WARNING, t=1.0)
    station.script.put("sys", topics.CLOCK, Clock(t_ns=10**9, waiting_for=EVIL), 1.0)
    station.script.put("sys", topics.PROCESSES.by("launcher"), Processes(processes=[Process(name=EVIL, reason=EVIL)]), 1.0)
    for vehicle in station.model.vehicles.values():
        vehicle.status.command_source = vehicle.status.reason = EVIL
    station.model.vehicles[UGV].nav_status.job = station.model.vehicles[UGV].nav_status.reason = EVIL
    for chosen, tab, count in ((UGV, "drive", 5), (UAV, "fly", 5), (UAV, "log", 3), (UAV, "graph", 5)):
        station.page.clicks += [Select(ME, chosen), OpenTab(ME, tab)]
        station.run(0.8, silent=True)
        html = all_html(station)
        assert "<img" not in html
        assert html.count("&lt;img src=x onerror=alert(1)&gt;") >= count, tab
