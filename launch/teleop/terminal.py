"""Keys from a terminal, one at a time, and one line that is written over and over; the terminal is left as it was found."""

import os
import select
import shutil
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from uvf.models.yaml_data import BadInput

ARROWS = {b"A": "up", b"B": "down", b"C": "right", b"D": "left"}
CHUNK = 1024


class TerminalClosed(Exception):
    """The terminal is gone: no key can be pressed any more."""


class Keys:
    """Turns the bytes of a terminal into names of keys; a split escape sequence continues with the next bytes."""

    def __init__(self) -> None:
        self._cut = b""

    def feed(self, data: bytes) -> list[str]:
        r"""Keys in ``data``: ``\x1b[A`` and ``\x1bOA`` are "up", and so on; other sequences are ignored; letters come as typed."""
        data, self._cut = self._cut + data, b""
        found: list[str] = []
        while data:
            if data[:1] != b"\x1b":
                found.append(data[:1].decode("ascii", "replace"))
                data = data[1:]
                continue
            end = _end_of_sequence(data)
            if end is None:
                self._cut = data
                break
            if data[:end][-1:] in ARROWS and end == 3:
                found.append(ARROWS[data[2:3]])
            data = data[end:]
        return found


def _end_of_sequence(data: bytes) -> int | None:
    """Length of the escape sequence that ``data`` begins with; None while its end has not come."""
    if len(data) < 2:
        return None
    if data[1:2] == b"O":
        return 3 if len(data) >= 3 else None
    if data[1:2] != b"[":
        return 1
    return next((i + 1 for i in range(2, len(data)) if 0x40 <= data[i] <= 0x7E), None)


class Terminal:
    """Standard input, read key by key."""

    def __init__(self, file: int) -> None:
        self._file = file
        self._keys = Keys()
        self._pressed: list[str] = []

    def press(self, name: str) -> None:
        """Counts the key as pressed; may be called by a signal's handler."""
        self._pressed.append(name)

    def read(self, patience: float) -> list[str]:
        """Keys pressed, waiting at most ``patience`` [s]. Raises TerminalClosed."""
        ready, _, _ = select.select([self._file], [], [], patience)
        pressed, self._pressed = self._pressed, []
        if pressed or not ready:
            return pressed
        try:
            data = os.read(self._file, CHUNK)
        except OSError as error:
            raise TerminalClosed from error
        if not data:
            raise TerminalClosed
        return self._keys.feed(data)

    def show(self, line: str) -> None:
        """Overwrites the status line, cut to the terminal's width. Raises TerminalClosed."""
        width = shutil.get_terminal_size().columns - 1
        try:
            sys.stdout.write(f"\r\x1b[2K{line[:width]}")
            sys.stdout.flush()
        except OSError as error:
            raise TerminalClosed from error


def _keep_keys_at_signals(file: int) -> None:
    """Or Ctrl-C throws away a key that select has just promised, and reading waits for another one for ever."""
    settings = termios.tcgetattr(file)
    settings[3] |= termios.NOFLSH
    termios.tcsetattr(file, termios.TCSANOW, settings)


@contextmanager
def key_by_key() -> Iterator[Terminal]:
    """The terminal without echo and line buffering, restored at the end. Raises BadInput."""
    file = sys.stdin.fileno()
    if not os.isatty(file):
        raise BadInput("teleop reads keys, but its input is no terminal: run it in one")
    before = termios.tcgetattr(file)
    tty.setcbreak(file)
    _keep_keys_at_signals(file)
    try:
        yield Terminal(file)
    finally:
        with suppress(termios.error, OSError):  # of a terminal that is gone
            termios.tcsetattr(file, termios.TCSADRAIN, before)
            sys.stdout.write("\n")
            sys.stdout.flush()
