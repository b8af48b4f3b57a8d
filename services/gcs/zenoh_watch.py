"""The watch on Zenoh: a session of its own, in a thread of its own, while a page needs it."""

import time
from collections.abc import Sequence
from threading import Event, Thread

from services.gcs.watch import WatchedMessage
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.backlog import Backlog
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.zenoh_bus import ZenohBus

LOOK = 0.1  # s, between two looks for messages
LOOK_FOR_TOKENS = 2.0  # s
RETRY = 2.0  # s, after a router was not found
CONNECT_WITHIN = 3.0  # s
DEPTH, BYTES_MOST = 16_384, 64_000_000
TAKEN_AT_ONCE = 4000
PATIENCE = 5.0  # s that the thread has to end

Came = tuple[Sample, float]
"""A message, and when it came [s, monotonic]."""


class ZenohWatch:
    """Listens through the router at ``endpoint``. Messages that nobody takes in time are lost, the oldest first."""

    def __init__(self, endpoint: str) -> None:
        self._endpoint = endpoint
        self._run: _Run | None = None

    def start(self) -> None:
        """Begins to listen, in a thread."""
        if self._run is None:
            self._run = _Run(self._endpoint)

    def stop(self) -> None:
        """Tells the thread to end, and does not wait for it."""
        if self._run is not None:
            self._run.over.set()
            self._run = None

    def samples(self) -> Sequence[WatchedMessage]:
        """Takes what has come, oldest first."""
        taken: list[WatchedMessage] = []
        now = time.monotonic()
        while self._run is not None and len(taken) < TAKEN_AT_ONCE and (came := self._run.came.take()) is not None:
            sample, at = came
            taken.append(WatchedMessage(sample.key, sample.type_name, sample.payload, now - at, sample.boot, sample.stamp_ns * 1e-9))
        return taken

    def tokens(self) -> Sequence[str] | None:
        """The newest list of tokens, at most some seconds old."""
        return self._run.tokens if self._run is not None else None

    def close(self) -> None:
        """Ends it, and waits until the session is closed: one left open hangs the interpreter at exit."""
        run = self._run
        self.stop()
        if run is not None:
            run.thread.join(PATIENCE)


class _Run:
    """One time of listening."""

    def __init__(self, endpoint: str) -> None:
        self.over = Event()
        self.came: Backlog[Came] = Backlog(DEPTH, lambda came: len(came[0].payload) + 500, BYTES_MOST)
        self.tokens: Sequence[str] | None = None
        self._endpoint = endpoint
        self.thread = Thread(target=self._listen, name="bus watch", daemon=True)
        self.thread.start()

    def _listen(self) -> None:
        while not self.over.is_set():
            try:
                bus = ZenohBus(self._endpoint, timeout=CONNECT_WITHIN)
            except BadInput:
                self.over.wait(RETRY)
                continue
            with bus:
                self._hear(bus)

    def _hear(self, bus: ZenohBus) -> None:
        bus.subscribe_all(lambda sample: self.came.push((sample, time.monotonic())), DEPTH)
        looked = -LOOK_FOR_TOKENS
        while not self.over.wait(LOOK):
            bus.poll()
            if time.monotonic() - looked >= LOOK_FOR_TOKENS:
                self.tokens = [*bus.tokens("@node/**"), *bus.tokens("@ep/**")]
                looked = time.monotonic()
