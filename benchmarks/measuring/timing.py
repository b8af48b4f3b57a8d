"""How long a piece of work or a simulation takes, on the processor and on the clock."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TypeVar

from uvf.runtime.log.recording import Recorder
from uvf.runtime.time.lockstep import Lockstep

T = TypeVar("T")

WARM_UP = 0.5  # s of simulation: what is compiled is compiled


def on_thread(work: Callable[[], T]) -> tuple[float, T]:
    """CPU milliseconds of this thread for a piece of work, and its result; what else the machine does counts little."""
    begun = time.thread_time()
    found = work()
    return 1e3 * (time.thread_time() - begun), found


@contextmanager
def stopwatch() -> Iterator[list[float]]:
    """CPU and wall seconds, when it is over."""
    cpu, wall = time.process_time(), time.perf_counter()
    taken: list[float] = []
    yield taken
    taken += [time.process_time() - cpu, time.perf_counter() - wall]


def timed(lockstep: Lockstep, seconds: float, log: Path | None) -> list[float]:
    """CPU and wall seconds of so many ``seconds`` of simulation, with an MCAP log of everything where one is given."""
    lockstep.run(WARM_UP)
    with ExitStack() as open_log:
        if log is not None:
            open_log.enter_context(Recorder(log)).follow(lockstep.bus)
        with stopwatch() as taken:
            lockstep.run(WARM_UP + seconds)
    return taken
