"""Keeps what a library writes from C off the standard output and error."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

OUTPUT, ERRORS = 1, 2


@contextmanager
def c_errors_discarded() -> Iterator[None]:
    """pybullet writes a line when it is imported; logs and terminals shall not hold it. Exceptions still come through."""
    with _discarded(ERRORS):
        yield


@contextmanager
def c_output_discarded() -> Iterator[None]:
    """JSBSim tells in many lines what it then raises in one. Exceptions still come through."""
    with _discarded(OUTPUT), _discarded(ERRORS):
        yield


@contextmanager
def _discarded(descriptor: int) -> Iterator[None]:
    _flush()
    kept = os.dup(descriptor)
    nowhere = os.open(os.devnull, os.O_WRONLY)
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
