"""Subscriptions of one process over Zenoh."""

import time

import pytest

from schemas.topics import Qos
from tests.runtime.modes import free_port
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router

KEY = "uvf/anne/nav/pose"


@pytest.fixture
def buses():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint, timeout=5.0) as sender, ZenohBus(endpoint, timeout=5.0) as receiver:
        yield sender, receiver
    router.close()


def poll_until(bus, done):
    end = time.monotonic() + 10.0
    while not done() and time.monotonic() < end:
        bus.poll()


def heard_by(bus, sinks, enough):
    poll_until(bus, lambda: all(len(sink) >= enough for sink in sinks))


def heard_until(bus, sink, seq):
    poll_until(bus, lambda: sink and sink[-1].seq >= seq)


def publisher_heard(bus, qos, receiver, sinks):
    """A publisher of whom the receiver has heard at least once; what it heard until then is forgotten."""
    publisher, end = bus.publisher(KEY, "test", qos), time.monotonic() + 10.0
    while not all(sinks) and time.monotonic() < end:
        publisher.put(b"", 0)
        receiver.poll()
        time.sleep(0.01)
    for sink in sinks:
        heard_until(receiver, sink, publisher.seq)
        sink.clear()
    return publisher


def test_two_who_read_one_topic_each_hear_every_message_once_and_in_order(buses):
    sender, receiver = buses
    wide, again, own = [], [], []
    receiver.subscribe("uvf/*/nav/pose", Qos.STATE, wide.append, 256)
    receiver.subscribe("uvf/*/nav/pose", Qos.STATE, again.append, 256)
    receiver.subscribe(KEY, Qos.STATE, own.append, 256)
    publisher = publisher_heard(sender, Qos.STATE, receiver, (wide, again, own))
    for k in range(200):
        publisher.put(bytes([k]), k)
    heard_by(receiver, (wide, again, own), 200)
    for heard in (wide, again, own):
        assert [sample.payload[0] for sample in heard] == list(range(200))
    assert not receiver.counter.gaps


def test_one_who_keeps_only_the_latest_does_not_shorten_what_another_one_hears(buses):
    sender, receiver = buses
    every, latest = [], []
    receiver.subscribe(KEY, Qos.STATE, latest.append, 1)
    receiver.subscribe(KEY, Qos.STATE, every.append, 256)
    publisher = publisher_heard(sender, Qos.STATE, receiver, (every, latest))
    for k in range(50):
        publisher.put(bytes([k]), k)
    heard_until(receiver, latest, publisher.seq)
    heard_by(receiver, (every,), 50)
    assert [sample.payload[0] for sample in every] == list(range(50))
    assert latest[-1].payload[0] == 49


@pytest.mark.parametrize("qos", [Qos.LATCHED, Qos.EVENT])
def test_who_comes_later_hears_what_was_said_before(buses, qos):
    sender, receiver = buses
    first, second = [], []
    receiver.subscribe(KEY, qos, first.append, 8)
    sender.publisher(KEY, "test", qos).put(b"said", 0)
    heard_by(receiver, (first,), 1)
    receiver.subscribe(KEY, qos, second.append, 8)
    heard_by(receiver, (second,), 1)
    assert [sample.payload for sample in (*first, *second)] == [b"said", b"said"]
