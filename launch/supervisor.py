"""Keeps processes alive: starts them, starts them again when they die or hang, ends them all."""

import contextlib
import os
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from launch.output import Output, Write
from launch.worker import ALIVE_FILE, PARENT
from schemas.messages import Process

DEATHS = 3
DEATH_WINDOW = 30.0  # s: this many deaths within it, and a process is given up
BAD_INPUT = 2  # exit code: starting it again cannot help
TERM_PATIENCE = 20.0  # s; a log is written to its end on a busy machine too
HANGS = 10.0  # s without a sign of life, in which it was not kept waiting for a processor


@dataclass
class Child:
    """One process: its command line, where its output goes, its sign of life and its history."""

    name: str
    arguments: list[str]
    write: Write
    alive: Path
    """Touched each second by the process's main loop, once that has begun."""
    popen: subprocess.Popen[bytes] | None = None
    output: Output | None = None
    touched: int | None = None  # ns, of the file's own clock: only looked at for a change
    heard: float = 0.0  # s, when that changed
    kept_waiting: float = 0.0  # s in all, until then
    hung: bool = False
    state: Process.State = Process.STARTING
    restarts: int = 0
    reason: str = ""
    deaths: deque[float] = field(default_factory=lambda: deque(maxlen=DEATHS))

    def describe(self) -> Process:
        """The process as a message."""
        pid = self.popen.pid if self.popen else 0
        return Process(name=self.name, state=self.state, pid=pid, restarts=self.restarts, reason=self.reason)

    def is_silent(self, now: float) -> bool:
        """Whether its main loop has begun and has shown no sign of life for ``HANGS``; now [s, monotonic].

        Time in which no processor was free for it is not counted: a low-priority process may wait that long on a busy machine.
        """
        touched = None
        with contextlib.suppress(FileNotFoundError):
            touched = self.alive.stat().st_mtime_ns
        if touched != self.touched:
            self.touched, self.heard, self.kept_waiting = touched, now, self._waited()
        return touched is not None and now - self.heard > HANGS + (self._waited() - self.kept_waiting)

    def _waited(self) -> float:
        """Seconds in which its main thread could have run and no processor was free; 0 on systems that do not tell."""
        with contextlib.suppress(OSError):
            return int(Path(f"/proc/{_popen(self).pid}/schedstat").read_text().split()[1]) / 1e9
        return 0.0


class Supervisor:
    """Supervises processes by name. ``tell(line, given_up)`` is called at every death."""

    def __init__(self, tell: Callable[[str, bool], None], environment: Mapping[str, str] | None = None) -> None:
        self.children: dict[str, Child] = {}
        self._tell = tell
        self._alive = TemporaryDirectory(prefix="uvf-")
        self._environment = {**os.environ, **(environment or {}), PARENT: str(os.getpid()), "PYTHONUNBUFFERED": "1"}

    def start(self, name: str, arguments: list[str], write: Write) -> None:
        """Starts ``uvf <arguments>`` and passes on its output line by line."""
        child = Child(name, arguments, write, Path(self._alive.name) / f"{name}.alive")
        self.children[name] = child
        self._spawn(child)

    def _spawn(self, child: Child) -> None:
        child.alive.unlink(missing_ok=True)
        child.touched, child.hung = None, False
        child.popen = subprocess.Popen(
            [sys.executable, "-m", "launch.cli", *child.arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={**self._environment, ALIVE_FILE: str(child.alive)},
            process_group=0,  # Ctrl-C in the terminal reaches only the launcher; a session of its own would void its nice value
        )
        assert child.popen.stdout is not None
        child.output = Output(child.popen.stdout, child.write)
        child.state = Process.RUNNING

    def look(self) -> bool:
        """Restarts what has died and kills what hangs; True when something has changed."""
        changed = False
        for child in self.children.values():
            if child.state != Process.RUNNING:
                continue
            popen = _popen(child)
            if popen.poll() is not None:
                self._died(child, popen.returncode)
                changed = True
            elif child.is_silent(time.monotonic()):
                child.hung = True
                popen.kill()
        return changed

    def _died(self, child: Child, code: int) -> None:
        child.deaths.append(time.monotonic())
        child.reason = _reason(child, code)
        often = len(child.deaths) == DEATHS and child.deaths[-1] - child.deaths[0] < DEATH_WINDOW
        if code == BAD_INPUT or often:
            child.state = Process.FAILED
            self._tell(f"{child.name} {child.reason}; given up", True)
            return
        child.restarts += 1
        self._spawn(child)
        self._tell(f"{child.name} {child.reason}; started again", False)

    def describe(self) -> list[Process]:
        """All processes as messages."""
        return [child.describe() for child in self.children.values()]

    def end(self, but: str = "") -> None:
        """Ends all, or all but one; what does not end in time is killed."""
        running = [c for c in self.children.values() if c.name != but and _popen(c).poll() is None]
        for child in running:
            _popen(child).terminate()
        deadline = time.monotonic() + TERM_PATIENCE
        for child in running:
            _wait(_popen(child), deadline)
            _output(child).finish()
            child.state = Process.ENDED
        if not but:
            self._alive.cleanup()


def _reason(child: Child, code: int) -> str:
    if child.hung:
        return f"was silent for {HANGS:g} s and has been ended"
    if code < 0:
        return f"ended by signal {-code}"
    _output(child).finish()
    last = _output(child).last
    return f"ended with exit code {code}" + (f": {last}" if last else "")


def _output(child: Child) -> Output:
    assert child.output is not None
    return child.output


def _popen(child: Child) -> subprocess.Popen[bytes]:
    assert child.popen is not None
    return child.popen


def _wait(popen: subprocess.Popen[bytes], deadline: float) -> None:
    try:
        popen.wait(max(deadline - time.monotonic(), 0.1))
    except subprocess.TimeoutExpired:
        popen.kill()
        popen.wait()
