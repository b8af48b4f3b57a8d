"""What every process of a run does alike: signals, one line per warning, and an end when its launcher is gone."""

import contextlib
import gc
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event

from uvf.models.yaml_data import BadInput

PARENT = "UVF_PARENT"
ALIVE_FILE = "UVF_ALIVE_FILE"


class Worker:
    """Lifecycle of a process: ``stop`` is set by SIGTERM, by Ctrl-C, and when the launcher has gone."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.stop = Event()
        self._parent = int(os.environ.get(PARENT, "0"))
        self._alive = Path(os.environ[ALIVE_FILE]) if ALIVE_FILE in os.environ else None
        self._touched = 0.0
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: self.stop.set())

    def warn(self, line: str) -> None:
        """Writes one line to the process's log; it is lost where the disk is full."""
        with contextlib.suppress(OSError):
            sys.stderr.write(f"{time.strftime('%H:%M:%S')} {self.name}: {line}\n")
            sys.stderr.flush()

    def orphaned(self) -> bool:
        """Whether the launcher is gone."""
        return self._parent != 0 and os.getppid() != self._parent

    def goes_on(self) -> bool:
        """Whether the process is not orphaned; called in the main loop, it is also the sign of life for the launcher."""
        now = time.monotonic()
        if self._alive is not None and now - self._touched > 1:
            with contextlib.suppress(OSError):  # a full disk shall stop nobody
                self._alive.touch()
            self._touched = now
        return not self.orphaned()


@contextmanager
def worker(name: str) -> Iterator[Worker]:
    """Runs a process's body; bad input ends it with its line and exit code 2."""
    life = Worker(name)
    try:
        yield life
    except BadInput as error:
        life.warn(str(error))
        raise SystemExit(2) from error


def lower_priority(nice: int) -> None:
    """Lowers this process's priority by ``nice`` and keeps it from preempting others when it wakes."""
    os.nice(nice)
    if nice and hasattr(os, "SCHED_BATCH"):
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))


def freeze_gc() -> None:
    """Exempts what the start has built from garbage collection, which would halt the process for 0.1 s now and then."""
    gc.collect()
    gc.freeze()
