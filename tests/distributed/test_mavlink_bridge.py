"""``uvf mavlink-bridge`` as a person starts it: one run's vehicles on another bus, and what happens when that run dies and returns."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest

import uvf
from schemas import topics
from schemas.convert import array
from schemas.messages import ArmRequest, Mode, ModeRequest
from tests.distributed.system import PATIENCE, System
from tests.runtime.modes import free_port
from uvf.runtime.site import ROOT

UVF = (sys.executable, "-m", "uvf.launch.cli")


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
                [sys.executable, "-m", "uvf.launch.cli", *arguments], cwd=ROOT, env=self._environment, stdout=out, stderr=out
            )

    def __enter__(self):
        names = ("--name", "plane2=1", "--name", "rover2=2")
        self._started = [self.start("router"), self.start("mavlink-bridge", self._address, *names, "-m", "demo")]
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

    def status(self, name):
        return self.client.read(name, topics.STATUS)

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
    first, again = (System(folder) for folder in folders)
    again.environment["UVF_MAVLINK_TARGETS"] = first.environment["UVF_MAVLINK_TARGETS"]
    return first, again


@pytest.mark.timeout(4 * PATIENCE)
def test_the_vehicles_of_another_run_are_on_this_bus_while_it_lives_and_again_when_it_returns(runs, tmp_path):
    first, again = runs
    with OtherBus(first.mavlink, tmp_path) as here:
        with first:
            seen(here, first)
            obeys(here, first)
        here.wait(lambda: any("link lost" in text for text in here.status("plane2").failsafes), "nobody says that the link is lost")
        reply = here.client.ask("plane2", topics.SET_MODE, ModeRequest(mode=Mode.MODE_HOLD))
        assert not reply.accepted and reply.reason == "no link to the autopilot"
        with again:
            here.wait(lambda: not here.status("plane2").failsafes and not here.status("rover2").failsafes, "the link does not come back")
            seen(here, again)


def seen(here, run):
    """Both vehicles, where they are, with their plans."""
    for name, owner, metres in (("plane2", "milvus", 30.0), ("rover2", "burger", 1.0)):
        nav = here.client.read(name, topics.NAV_STATE, PATIENCE)
        before = here.client.heard(name, topics.NAV_STATE)
        here.wait(lambda n=name, b=before: here.client.heard(n, topics.NAV_STATE) > b + 20, "no news")
        nav, truth = here.client.read(name, topics.NAV_STATE), run.client.read(owner, topics.TRUTH)
        assert np.linalg.norm(array(nav.position) - array(truth.position)) < metres
    here.wait(lambda: len(here.client.read("plane2", topics.MISSION, 20.0).items) == 5, "its mission does not come")
    assert here.status("plane2").armed and here.status("rover2").kind == 1


def obeys(here, run):
    assert here.client.ask("plane2", topics.SET_MODE, ModeRequest(mode=Mode.MODE_RETURN)).accepted
    here.wait(lambda: run.client.read("milvus", topics.STATUS).mode == Mode.MODE_RETURN, "the aircraft does not return")
    here.wait(lambda: here.status("plane2").mode == Mode.MODE_RETURN, "it is not told")
    refused = here.client.ask("plane2", topics.ARM, ArmRequest(arm=False))
    assert not refused.accepted and "the aircraft is flying" in refused.reason


def test_an_address_that_makes_no_sense_is_refused_in_one_line():
    for wrong, why in (("tcp:127.0.0.1:5760", "no such kind"), ("udpin:14550", "not host:port"), ("udp:127.0.0.1:99999", "not host:port")):
        done = subprocess.run(
            [sys.executable, "-m", "uvf.launch.cli", "mavlink-bridge", wrong], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert done.returncode == 2 and why in done.stderr and len(done.stderr.strip().splitlines()) == 1, done.stderr
