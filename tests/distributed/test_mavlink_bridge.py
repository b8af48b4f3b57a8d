"""``uvf mavlink-bridge`` as a person starts it: one run's aircraft on another bus, and what happens when that run dies and returns."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest

import uvf
from schemas import topics
from schemas.messages import Mode, ModeRequest, SetCurrentRequest
from tests.distributed.system import PATIENCE, System
from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT
from uvf.runtime.messages.convert import array

MISSION = "circuit"
METRES = 40.0  # between two looks while the machine is busy
UVF = (sys.executable, "-m", "launch.cli")


class OtherBus:
    """A router of its own and the bridge; a context manager."""

    def __init__(self, mavlink, folder):
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self._environment = {**os.environ, "UVF_ROUTER": self.endpoint}
        self._address = f"udpin:127.0.0.1:{mavlink}"
        self.output = folder / "bridge.txt"

    def start(self, *arguments):
        with self.output.open("ab") as out:
            return subprocess.Popen(
                [sys.executable, "-m", "launch.cli", *arguments], cwd=ROOT, env=self._environment, stdout=out, stderr=out
            )

    def __enter__(self):
        self._started = [self.start("router"), self.start("mavlink-bridge", self._address, "--name", "plane2", "-m", MISSION)]
        try:
            self.client = uvf.connect(self.endpoint, timeout=PATIENCE)
        except BaseException:
            self._end()
            raise
        return self

    def _end(self):
        for popen in reversed(self._started):
            popen.terminate()
        return [popen.wait(timeout=30) for popen in self._started]

    def __exit__(self, *_):
        self.client._bus.close()
        assert self._end() == [0, 0], self.output.read_text()

    def status(self):
        return self.client.read("plane2", topics.STATUS)

    def wait(self, condition, what, seconds=30.0):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, f"{what}; {self.output.read_text()}"
            time.sleep(0.05)


@pytest.fixture
def runs(tmp_path):
    """The first run and the one that takes its place, at the same MAVLink port."""
    folders = [tmp_path / name for name in ("first", "again")]
    for folder in folders:
        folder.mkdir()
    first, again = (System(folder, mission=MISSION) for folder in folders)
    again.environment["UVF_MAVLINK_TARGETS"] = first.environment["UVF_MAVLINK_TARGETS"]
    return first, again


@pytest.mark.timeout(4 * PATIENCE)
def test_an_aircraft_of_another_run_is_on_this_bus_while_that_lives_and_again_when_it_returns(runs, tmp_path):
    first, again = runs
    with OtherBus(first.mavlink, tmp_path) as here:
        with first:
            seen(here, first)
            obeys(here, first)
        here.wait(lambda: any("link lost" in text for text in here.status().failsafes), "nobody says that the link is lost")
        reply = here.client.ask("plane2", topics.SET_MODE, ModeRequest(mode=Mode.MODE_HOLD))
        assert not reply.accepted and reply.reason == "no link to the autopilot"
        with again:
            here.wait(lambda: not here.status().failsafes, "the link does not come back")
            seen(here, again)


def seen(here, run):
    """Where it is, with its plan."""
    here.client.read("plane2", topics.NAV_STATE, PATIENCE)
    before = here.client.heard("plane2", topics.NAV_STATE)
    here.wait(lambda: here.client.heard("plane2", topics.NAV_STATE) > before + 20, "no news")
    nav, truth = here.client.read("plane2", topics.NAV_STATE), run.client.read("milvus", topics.TRUTH)
    assert np.linalg.norm(array(nav.position) - array(truth.position)) < METRES
    plan = run.client.read("milvus", topics.MISSION)
    here.wait(lambda: len(here.client.read("plane2", topics.MISSION, 20.0).items) == len(plan.items), "its mission does not come")


def obeys(here, run):
    assert here.client.ask("plane2", topics.SET_MODE, ModeRequest(mode=Mode.MODE_HOLD)).accepted
    here.wait(lambda: run.client.read("milvus", topics.STATUS).mode == Mode.MODE_HOLD, "the aircraft does not hold")
    here.wait(lambda: here.status().mode == Mode.MODE_HOLD, "it is not told")
    refused = here.client.ask("plane2", topics.SET_CURRENT, SetCurrentRequest(index=99))
    assert not refused.accepted and "no mission item 99" in refused.reason


def test_an_address_that_makes_no_sense_is_refused_in_one_line():
    for wrong, why in (("tcp:127.0.0.1:5760", "no such kind"), ("udpin:14550", "not host:port"), ("udp:127.0.0.1:99999", "not host:port")):
        done = subprocess.run(
            [sys.executable, "-m", "launch.cli", "mavlink-bridge", wrong], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert done.returncode == 2 and why in done.stderr and len(done.stderr.strip().splitlines()) == 1, done.stderr
