"""What is plotted is drawn, by unit, with its newest values; what is no number on the bus is not."""

import re

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event
from services.gcs.actions.page import OpenTab, Select
from services.gcs.actions.plots import PlotAdd, PlotFind, PlotHold, PlotPreset, PlotRemove, PlotTopic, PlotWindow
from services.gcs.state.plots.plot_choice import MOST_SERIES
from services.gcs.view.panels.plots.plot import MOST_FOUND
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV

NAV = topics.NAV_STATE.at(UAV)


@pytest.fixture
def station():
    station = Station(listens=True)
    station.run(0.5)
    station.press(Select(ME, UAV), OpenTab(ME, "plot"), seconds=0.3)
    return station


def panel(station):
    return station.page.now.html["plot"]


def curves(station):
    return re.findall(r"<path class='g-curve g-c(\d)' data-name='[^']*' d='([^']*)'", panel(station))


def test_an_empty_tab_says_what_to_press_and_hears_nothing(station):
    assert "Choose a preset" in panel(station) and not station.watch.on


def test_a_preset_draws_a_chart_for_each_unit_and_says_the_newest_values(station):
    station.push("Airspeed and altitude")
    station.run(10.0)
    assert panel(station).count("<svg class='g-chart'") == 2
    (_, speed), (_, height) = curves(station)
    assert 150 <= speed.count("L") <= 210 and height.count("M") == 1
    assert "24.3 m/s" in panel(station)
    assert re.search(r"5\d\.\d+ m|6\d\.\d+ m|6\d m|5\d m", panel(station))
    assert station.model.plots.series.keys() == set(station.model.sessions[ME].plot.series)


def test_curves_of_one_unit_share_a_chart_and_keep_their_colours(station):
    station.press(PlotAdd(ME, NAV, "velocity.x"), PlotAdd(ME, NAV, "velocity.y"), PlotAdd(ME, NAV, "position.x"), seconds=3.0)
    assert panel(station).count("<svg class='g-chart'") == 2
    assert [colour for colour, _ in curves(station)] == ["0", "1", "2"]
    station.press(PlotRemove(ME, NAV, "velocity.x"), seconds=1.0)
    assert len(curves(station)) == 2


def test_the_window_and_the_hold(station):
    station.push("Airspeed and altitude", seconds=3.0)
    station.press(PlotWindow(ME, 10.0), PlotHold(ME, True), seconds=1.0)
    (begin, end) = re.search(r"data-begin='([-\d.]+)' data-end='([\d.]+)'", panel(station)).groups()
    assert float(end) - float(begin) == pytest.approx(10.0)
    station.run(3.0)
    assert f"data-end='{end}'" in panel(station)
    station.push("▶ Go on", seconds=1.0)
    assert f"data-end='{end}'" not in panel(station)


def test_events_stand_in_every_chart(station):
    station.push("Airspeed and altitude", seconds=1.0)
    station.script.say(UAV, "gust <b>", Event.WARNING, t=1.0)
    station.run(1.0)
    assert panel(station).count("gust &lt;b&gt;") == 2


def test_numbers_are_found_by_any_words_of_their_names(station):
    station.press(PlotFind(ME, "AIRSPEED nav"), seconds=1.0)
    assert "+ milvus/nav/state airspeed [m/s]" in station.page.now.words and "Topic to plot from" not in panel(station)
    station.push("+ milvus/nav/state airspeed [m/s]", seconds=2.0)
    assert "24.3 m/s" in panel(station)
    station.press(PlotFind(ME, "."), seconds=1.0)
    assert panel(station).count("+ milvus/") == MOST_FOUND and "more: write more of the name" in panel(station)
    station.press(PlotFind(ME, "<x>"), seconds=1.0)
    assert "No number is called so" in panel(station) and "<x>" not in panel(station)
    station.press(PlotFind(ME, " "), seconds=1.0)
    assert "Topic to plot from" in panel(station)


def test_the_numbers_of_a_topic_are_listed_and_added(station):
    station.press(PlotTopic(ME, topics.STATUS.at(UAV)), seconds=1.0)
    assert "+ battery_voltage [V]" in station.page.now.words
    station.push("+ battery_voltage [V]", seconds=2.0)
    assert "11.6 V" in panel(station)


@pytest.mark.parametrize(
    "action",
    [
        PlotAdd(ME, NAV, "nothing"),
        PlotAdd(ME, "uvf/sys/srv/clock", "rate"),
        PlotAdd(ME, "etc/passwd", "x"),
        PlotTopic(ME, "etc/passwd"),
        PlotWindow(ME, 1e9),
        PlotPreset(ME, "nonsense"),
    ],
)
def test_what_is_no_number_on_the_bus_changes_nothing(station, action):
    before = station.model.sessions[ME].plot
    station.press(action)
    assert station.model.sessions[ME].plot == before


def test_the_number_of_series_is_bounded_and_the_listening_ends_with_the_last(station):
    paths = [f"{vector}.{axis}" for vector in ("position", "velocity", "wind", "angular_velocity") for axis in "xyz"]
    station.press(*(PlotAdd(ME, NAV, path) for path in paths), seconds=0.5)
    assert len(station.model.sessions[ME].plot.series) == MOST_SERIES and station.watch.on
    station.press(OpenTab(ME, "fly"), seconds=0.3)
    assert station.watch.on, "it goes on while another tab is open"
    station.press(*(PlotRemove(ME, NAV, path) for path in paths), seconds=0.3)
    assert not station.watch.on and station.model.plots.series == {}


def test_a_rover_has_presets_of_its_own(station):
    station.press(Select(ME, UGV), seconds=0.6)
    station.push("Speed and turn rate", seconds=3.0)
    assert "0.21 m/s" in panel(station) or "0.21" in panel(station)
    assert np.isfinite([float(x) for x in re.findall(r"[ML]([\d.]+) ", curves(station)[0][1])]).all()
