"""A page that joins a long-running station stops nobody."""

import time

import pytest
import viser

from services.gcs import viser_join
from tests.services.gcs.wire import free_port, join


@pytest.fixture
def server():
    assert viser_join.apply(), "viser's message loop is not the one that the jump was made for"
    server = viser.ViserServer("127.0.0.1", free_port(), verbose=False)
    yield server
    server.stop()


def after_a_day(server):
    """Makes the numbering look as after sixty million messages, with living ones on both sides of the gap."""
    frame = server.scene.add_frame("/old")
    server._websock_server._broadcast_buffer.message_counter = 60_000_000
    frame.position = (1.0, 2.0, 3.0)
    server.scene.add_frame("/new")


def test_the_jump_is_made_once():
    assert viser_join.apply() and viser_join.apply()


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
