"""A page that joins a long-running station stops nobody."""

import asyncio
import hashlib
import inspect
import time
from dataclasses import dataclass

import pytest
import viser
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._messages import Message

from services.gcs.page import viser_join
from tests.services.gcs.wire import free_port, join


@pytest.fixture
def server():
    with viser_join.jumping():
        server = viser.ViserServer("127.0.0.1", free_port(), verbose=False)
    yield server
    server.stop()


def after_a_day(server):
    """Makes the numbering look as after sixty million messages, with living ones on both sides of the gap."""
    frame = server.scene.add_frame("/old")
    server._websock_server._broadcast_buffer.message_counter = 60_000_000
    frame.position = (1.0, 2.0, 3.0)
    server.scene.add_frame("/new")


LOOP = "622c10d1a9e8"
"""SHA-256 of the source of the loop that is overridden, its first digits."""


def test_the_loop_that_is_overridden_is_the_one_the_override_was_written_for(server):
    source = inspect.getsource(AsyncMessageBuffer._window_loop)
    assert viser.__version__ == viser_join.WRITTEN_FOR and hashlib.sha256(source.encode()).hexdigest().startswith(LOOP)
    assert type(server._websock_server._broadcast_buffer) is viser_join.JumpingBuffer


def test_another_viser_is_left_alone_and_told_of(monkeypatch, capsys):
    monkeypatch.setattr(viser_join, "WRITTEN_FOR", "0.0.1")
    with viser_join.jumping():
        assert viser_join._infra.AsyncMessageBuffer is AsyncMessageBuffer
    assert "not 0.0.1" in capsys.readouterr().err


def window_of(buffer, sent=-1, limit=None):
    messages, upto = buffer._next_window(7, sent, limit)
    return [m.value for m in messages], upto


@dataclass
class Numbered(Message):
    value: int

    def redundancy_key(self):
        return f"{self.value}"


Numbered.include_in_scene_serialization = False


def buffer_with(count, gone=()):
    buffer = viser_join.JumpingBuffer(asyncio.new_event_loop(), persistent_messages=True)
    for value in range(count):
        buffer.push(Numbered(value))
    buffer.remove_from_buffer(lambda message: message.value in gone)
    return buffer


def test_windows_hold_what_there_still_is_in_its_order():
    buffer = buffer_with(300, gone=range(10, 290))
    assert window_of(buffer) == ([*range(10), *range(290, 300)], 299)
    assert window_of(buffer, sent=294, limit=297) == ([295, 296, 297], 297)
    assert window_of(buffer, sent=299) == ([], 299)


def test_a_window_is_no_longer_than_visers():
    buffer = buffer_with(300)
    first, upto = window_of(buffer)
    assert (first, upto) == (list(range(128)), 127)
    assert window_of(buffer, upto)[0] == list(range(128, 256))


def test_nothing_is_sent_while_messages_are_put_together():
    buffer = buffer_with(5)
    buffer.atomic_start()
    assert window_of(buffer) == ([], -1)
    buffer.atomic_end()
    assert window_of(buffer) == ([0, 1, 2, 3, 4], 4)


def test_who_has_said_something_is_not_told_it_again():
    buffer = buffer_with(3)
    buffer.message_from_id[1].excluded_self_client = 7
    assert window_of(buffer) == ([0, 2], 2)


def test_a_late_joiner_gets_all_in_no_time(server):
    after_a_day(server)
    begin = time.perf_counter()
    messages = join(server.get_port())
    assert time.perf_counter() - begin < 3.0
    assert {"/old", "/new"} <= {m.get("name") for m in messages}
    assert [m["position"] for m in messages if m["type"] == "SetPositionMessage" and m["name"] == "/old"][-1] == [1.0, 2.0, 3.0]


def test_what_is_removed_is_not_replayed_and_what_follows_is(server):
    frame = server.scene.add_frame("/gone")
    after_a_day(server)
    frame.remove()
    server.scene.add_frame("/last")
    created = {m["name"] for m in join(server.get_port()) if m["type"] == "FrameMessage"}
    assert {"/old", "/new", "/last"} <= created
    assert "/gone" not in created


def test_two_joiners_get_the_same(server):
    after_a_day(server)
    first, second = (sorted(str(m.get("name")) + m["type"] for m in join(server.get_port())) for _ in range(2))
    assert first == second
