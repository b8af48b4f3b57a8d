"""A value of an enum that this page has never heard of is shown by its number and stops nothing."""

from pathlib import Path

import pytest

from schemas import topics
from schemas.messages import (
    Clock,
    Event,
    Fence,
    FenceZone,
    Mission,
    MissionItem,
    MissionProgress,
    Mode,
    NavStatus,
    Process,
    Processes,
    VehicleStatus,
)
from services import gcs
from services.gcs.actions.page import OpenTab
from services.gcs.state.wording import mode_name
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, UGV
from uvf.runtime.bus import wire
from uvf.runtime.messages.enum_names import enum_name

UNKNOWN = 99


@pytest.fixture
def station(monkeypatch):
    """The border refuses such a value; this page would live through it, too."""
    monkeypatch.setattr(wire, "error_in", lambda message: "")
    station = Station()
    station.run(0.5)
    station.press(OpenTab(ME, "graph"))
    return station


@pytest.mark.parametrize(
    ("enum", "value", "name"),
    [
        (Mode, Mode.MODE_RETURN, "return"),
        (Mode, UNKNOWN, "mode 99"),
        (NavStatus.State, NavStatus.DRIVING, "driving"),
        (NavStatus.State, -1, "state -1"),
        (MissionProgress.State, MissionProgress.NO_MISSION, "no mission"),
    ],
)
def test_a_value_is_called_by_its_name_or_else_by_its_number(enum, value, name):
    assert enum_name(enum, value) == name


def test_an_unknown_mode_is_told_apart_from_the_known_ones():
    assert [mode_name(mode) for mode in (Mode.MODE_HOLD, UNKNOWN)] == ["Hold", "Mode 99"]


def hear(station, vehicle, topic, message):
    station.script.put(vehicle, topic, message, station.t)
    station.run(0.8, silent=True)
    return "".join(station.page.now.html.values())


def test_a_vehicle_in_unknown_states_is_shown_with_their_numbers(station):
    html = hear(station, UGV, topics.STATUS, VehicleStatus(mode=UNKNOWN, kind=UNKNOWN, armed=True))
    assert "▶ MODE 99" in html
    html = hear(station, UGV, topics.NAV_STATUS, NavStatus(state=UNKNOWN, job="explore"))
    assert "state 99" in html
    html = hear(station, UGV, topics.PROGRESS, MissionProgress(state=UNKNOWN, total=3))
    assert "mission state 99" in html


def test_a_process_in_an_unknown_state_is_listed_with_its_number(station):
    told = Processes(processes=[Process(name="slam", state=UNKNOWN)])
    assert "state 99" in hear(station, "sys", topics.PROCESSES.by("launcher"), told)


@pytest.mark.parametrize(
    ("owner", "topic", "message"),
    [
        ("sys", topics.CLOCK, Clock(t_ns=10**9, state=UNKNOWN)),
        (UGV, topics.EVENTS.by("test"), Event(text="odd", severity=UNKNOWN)),
        (UGV, topics.EVENTS.by("test"), Event(text="odd", severity=-UNKNOWN)),
        (UAV, topics.MISSION, Mission(items=[MissionItem(kind=UNKNOWN)] * 3)),
        (UAV, topics.FENCE, Fence(zones=[FenceZone(radius=10.0)], action=UNKNOWN)),
    ],
    ids=["clock", "event", "negative", "mission", "fence"],
)
def test_other_unknown_values_stop_nothing(station, owner, topic, message):
    assert "LIVE" in hear(station, owner, topic, message) or "PAUSED" in "".join(station.page.now.html.values())


def test_nothing_on_the_page_asks_protobuf_for_a_name_which_raises_for_an_unknown_value():
    assert [p.name for p in sorted(Path(gcs.__path__[0]).glob("*.py")) if ".Name(" in p.read_text(encoding="utf-8")] == []
