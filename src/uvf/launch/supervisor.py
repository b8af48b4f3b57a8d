"""Keeps the processes of a run alive: starts them, starts them again when they die, ends them all."""

import os
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from schemas.messages import Process
from uvf.launch.worker import PARENT

DEATHS = 3
DEATH_WINDOW = 30.0  # s: this many deaths within it, and a process is given up
BAD_INPUT = 2  # exit code: starting it again cannot help
TERM_PATIENCE = 5.0  # s


@dataclass
class Child:
    """One process: its command line, its log file and its history."""

    name: str
    arguments: list[str]
    log: Path
    popen: subprocess.Popen[bytes] | None = None
    state: Process.State = Process.STARTING
    restarts: int = 0
    log_before: int = 0  # bytes in the log when it was started
    reason: str = ""
    deaths: deque[float] = field(default_factory=lambda: deque(maxlen=DEATHS))

    def describe(self) -> Process:
        pid = self.popen.pid if self.popen else 0
        return Process(name=self.name, state=self.state, pid=pid, restarts=self.restarts, reason=self.reason)


class Supervisor:
    """Processes by name. ``tell(line, given_up)`` hears of every death."""

    def __init__(self, logs: Path, tell: Callable[[str, bool], None], environment: Mapping[str, str] | None = None) -> None:
        self.children: dict[str, Child] = {}
        self._logs = logs
        self._tell = tell
        self._environment = {**os.environ, **(environment or {}), PARENT: str(os.getpid()), "PYTHONUNBUFFERED": "1"}

    def start(self, name: str, arguments: list[str]) -> None:
        """Starts ``uvf <arguments>`` with its output in ``<name>.log``."""
        child = Child(name, arguments, self._logs / f"{name}.log")
        self.children[name] = child
        self._spawn(child)

    def _spawn(self, child: Child) -> None:
        with child.log.open("ab") as log:
            child.log_before = log.tell()
            child.popen = subprocess.Popen(
                [sys.executable, "-m", "uvf.launch.cli", *child.arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=self._environment,
                start_new_session=True,  # Ctrl-C in the terminal reaches only the launcher, which ends all in order
            )
        child.state = Process.RUNNING

    def look(self) -> bool:
        """Starts again what has died; True when something has changed."""
        changed = False
        for child in self.children.values():
            if child.state == Process.RUNNING and child.popen is not None and child.popen.poll() is not None:
                self._died(child, child.popen.returncode)
                changed = True
        return changed

    def _died(self, child: Child, code: int) -> None:
        child.deaths.append(time.monotonic())
        child.reason = f"ended by signal {-code}" if code < 0 else f"ended with exit code {code}"
        last = last_line(child.log, child.log_before) if code >= 0 else ""
        if last:
            child.reason += f": {last}"
        often = len(child.deaths) == DEATHS and child.deaths[-1] - child.deaths[0] < DEATH_WINDOW
        if code == BAD_INPUT or often:
            child.state = Process.FAILED
            self._tell(f"{child.name} {child.reason}; given up", True)
            return
        child.restarts += 1
        self._spawn(child)
        self._tell(f"{child.name} {child.reason}; started again", False)

    def kill(self, name: str) -> None:
        """Ends a process that does not answer; ``look`` starts it again."""
        child = self.children.get(name)
        if child is not None and child.popen is not None and child.state == Process.RUNNING:
            child.popen.kill()

    def stop(self) -> None:
        """Ends all, the infrastructure last; what does not end in time is killed."""
        running = [c for c in self.children.values() if c.popen is not None and c.popen.poll() is None]
        last = [c for c in running if c.name == "router"]
        for group in ([c for c in running if c not in last], last):
            for child in group:
                _popen(child).terminate()
            deadline = time.monotonic() + TERM_PATIENCE
            for child in group:
                _wait(_popen(child), deadline)
                child.state = Process.ENDED


def _popen(child: Child) -> subprocess.Popen[bytes]:
    assert child.popen is not None
    return child.popen


def _wait(popen: subprocess.Popen[bytes], deadline: float) -> None:
    try:
        popen.wait(max(deadline - time.monotonic(), 0.1))
    except subprocess.TimeoutExpired:
        popen.kill()
        popen.wait()


def last_line(log: Path, since: int = 0) -> str:
    """The last non-empty line of a log file after ``since`` bytes: mostly the reason of a death."""
    try:
        with log.open("rb") as file:
            file.seek(max(file.seek(0, os.SEEK_END) - 2000, since))
            lines = file.read().decode(errors="replace").splitlines()
    except OSError:
        return ""
    return next((line.strip()[:200] for line in reversed(lines) if line.strip()), "")
