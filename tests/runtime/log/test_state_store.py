"""What a service has worked out outlives its process, within one epoch."""

import time

import pytest

from schemas import topics
from schemas.messages import Clock, Grid
from tests.runtime.modes import free_port
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.zenoh_bus import ZenohBus, kept_key, open_router
from uvf.runtime.log.state_store import StateStore
from uvf.runtime.state.stop_all import StopBook, StopVoice

KEY = topics.MAP.at("alpha")


def grid(frame):
    """The bytes of a map that is told from others by its frame."""
    message = Grid(frame_id=frame, column_count=1, row_stride=1, cell_stride=1, data=b"\0")
    message.cell_size.x = message.cell_size.y = 0.05
    return message.SerializeToString()


@pytest.fixture
def told():
    """What the keeper says of messages that it does not keep."""
    return []


@pytest.fixture
def buses(told):
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint) as kept, ZenohBus(endpoint) as other:
        yield endpoint, StateStore(kept, told.append), other
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
        publisher.put(grid("old"), 1)
        publisher.put(grid("new"), 2)
        settle(keeper)
    assert recall(keeper, other) == grid("new")


def test_what_was_never_sent_is_not_found(buses):
    _, keeper, other = buses
    assert recall(keeper, other) is None


def test_a_new_epoch_forgets(buses):
    _, keeper, other = buses
    other.publisher(KEY, Grid.DESCRIPTOR.full_name, topics.MAP.qos).put(grid("map"), 5_000_000_000)
    clock = other.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
    settle(keeper)
    other.epoch = 2
    clock.put(Clock(epoch=2, t_ns=10_000_000).SerializeToString(), 10_000_000)
    settle(keeper)
    assert recall(keeper, other) is None


def test_history_that_comes_late_does_not_take_the_place_of_what_is_newer(buses):
    _, keeper, _ = buses
    name, kept = Grid.DESCRIPTOR.full_name, keeper._keep
    kept(Sample(KEY, name, grid("new"), 20, 2, 7, 1))
    kept(Sample(KEY, name, grid("old"), 10, 1, 7, 1))
    kept(Sample(KEY, name, grid("of a writer that has died"), 10, 9, 6, 1))
    kept(Sample(KEY, name, grid("of the epoch before"), 99, 3, 7, 0))
    assert keeper._newest[kept_key(KEY)].payload == grid("new")
    kept(Sample(KEY, name, grid("newer"), 20, 3, 7, 1))
    assert keeper._newest[kept_key(KEY)].payload == grid("newer")


def test_a_message_ahead_of_the_clock_is_not_kept(buses):
    _, keeper, _ = buses
    tick(keeper, 1_000_000_000, epoch=1)
    for stamp, epoch in ((1_000_000_000, 9), (60_000_000_000, 1), (2**62, 2)):
        keeper._keep(Sample(KEY, Grid.DESCRIPTOR.full_name, grid("poison"), stamp, 1, 8, epoch))
    assert kept_key(KEY) not in keeper._newest
    tick(keeper, 10_000_000, epoch=2)
    assert kept_key(KEY) not in keeper._newest


def tick(keeper, t_ns, epoch):
    keeper._on_clock(Clock(t_ns=t_ns, epoch=epoch), Sample(topics.CLOCK.at("sys"), "uvf.v1.Clock", b"", t_ns, 1, 7, epoch))


def test_what_is_of_the_next_epoch_takes_the_place_of_nothing_before_the_clock_begins_it(buses):
    _, keeper, _ = buses
    tick(keeper, 1_000_000_000, epoch=1)
    keeper._keep(Sample(KEY, Grid.DESCRIPTOR.full_name, grid("now"), 900_000_000, 1, 8, 1))
    keeper._keep(Sample(KEY, Grid.DESCRIPTOR.full_name, grid("to come"), 10_000_000, 1, 9, 2))
    assert keeper._newest[kept_key(KEY)].payload == grid("now")
    tick(keeper, 10_000_000, epoch=2)
    assert keeper._newest[kept_key(KEY)].payload == grid("to come")


@pytest.mark.parametrize(("type_name", "payload"), [("uvf.v1.Nothing", grid("x")), ("foxglove.Grid", b"\xff\xff"), ("foxglove.Grid", b"")])
def test_what_nobody_could_read_is_not_kept_and_told_once(buses, told, type_name, payload):
    _, keeper, _ = buses
    keeper._keep(Sample(KEY, "foxglove.Grid", grid("good"), 10, 1, 7, 1))
    for seq in (2, 3):
        keeper._keep(Sample(KEY, type_name, payload, 20, seq, 7, 1))
    assert keeper._newest[kept_key(KEY)].payload == grid("good")
    (line,) = told
    assert line.startswith(f"{KEY}: ")


def test_no_clock_is_none_and_wipes_nothing(buses):
    _, keeper, other = buses
    other.publisher(KEY, Grid.DESCRIPTOR.full_name, topics.MAP.qos).put(grid("map"), 5_000_000_000)
    other.epoch = 2**32 - 1
    other.publisher(topics.CLOCK.at("sys"), "", topics.CLOCK.qos).put(b"", 0)
    settle(keeper)
    assert recall(keeper, other) == grid("map")


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
