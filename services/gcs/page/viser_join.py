"""Keeps a browser that joins late from stopping the others.

viser 1.1.1 walks over every message number ever given to find the few messages that still count: 0.2 s without any
other work for each million ever sent, so a day of flying would stop all pages for seconds. ``JumpingBuffer`` overrides
that walk, ``AsyncMessageBuffer._window_loop``, and goes to the messages that there still are.
"""

import asyncio
import contextlib
import sys
from collections.abc import AsyncGenerator, Iterator, Sequence
from typing import Any

import viser
from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._messages import Message

WRITTEN_FOR = "1.1.1"
"""The viser whose loop is overridden; another one may have mended it, or count on something else in it."""


class JumpingBuffer(AsyncMessageBuffer):
    """viser's buffer of what all browsers are sent: the same messages in the same windows and order."""

    async def _window_loop(
        self, client_id: int, backlog_last_id: int, backlog_done_message: Message | None
    ) -> AsyncGenerator[Sequence[Message], None]:
        """As in viser, but for ``_next_window``."""
        sent = -1
        marker = backlog_done_message
        flush = self.event_loop.create_task(self.flush_event.wait())
        self.generator_cursors[client_id] = sent
        try:
            while not self.done:
                window, sent = self._next_window(client_id, sent, backlog_last_id if marker is not None else None)
                self.generator_cursors[client_id] = sent
                if marker is not None and sent >= backlog_last_id and self.atomic_counter == 0:
                    window, marker = [*window, marker], None
                if window:
                    yield window
                else:
                    await self.message_event.wait()
                    self.message_event.clear()
                if not window or self.message_counter - 1 == sent:
                    done, _ = await asyncio.wait([flush], timeout=self.window_duration_sec)
                    if flush in done and not self.done:
                        self.flush_event.clear()
                        flush = self.event_loop.create_task(self.flush_event.wait())
        finally:
            self.generator_cursors.pop(client_id, None)
            flush.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await flush

    def _next_window(self, client_id: int, sent: int, limit: int | None) -> tuple[list[Message], int]:
        """(the next messages after number ``sent``, up to ``limit`` if there is one; the number up to which all is done)."""
        with self.buffer_lock:
            if self.atomic_counter:
                return [], sent
            last = self.message_counter - 1 if limit is None else min(self.message_counter - 1, limit)
            numbers = self._numbers(sent, last)
            found = [self.message_from_id[number] for number in numbers]
        full = len(numbers) == self.max_window_size
        return [message for message in found if message.excluded_self_client != client_id], numbers[-1] if full else max(sent, last)

    def _numbers(self, sent: int, last: int) -> list[int]:
        """Of the next messages that there still are, as many as fit into a window. A dict keeps the order of entry; numbers only grow."""
        near = last - sent <= len(self.message_from_id)
        candidates = range(sent + 1, last + 1) if near else self.message_from_id
        live = (number for number in candidates if sent < number <= last and number in self.message_from_id)
        return [number for number, _ in zip(live, range(self.max_window_size), strict=False)]


@contextlib.contextmanager
def jumping() -> Iterator[None]:
    """Installs the buffer for servers that are started meanwhile; with another version of viser it does not, and says so."""
    if viser.__version__ != WRITTEN_FOR:
        sys.stderr.write(f"gcs: viser is {viser.__version__}, not {WRITTEN_FOR}: who joins after hours may stop all pages for seconds\n")
        yield
        return
    infra: Any = _infra
    plain, infra.AsyncMessageBuffer = infra.AsyncMessageBuffer, JumpingBuffer
    try:
        yield
    finally:
        infra.AsyncMessageBuffer = plain
