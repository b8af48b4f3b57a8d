"""Keeps what a library writes from C, when it is imported, off the standard error."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def c_errors_discarded() -> Iterator[None]:
    """pybullet writes a line when it is imported; logs and terminals shall not hold it. Exceptions still come through."""
    sys.stderr.flush()
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
