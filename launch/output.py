"""What a child process prints: read as it comes and handed on, to a log file that never grows beyond its share."""

import contextlib
import sys
from collections.abc import Callable
from logging import LogRecord, makeLogRecord
from logging.handlers import RotatingFileHandler
from pathlib import Path
from threading import Thread
from typing import IO

from uvf.runtime.messages.validation import legible

KEPT = 10_000_000  # bytes of a log, in two files
LONGEST_LINE = 65_536  # bytes; a longer one is handed on in pieces
LAST_SHOWN = 200  # characters of the last line
READ_PATIENCE = 1.0  # s

Write = Callable[[bytes], object]


class RotatingLog(RotatingFileHandler):
    """``x.log``; once it holds half of ``kept`` bytes it replaces ``x.log.1``, and a new one begins.

    Only the launcher writes to it, whole lines in order, so that none is lost or torn between the two.
    """

    terminator = ""  # lines bring their own

    def __init__(self, path: Path, kept: int = KEPT) -> None:
        # Latin-1 keeps every byte as it is, and the handler, which counts characters, then counts bytes.
        super().__init__(path, maxBytes=kept // 2, backupCount=1, encoding="latin-1")

    def write(self, line: bytes) -> None:
        """Appends a line. Raises OSError where the disk is full."""
        self.handle(makeLogRecord({"msg": line.decode("latin-1")}))

    def handleError(self, record: LogRecord) -> None:
        """Reraises the error, so that the writer decides what is done about it."""
        if (error := sys.exception()) is not None:
            raise error


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
        """Waits a limited time until the output of a dead process is read; a child of its own may hold the pipe open."""
        self._thread.join(READ_PATIENCE)
