"""What a service has worked out outlives its process, within one epoch."""

import time

import pytest

from schemas import topics
from schemas.messages import Clock, Grid
from tests.runtime.modes import free_port
from uvf.runtime.bus import Sample
from uvf.runtime.keeper import Keeper
from uvf.runtime.stop_all import StopBook, StopVoice
from uvf.runtime.zenoh_bus import ZenohBus, kept_key, open_router

KEY = topics.MAP.at("alpha")


@pytest.fixture
def buses():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint) as kept, ZenohBus(endpoint) as other:
        yield endpoint, Keeper(kept), other
    router.close()


def settle(keeper, seconds=0.3):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        keeper.poll()
        time.sleep(0.01)


def recall(keeper, bus):
    """Asks in this thread while the keeper answers in another's place: poll it before the answer is due."""
    import threading

    stop = threading.Event()
    thread = threading.Thread(target=lambda: [settle(keeper, 0.02) for _ in iter(stop.is_set, True)])
    thread.start()
    try:
        return bus.recall(KEY)
    finally:
        stop.set()
        thread.join()


def test_the_newest_map_is_found_after_its_writer_has_died(buses):
    endpoint, keeper, other = buses
    with ZenohBus(endpoint) as writer:
        publisher = writer.publisher(KEY, Grid.DESCRIPTOR.full_name, topics.MAP.qos)
        publisher.put(b"old", 1)
        publisher.put(b"new", 2)
        settle(keeper)
    assert recall(keeper, other) == b"new"


def test_what_was_never_sent_is_not_found(buses):
    _, keeper, other = buses
    assert recall(keeper, other) is None


def test_a_new_epoch_forgets(buses):
    _, keeper, other = buses
    other.publisher(KEY, Grid.DESCRIPTOR.full_name, topics.MAP.qos).put(b"map", 5_000_000_000)
    clock = other.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
    settle(keeper)
    other.epoch = 2
    clock.put(Clock(epoch=2, t_ns=10_000_000).SerializeToString(), 10_000_000)
    settle(keeper)
    assert recall(keeper, other) is None


def test_history_that_comes_late_does_not_take_the_place_of_what_is_newer(buses):
    _, keeper, _ = buses
    name, kept = Grid.DESCRIPTOR.full_name, keeper._keep
    kept(Sample(KEY, name, b"new", 20, 2, 7, 1))
    kept(Sample(KEY, name, b"old", 10, 1, 7, 1))
    kept(Sample(KEY, name, b"of a writer that has died", 10, 9, 6, 1))
    kept(Sample(KEY, name, b"of the epoch before", 99, 3, 7, 0))
    assert keeper._newest[kept_key(KEY)].payload == b"new"
    kept(Sample(KEY, name, b"newer", 20, 3, 7, 1))
    assert keeper._newest[kept_key(KEY)].payload == b"newer"


def test_a_message_ahead_of_the_clock_is_not_kept(buses):
    _, keeper, _ = buses
    keeper._on_clock(Sample(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, b"", 1_000_000_000, 1, 7, 1))
    for stamp, epoch in ((1_000_000_000, 9), (60_000_000_000, 1)):
        keeper._keep(Sample(KEY, Grid.DESCRIPTOR.full_name, b"poison", stamp, 1, 8, epoch))
    assert kept_key(KEY) not in keeper._newest


def test_who_comes_late_hears_of_a_stop_whose_sender_has_died_and_of_its_release(buses):
    endpoint, keeper, other = buses
    voice, key = StopVoice("gcs"), topics.STOP.by("gcs").at("sys")
    with ZenohBus(endpoint) as page:
        page.publisher(key, "uvf.v1.StopCommand", topics.STOP.qos).put(voice.engage(0, "pressed").SerializeToString(), 0)
        settle(keeper)
    book = StopBook()
    for topic in (topics.STOP.by("*"), topics.STOP_STATE):
        other.subscribe(topic.at("sys"), topic.qos, book.push, 64)
    until(keeper, other, lambda: book.now)
    assert book.now.who == "gcs (pressed)"
    with ZenohBus(endpoint) as client:
        release = StopVoice("client").release(0, book.now.engagements)
        client.publisher(topics.STOP.by("client").at("sys"), "uvf.v1.StopCommand", topics.STOP.qos).put(release.SerializeToString(), 0)
        until(keeper, other, lambda: not book.now)
    late = StopBook()
    other.subscribe(topics.STOP_STATE.at("sys"), topics.STOP_STATE.qos, late.push, 64)
    until(keeper, other, lambda: late._released)
    assert not late.now


def until(keeper, bus, condition, patience=10.0):
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end
        settle(keeper, 0.02)
        bus.poll()
