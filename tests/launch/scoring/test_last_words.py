"""What is told under a failed criterion: the last events, and what planner and autopilot say since when."""

from launch.scoring.last_words import TOLD, LastWords
from schemas import topics
from schemas.messages import Event, Mode, NavStatus, VehicleStatus
from uvf.runtime.bus.interface import LocalBus

OUTSIDE = NavStatus(state=NavStatus.IDLE, reason="the vehicle is outside its map")


def say(bus, topic, message, t, vehicle="kart"):
    publisher = bus.publisher(topic.at(vehicle), topic.message.DESCRIPTOR.full_name, topic.qos)
    publisher.put(message.SerializeToString(), round(t * 1e9))


def test_a_vehicle_is_told_of_by_its_last_events_and_the_reasons_with_their_times():
    bus, words = LocalBus(), LastWords()
    words.follow(bus)
    say(bus, topics.EVENTS.by("planner"), Event(severity=Event.WARNING, text="no way to the goal", cause="walls"), 2.0)
    for t in (3.2, 3.7, 4.2):
        say(bus, topics.NAV_STATUS, OUTSIDE, t)
    say(bus, topics.STATUS, VehicleStatus(mode=Mode.MODE_HOLD, reason="no position", prearm=["no GNSS"]), 3.0)
    say(bus, topics.STATUS, VehicleStatus(mode=Mode.MODE_HOLD, armed=True), 3.0, "other")
    bus.poll()
    assert words.of("kart") == [
        "kart at 2.0 s: warning: no way to the goal (cause: walls)",
        "kart since 3.2 s: planner idle: the vehicle is outside its map",
        "kart since 3.0 s: autopilot in mode hold, disarmed; no position; no GNSS",
    ]


def test_only_the_last_events_are_told_or_the_first_from_a_time_on():
    bus, words = LocalBus(), LastWords()
    words.follow(bus)
    for n in range(40):
        say(bus, topics.EVENTS.by("planner"), Event(text=f"event {n}"), float(n))
    bus.poll()
    assert [line.rpartition(" ")[2] for line in words.of("kart")] == [str(n) for n in range(40 - TOLD, 40)]
    assert [line.rpartition(" ")[2] for line in words.of("kart", since=20.5)] == [str(n) for n in range(20, 20 + TOLD)]


def test_a_crash_is_told_whatever_else_is():
    bus, words = LocalBus(), LastWords()
    words.follow(bus)
    say(bus, topics.EVENTS.by("sim_air"), Event(severity=Event.CRITICAL, text="crashed", cause="the nose touched the ground"), 12.3, "eye")
    bus.poll()
    assert words.crashes == ["eye crashed at 12.3 s: the nose touched the ground"]


def test_of_a_vehicle_that_said_nothing_it_is_said():
    assert LastWords().of("kart") == ["kart: no event and no status was recorded"]
