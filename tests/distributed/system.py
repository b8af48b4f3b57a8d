"""The whole system as a person starts it, on ports of its own."""

import os
import signal
import subprocess
import sys
import time

import psutil

import uvf
from schemas import topics
from schemas.messages import Process
from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT

PATIENCE = 90.0


class System:
    """``uvf up`` in a process of its own; a context manager that checks that nothing is left behind."""

    def __init__(self, runs, *arguments, page=False, mission="demo", programs=()):
        """programs: ports to which MAVLink is sent, besides ``mavlink``."""
        self.router, self.page, self.mavlink = (free_port() for _ in range(3))
        self.maps = runs / "state" / "maps"
        self.endpoint = f"tcp/127.0.0.1:{self.router}"
        self.environment = {
            **os.environ,
            "UVF_ROUTER": self.endpoint,
            "UVF_GCS_PORT": str(self.page),
            "UVF_MAVLINK_TARGETS": ",".join(f"127.0.0.1:{port}" for port in (self.mavlink, *programs)),
            "UVF_MAVLINK_LISTEN": f"127.0.0.1:{free_port()}",
            "UVF_RUNS": str(runs),
            "UVF_STATE": str(runs / "state"),
        }
        self._command = [sys.executable, "-m", "launch.cli", "up", mission, *([] if page else ["--no-gcs"]), *arguments]
        self._output = runs / "up.txt"

    def __enter__(self):
        with self._output.open("wb") as out:
            self.popen = subprocess.Popen(self._command, cwd=ROOT, env=self.environment, stdout=out, stderr=out)
        try:
            end = time.monotonic() + PATIENCE
            while "time runs" not in self.said():
                assert self.popen.poll() is None and time.monotonic() < end, self.said()
                time.sleep(0.1)
            self.client = uvf.connect(self.endpoint)
        except BaseException:
            self.popen.terminate()
            self.popen.wait()
            raise
        return self

    def said(self):
        return self._output.read_text()

    def children(self):
        """The processes of the run by name, as the launcher tells them."""
        return {p.name: p for p in self.client.read("sys", topics.PROCESSES.by("launcher")).processes}

    def kill(self, name):
        """kill -9, and wait until the launcher has started it again."""
        before = self.children()[name]
        os.kill(before.pid, signal.SIGKILL)

        def again():
            now = self.children()[name]
            return now.restarts > before.restarts and now.state == Process.RUNNING

        self.client.wait(again, 20.0, f"{name} is not started again")

    def __exit__(self, *_):
        self.client._bus.close()
        family = [] if self.popen.poll() is not None else psutil.Process(self.popen.pid).children(recursive=True)
        if family:
            self.popen.send_signal(signal.SIGINT)
        self.popen.wait(timeout=60)
        _, alive = psutil.wait_procs(family, timeout=1)
        assert not alive, f"left behind: {alive}"
