"""Runs what may take the whole process with it in a process of its own: an engine of others that aborts on a fault in its file.

The process is started from nothing (a fork of one that has threads can wait for ever for locks that these hold), is used for
several jobs, and ends with its parent. ``python -m uvf.runtime.process.subprocess_jobs`` is its program.
"""

import atexit
import contextlib
import ctypes
import importlib
import os
import select
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import msgspec

from uvf.models.yaml_data import BadInput
from uvf.runtime.process import quiet

T = TypeVar("T")
WORDS = 200  # characters kept of the last thing said
PATIENCE = 600.0  # s, after which a job is ended
IDLE = 20.0  # s without a job after which the process is ended
SPARE = 5.0  # s before that in which it gets no further job
ENDING = 2.0  # s that one without a job has to end
RESULT, REFUSAL = b"r", b"b"
_PR_SET_PDEATHSIG = 1
_mine = threading.local()
"""The worker of each thread: with the thread that has started it, the system ends it."""


class Died(Exception):
    """The process was ended by a signal or did not answer; the text says how, and what was said last."""


def run_in_subprocess(function: Callable[..., T], *arguments: object) -> T:
    """Runs a function of a module in another process: returns what it returns, raises the BadInput that it raises.

    Raises Died where it ends its process. Arguments and result travel as MessagePack and become what the function's annotations say:
    numbers, text, lists, dicts, msgspec structs. What it writes to standard output and error is kept for ``Died``.
    """
    worker: _Worker | None = getattr(_mine, "worker", None)
    if worker is None or not worker.is_ready():
        worker = _mine.worker = _Worker()
    kind, answer = worker.ask(msgspec.msgpack.encode((function.__module__, function.__qualname__, arguments)))
    if kind == REFUSAL:
        raise BadInput(answer.decode())
    result: T = msgspec.msgpack.decode(answer, type=get_type_hints(function)["return"])
    return result


class _Worker:
    """The process as its parent sees it."""

    def __init__(self) -> None:
        self._said = tempfile.TemporaryFile()  # noqa: SIM115
        self._parent = os.getpid()
        self._used = time.monotonic()
        self._answers, writer = os.pipe()
        paths = os.pathsep.join(path or str(Path.cwd()) for path in sys.path)
        self._process = subprocess.Popen(
            (sys.executable, "-m", "uvf.runtime.process.subprocess_jobs", str(writer), str(self._parent)),
            stdin=subprocess.PIPE,
            stdout=self._said,
            stderr=self._said,
            pass_fds=(writer,),
            env=os.environ | {"PYTHONPATH": paths},
            process_group=0,  # Ctrl-C is for the parent
        )
        os.close(writer)
        atexit.register(self.end)

    def is_ready(self) -> bool:
        """Whether it can take a job: not in a fork of the parent, and not when it may just be ending."""
        return self._parent == os.getpid() and time.monotonic() - self._used < IDLE - SPARE and self._process.poll() is None

    def ask(self, job: bytes) -> tuple[bytes, bytes]:
        """Kind and bytes of the answer. Raises Died."""
        self._said.seek(0)
        self._said.truncate()
        assert self._process.stdin is not None
        try:
            with contextlib.suppress(BrokenPipeError):
                self._process.stdin.write(len(job).to_bytes(8, "little") + job)
                self._process.stdin.flush()
            deadline = time.monotonic() + PATIENCE
            answer = self._read(int.from_bytes(self._read(8, deadline), "little"), deadline)
        except BaseException:
            self.end(patience=0.0)
            raise
        self._used = time.monotonic()
        return answer[:1], answer[1:]

    def _read(self, size: int, deadline: float) -> bytes:
        """Raises Died."""
        read = bytearray()
        while len(read) < size:
            if not select.select((self._answers,), (), (), max(deadline - time.monotonic(), 0))[0]:
                raise Died(f"not done within {PATIENCE:g} s")
            part = os.read(self._answers, size - len(read))
            if not part:
                raise Died(self._last_words())
            read += part
        return bytes(read)

    def _last_words(self) -> str:
        code = self._process.wait()
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        self._said.seek(0)
        lines = [line.strip() for line in self._said.read().decode(errors="replace").splitlines() if line.strip()]
        return f"{how}: {' '.join(lines)[-WORDS:]}" if lines else how

    def end(self, patience: float = ENDING) -> None:
        """Ends the process; within ``patience`` [s] it can end a process of its own before, which nobody else would wait for."""
        if self._parent != os.getpid() or self._said.closed:
            return
        atexit.unregister(self.end)
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(patience)
        self._process.kill()
        self._process.wait()
        os.close(self._answers)
        self._said.close()


def serve(answers: int, parent: int) -> None:
    """Main loop of the other process: does jobs until none comes any more.

    A job in an engine's own code hears nothing but the system's signal.
    """
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        return
    with open(answers, "wb") as out, open(sys.stdin.fileno(), "rb", buffering=0, closefd=False) as jobs:
        while select.select((jobs,), (), (), IDLE)[0]:
            head = jobs.read(8)
            if not head:
                return
            size, job = int.from_bytes(head, "little"), b""
            while len(job) < size:
                job += jobs.read(size - len(job))
            answer = _done(*msgspec.msgpack.decode(job))
            out.write(len(answer).to_bytes(8, "little") + answer)
            out.flush()


def _done(module: str, name: str, arguments: list[Any]) -> bytes:
    """Kind and bytes of the answer; errors other than BadInput end the process and are its last words."""
    with quiet.c_output_to(f"/proc/self/fd/{quiet.OUTPUT}"):
        function = getattr(importlib.import_module(module), name)
        hints = [hint for name, hint in get_type_hints(function).items() if name != "return"]
        try:
            result = function(*(msgspec.convert(a, hint) for a, hint in zip(arguments, hints, strict=True)))
        except BadInput as error:
            return REFUSAL + str(error).encode()
        return RESULT + msgspec.msgpack.encode(result)


if __name__ == "__main__":
    serve(int(sys.argv[1]), int(sys.argv[2]))
