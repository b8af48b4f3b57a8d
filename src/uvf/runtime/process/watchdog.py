"""Ends a step that does not come back, so that the other instances of its process go on."""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

LOOK = 0.25  # s, wall, between two looks at a step
PERIODS = 100
SHORTEST, LONGEST = 2.0, 6.0  # s; the launcher ends a process that has been silent for 10 s


class StepHangs(BaseException):
    """Raised within a step that has used more processor time than it may, at each look: whatever it catches, it does not go on."""


def time_limit(hz: float) -> float:
    """Processor time [s] that one step of a service that runs at ``hz`` [Hz] may use: far more than any needs."""
    return min(max(PERIODS / hz, SHORTEST), LONGEST)


class Watchdog:
    """Ends steps that hang, in a process whose steps run in its main thread; there is one at a time.

    It counts the processor time of that thread, so a busy or a sleeping machine harms nobody. It interrupts Python code only:
    a step that is lost within an engine or a compiled kernel, or waits for a lock, is left to the launcher, which ends the whole process.
    """

    def __init__(self) -> None:
        """Raises ValueError in another thread than the main one."""
        self._limit = 0.0
        self._since = 0.0
        signal.signal(signal.SIGALRM, self._look)

    def close(self) -> None:
        """Gives the signal back to the system's default."""
        signal.signal(signal.SIGALRM, signal.SIG_DFL)

    @contextmanager
    def limited(self, limit: float) -> Iterator[None]:
        """Limits the processor time of its body: raises StepHangs in it after ``limit`` [s]."""
        self._since, self._limit = time.thread_time(), limit
        # Only now: a signal at the end of a SimpleQueue's timeout makes CPython 3.11 wait there for ever.
        signal.setitimer(signal.ITIMER_REAL, LOOK, LOOK)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            self._limit = 0.0

    def _look(self, number: int, frame: FrameType | None) -> None:
        limit = self._limit
        if limit and time.thread_time() - self._since > limit:
            raise StepHangs(f"its step has not come back after {limit:g} s of processor time")
