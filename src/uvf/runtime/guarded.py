"""Runs what may take the whole process with it in a copy of the process: an engine of others that aborts on a fault in its file."""

import gc
import os
import pickle
import select
import signal
import tempfile
from collections.abc import Callable
from typing import IO, TypeVar

import psutil

from uvf.runtime import quiet
from uvf.runtime.params import BadInput

T = TypeVar("T")
WORDS = 200  # characters kept of the last thing said
PATIENCE = 600  # s, after which the copy is ended
IDLE = 20.0  # s without work after which it has taken a lock along from a thread that is not in the copy: another one is made
COPIES = 2


class Died(Exception):
    """The copy was ended by a signal; the text says which, and what was said last."""


def guarded(work: Callable[[], T]) -> T:
    """What ``work`` returns, which must be picklable; or the BadInput that it raises. Raises Died, too."""
    for _ in range(COPIES):
        try:
            return _once(work)
        except _Stuck:
            continue
    raise Died(f"does nothing for {IDLE} s")


class _Stuck(Exception):
    """The copy does nothing."""


def _once(work: Callable[[], T]) -> T:
    """Raises _Stuck."""
    with tempfile.NamedTemporaryFile() as said:
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reader)
            _answer(work, writer, said.name)
        os.close(writer)
        with os.fdopen(reader, "rb") as pipe:
            _wait(child, reader)
            answer = pipe.read()
        _, status = os.waitpid(child, 0)
        if not answer:
            raise Died(_last_words(status, said))
    result = pickle.loads(answer)
    if isinstance(result, BadInput):
        raise result
    value: T = result
    return value


def _wait(child: int, reader: int) -> None:
    """Until there is something to be read. Raises _Stuck, with the copy ended, when it has not worked for so long."""
    worked = -1.0
    while not select.select((reader,), (), (), IDLE)[0]:
        now = sum(psutil.Process(child).cpu_times()[:2])
        if now == worked:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            raise _Stuck
        worked = now


def _answer(work: Callable[[], T], writer: int, said: str) -> None:
    """In the copy; never returns."""
    code = 1
    gc.disable()  # what it would collect may wait for ever for threads that are not in the copy: a session of Zenoh does
    signal.signal(signal.SIGALRM, signal.SIG_DFL)  # an engine that hangs in its own code hears nothing else
    signal.alarm(PATIENCE)
    try:
        with quiet.c_output_to(said):
            try:
                result: T | BadInput = work()
            except BadInput as error:
                result = error
        with os.fdopen(writer, "wb") as pipe:
            pipe.write(pickle.dumps(result))
        code = 0
    finally:
        os._exit(code)


def _last_words(status: int, said: IO[bytes]) -> str:
    number = os.waitstatus_to_exitcode(status)
    if number == -signal.SIGALRM:
        return f"not done within {PATIENCE} s"
    how = signal.Signals(-number).name if number < 0 else f"exit code {number}"
    lines = [line.strip() for line in said.read().decode(errors="replace").splitlines() if line.strip()]
    return f"{how}: {' '.join(lines)[-WORDS:]}" if lines else how
