"""Any moment of the last minutes can be had again, within bounds of time and memory."""

import numpy as np

from schemas.messages import Clock, CompressedImage, Event, NavState, NavStatus
from services.gcs.state.event_log import EventLine
from services.gcs.state.history import STRETCH, RecentHistory


def status(n):
    return NavStatus(reason=f"{n}")


def heard(seconds, **bounds):
    """A history of one message each second, which says when it came."""
    history = RecentHistory(**bounds)
    for t in range(seconds):
        history.hear(float(t), "status", {"ugv": status(t)})
    return history


def said(history, t):
    found = history.at(t)
    return {name: kept.message.reason for (_, name), kept in found.items()}


def test_vehicles_that_are_gone_are_let_go_of():
    history = RecentHistory()
    for n in range(400):
        history.hear(float(n), "nav", {f"stranger{n}": NavState(airspeed=1.0), "milvus": NavState(airspeed=float(n))})
        history.hear(float(n), "clock", {"": Clock(tick=n)})
        history.go(float(n), f"stranger{n}", np.zeros(3), 1.0)
        history.only({f"stranger{n}", "milvus"})
    assert len(history._newest) == len(history._last) == 3
    assert ("nav", "stranger100") in history.at(100.0) and ("nav", "stranger100") not in history.at(399.0)


def test_each_moment_gives_the_newest_message_of_then():
    history = heard(100)
    assert [said(history, t)["ugv"] for t in (0.0, 0.9, 57.3, 99.0, 1e6)] == ["0", "0", "57", "99", "99"]
    assert history.at(-0.1) == {}


def test_what_stands_for_long_is_there_at_each_moment():
    history = RecentHistory()
    history.hear(0.0, "mission", {"uav": status("plan")})
    for t in range(1, 60):
        history.hear(float(t), "status", {"ugv": status(t)})
    assert said(history, 58.0) == {"uav": "plan", "ugv": "58"}


def test_the_same_message_is_kept_once():
    history, one = RecentHistory(), status(1)
    for t in range(1000):
        history.hear(float(t), "status", {"ugv": one})
    assert len(history.at(999.0)) == 1 and history.at(999.0)["status", "ugv"].t == 0.0


def test_what_is_older_than_its_length_is_forgotten_and_what_stood_then_is_not():
    history = RecentHistory(length=60.0)
    history.hear(0.0, "mission", {"uav": status("plan")})
    for t in range(1000):
        history.hear(float(t), "status", {"ugv": status(t)})
        history.note(float(t), [EventLine(float(t), Event.NOTICE, "", f"{t}")])
        history.go(float(t), "ugv", np.array((t, 0.0, 0.0)), 0.5)
    assert 60 <= 999 - history.begin <= 60 + STRETCH
    assert said(history, history.begin) == {"uav": "plan", "ugv": f"{history.begin:.0f}"}
    assert history.at(history.begin - 1) == {}
    assert history.lines(1e6)[0].t >= history.begin and history.way("ugv", 1e6)[0][0] >= history.begin


def test_large_messages_shorten_it_and_pictures_are_thinned():
    history = RecentHistory(budget=100_000)
    for n in range(1000):
        history.hear(n / 10, "image", {"ugv": CompressedImage(data=bytes(2000))})
    # Two each second of 2 kB: 100 kB are 25 s.
    assert 25 - STRETCH - 0.5 <= 99.9 - history.begin <= 30
    assert [history.at(t)["image", "ugv"].t for t in (99.0, 99.4, 99.5)] == [99.0, 99.0, 99.5]


def test_only_what_is_more_than_routine_is_a_tick():
    history = RecentHistory()
    history.hear(0.0, "status", {"ugv": status(0)})
    for severity in (Event.INFO, Event.NOTICE, Event.ERROR):
        history.note(1.0, [EventLine(0.0, severity, "", "x")])
    history.note(2.0, [EventLine(0.0, Event.INFO, "", "arm: accepted", of_operator=True)])
    assert [timed.line.severity for timed in history.ticks(9.0)] == [Event.NOTICE, Event.ERROR, Event.INFO]
