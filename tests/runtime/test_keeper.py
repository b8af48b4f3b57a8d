"""What a service has worked out outlives its process, within one epoch."""

import time

import pytest

from schemas import topics
from schemas.messages import Clock, Grid
from tests.runtime.modes import free_port
from uvf.runtime.keeper import Keeper
from uvf.runtime.zenoh_bus import ZenohBus, open_router

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
