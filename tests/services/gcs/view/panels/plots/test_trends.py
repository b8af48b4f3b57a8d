"""The small charts below the instruments: the last minute of what they show, or the minute before the moment that is looked back at."""

import re

import pytest

from services.gcs.actions.page import OpenTab, Select
from services.gcs.actions.times import ShowPast
from services.gcs.state.plots.trends import PERIOD
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV


@pytest.fixture
def station():
    station = Station()
    station.press(OpenTab(ME, "fly"), seconds=20.0)
    return station


def charts(station):
    """(aria-label, end, number of points) of each."""
    found = re.findall(
        r"<svg class='g-chart' role='img' aria-label='([^']*)'[^>]* data-end='([-\d.]+)'.*?<path class='g-curve[^>]* d='([^']*)'",
        station.page.now.html["trends"],
    )
    return [(label, float(end), path.count("L")) for label, end, path in found]


def test_an_aircraft_has_its_airspeed_and_altitude(station):
    station.press(Select(ME, UAV), seconds=1.0)
    (speed, end, points), (height, *_) = charts(station)
    assert speed == "airspeed over the last minute: 24.3 m/s"
    assert re.fullmatch(r"altitude over the last minute: \d\d\.\d m", height)
    assert end == 0.0 and points == pytest.approx(21.0 / PERIOD, abs=6)


def test_a_rover_has_its_speed_and_turn_rate(station):
    station.press(Select(ME, UGV), seconds=1.0)
    assert [label for label, *_ in charts(station)] == [
        "speed over the last minute: 0.2 m/s",
        "turn rate over the last minute: 0.3 rad/s",
    ]


def test_who_looks_back_sees_the_minute_before(station):
    station.press(Select(ME, UAV), seconds=1.0)
    (_, _, points), _ = charts(station)
    station.press(ShowPast(ME, -12.0), seconds=1.0)
    (_, _, fewer), _ = charts(station)
    assert fewer == pytest.approx(points - 12.0 / PERIOD, abs=8)
