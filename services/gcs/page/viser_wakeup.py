"""Lets the ground station's thread write to viser while browsers come and go.

viser 1.1.1 wakes its senders twice for each message: from its own loop, as asyncio wants it, and before that from the
thread that writes. The latter walks over the list of those who wait while the loop changes it, and now and then ends
the writer with ``RuntimeError: deque mutated during iteration``.
"""

import asyncio
from typing import Any


class LoopEvent(asyncio.Event):
    """An event that only its loop sets: from another thread ``set`` does nothing, as viser has its loop set it too."""

    def set(self) -> None:
        """Sets the event, if called on an event loop."""
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            return
        super().set()


def wake_from_the_loop(websock_server: Any) -> None:
    """Replaces the events of viser's message buffers, common and per browser, before anybody waits for them."""

    def begin(connection: Any) -> None:
        connection.get_message_buffer().message_event = LoopEvent()

    websock_server.on_client_connect(begin)
    websock_server.get_message_buffer().message_event = LoopEvent()
