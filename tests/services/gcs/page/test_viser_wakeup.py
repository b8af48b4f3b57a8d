"""Whoever writes to viser from a thread of his own does not meet its loop at the list of those who wait."""

import asyncio
import threading

import pytest

from services.gcs.page.viser_server import guarded_server
from services.gcs.page.viser_wakeup import LoopEvent
from tests.services.gcs.wire import Browser, free_port, until
from uvf.runtime.bus.address import Address


class Told:
    """A list of waiting ones that tells who walks over it."""

    def __init__(self, waiters):
        self.waiters = waiters
        self.threads = []

    def __iter__(self):
        self.threads.append(threading.get_ident())
        return iter(list(self.waiters))

    def __getattr__(self, name):
        return getattr(self.waiters, name)


async def set_from(event):
    """The threads in which those who wait are walked over, when it is set in another thread, and then as viser does."""
    told = event._waiters = Told(event._waiters)
    waiting = asyncio.create_task(event.wait())
    await asyncio.sleep(0)
    loop = asyncio.get_running_loop()
    await asyncio.to_thread(event.set)
    walked = list(told.threads)
    loop.call_soon_threadsafe(event.set)
    await asyncio.wait_for(waiting, 5)
    return walked


def test_another_thread_does_not_walk_over_those_who_wait_and_they_wake_all_the_same():
    assert asyncio.run(set_from(LoopEvent())) == []


@pytest.fixture
def page_server():
    server = guarded_server(Address(port=free_port()), {})
    browser = Browser(server.get_port())
    assert until(server.get_clients)
    yield server
    browser.close()
    server.stop()


def test_every_browser_has_such_an_event(page_server):
    websock = page_server._websock_server
    assert type(websock._broadcast_buffer.message_event) is LoopEvent
    buffers = [client.message_buffer for client in websock._client_state_from_id.values()]
    assert buffers and all(type(buffer.message_event) is LoopEvent for buffer in buffers)
