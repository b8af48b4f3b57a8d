"""Keeps what a library writes from C off the standard output and error."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

OUTPUT, ERRORS = 1, 2
_sink = ContextVar("_sink", default=os.devnull)


@contextmanager
def c_errors_discarded() -> Iterator[None]:
    """Discards what is written to standard error from C: pybullet writes a line when it is imported. Exceptions still come through."""
    with _discarded(ERRORS):
        yield


@contextmanager
def c_output_discarded() -> Iterator[None]:
    """Discards what is written from C: JSBSim tells in many lines what it then raises in one. Exceptions still come through."""
    with _discarded(OUTPUT), _discarded(ERRORS):
        yield


@contextmanager
def c_output_to(path: str) -> Iterator[None]:
    """Keeps what is written from C in a file, also what would be discarded within."""
    before = _sink.set(path)
    try:
        with c_output_discarded():
            yield
    finally:
        _sink.reset(before)


@contextmanager
def _discarded(descriptor: int) -> Iterator[None]:
    _flush()
    kept = os.dup(descriptor)
    nowhere = os.open(_sink.get(), os.O_WRONLY | os.O_APPEND)
    os.dup2(nowhere, descriptor)
    try:
        yield
    finally:
        _flush()
        os.dup2(kept, descriptor)
        os.close(kept)
        os.close(nowhere)


def _flush() -> None:
    """Python's and C's own buffers."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)
