"""``uvf teleop`` in a terminal of its own, on a bus where the vehicle is only listened for."""

import os
import pty
import subprocess
import sys
import termios
import time

import pytest

from schemas import topics
from schemas.messages import ArmRequest, DriveCommand, ModeRequest, Reply
from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router

PATIENCE = 90.0  # s
IGNORING_CTRL_C = 'trap \'\' INT; exec "$0" "$@"'  # as in all that is started from the background of a shell: the harder case


class Session:
    """The command in a terminal: ``ours`` is where the person sits."""

    def __init__(self):
        endpoint = f"tcp/127.0.0.1:{free_port()}"
        self.router = open_router(endpoint)
        self.bus = ZenohBus(endpoint)
        self.commands, self.asked = [], []
        drive = topics.DRIVE.by("teleop")
        self.bus.subscribe(drive.at("burger"), drive.qos, lambda s: self.commands.append(DriveCommand.FromString(s.payload)), depth=1000)
        for request in (topics.SET_MODE, topics.ARM):
            self.bus.serve(request.at("burger"), lambda query, r=request: self._answer(r, query))
        self.ours, self.its = pty.openpty()
        self.settings = termios.tcgetattr(self.its)
        self.process = subprocess.Popen(
            ["sh", "-c", IGNORING_CTRL_C, "setsid", "--ctty", sys.executable, "-m", "launch.cli", "teleop", "burger", "-m", "demo"],
            stdin=self.its,
            stdout=self.its,
            stderr=self.its,
            cwd=ROOT,
            env={**os.environ, "UVF_ROUTER": endpoint, "TERM": "xterm"},
        )

    def _answer(self, request, query):
        self.asked.append(request.message.FromString(query.payload))
        query.answer(Reply(accepted=True).SerializeToString(), 0)

    def until(self, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end
            self.bus.wait(0.02)
            self.bus.poll()

    def drive(self):
        """Presses w again and again until the vehicle is told to go."""
        self.until(lambda: len(self.asked) == 2)

        def goes():
            os.write(self.ours, b"w")
            return self.commands and self.commands[-1].linear > 0

        self.until(goes)

    def wait_for_zero_and_end(self):
        self.until(lambda: self.process.poll() is not None)
        self.until(lambda: self.commands[-1].linear == 0)

    def close(self):
        self.process.kill()
        self.process.wait()
        for file in (self.its, self.ours):
            try:
                os.close(file)
            except OSError:
                continue
        self.bus.close()
        self.router.close()


@pytest.fixture
def session():
    made = Session()
    yield made
    made.close()


def test_it_takes_over_drives_and_ctrl_c_leaves_vehicle_and_terminal_at_rest(session):
    session.drive()
    assert [type(m) for m in session.asked] == [ModeRequest, ArmRequest]
    assert session.commands[-1].linear == 0.5
    assert termios.tcgetattr(session.its) != session.settings
    os.write(session.ours, b"\x03")
    session.wait_for_zero_and_end()
    assert session.process.returncode == 0
    assert termios.tcgetattr(session.its) == session.settings


def test_a_terminal_that_is_closed_stops_the_vehicle(session):
    session.drive()
    os.close(session.its)
    os.close(session.ours)
    session.wait_for_zero_and_end()


def test_nobody_at_the_keys_means_zero_and_then_silence(session):
    session.drive()
    session.until(lambda: session.commands[-1].linear == 0)
    quiet_since, count = time.monotonic(), len(session.commands)

    def silent():
        nonlocal quiet_since, count
        if len(session.commands) != count:
            quiet_since, count = time.monotonic(), len(session.commands)
        return time.monotonic() - quiet_since > 1.0

    session.until(silent)
    assert session.process.poll() is None
