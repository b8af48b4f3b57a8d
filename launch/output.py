"""What a child process prints: read as it comes and handed on, to a log file that never grows beyond its share."""

import contextlib
from collections.abc import Callable
from pathlib import Path
from threading import Lock, Thread
from typing import IO

from uvf.runtime.messages.validation import legible

KEPT = 10_000_000  # bytes of a log, in two files
LONGEST_LINE = 65_536  # bytes; a longer one is handed on in pieces
LAST_SHOWN = 200  # characters of the last line
READ_PATIENCE = 1.0  # s

Write = Callable[[bytes], object]


class RotatingLog:
    """``x.log``; once it holds half of ``kept`` bytes it becomes ``x.log.1``, and the one that was so called goes.

    Only the launcher writes to it, whole lines in order, so that none is lost or torn between the two.
    """

    def __init__(self, path: Path, kept: int = KEPT) -> None:
        self._path = path
        self._half = kept // 2
        self._lock = Lock()
        self._file = path.open("ab", buffering=0)

    def write(self, line: bytes) -> None:
        """Raises OSError where the disk is full."""
        with self._lock:
            size = self._file.tell()
            if size and size + len(line) > self._half:
                self._file.close()
                self._path.replace(self._path.with_name(f"{self._path.name}.1"))
                self._file = self._path.open("ab", buffering=0)
            self._file.write(line)


class Output:
    """Reads a process's output in a thread until it ends; ``last`` is its last line, mostly the reason of a death."""

    def __init__(self, pipe: IO[bytes], write: Write) -> None:
        self.last = ""
        self._thread = Thread(target=self._read, args=(pipe, write), daemon=True)
        self._thread.start()

    def _read(self, pipe: IO[bytes], write: Write) -> None:
        with pipe:
            for line in iter(lambda: pipe.readline(LONGEST_LINE), b""):
                # Lost where the disk is full, but read on: a full pipe would hold the process up.
                with contextlib.suppress(OSError):
                    write(line)
                self.last = legible(line.decode(errors="replace"), LAST_SHOWN) or self.last

    def finish(self) -> None:
        """Waits until what a dead process has printed is read; not for ever, a child of its own may hold the pipe open."""
        self._thread.join(READ_PATIENCE)
