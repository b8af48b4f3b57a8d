"""``uvf up`` waits for its own router however slowly it starts, says so once, and gives up with it or on Ctrl-C."""

import os
import threading
import time

import pytest

from launch import up
from launch.launcher import Launcher
from launch.up import RunningMission, StartOptions
from tests.runtime.modes import free_port
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.zenoh_bus import open_router


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_ROUTER", f"tcp/127.0.0.1:{free_port()}")
    monkeypatch.setattr(up, "ATTEMPT", 0.3)
    monkeypatch.setattr(Launcher, "start", lambda *arguments: None)
    said = []
    mission = RunningMission(StartOptions("demo"), tmp_path, said.append)
    mission.said = said
    yield mission
    mission.launcher.stop()


def test_a_router_that_comes_late_is_waited_for(run):
    opened = []
    timer = threading.Timer(1.5, lambda: opened.append(open_router(os.environ["UVF_ROUTER"])))
    timer.start()
    assert run._connect(threading.Event()) is not None
    timer.join()
    run.launcher.stop()
    opened[0].close()
    assert run.said == ["waiting for the router, which is slow to start"]


def test_one_that_never_comes_is_bad_input(run, monkeypatch):
    monkeypatch.setattr(up, "ROUTER_PATIENCE", 0.5)
    with pytest.raises(BadInput, match="no router"):
        run._connect(threading.Event())


def test_ctrl_c_ends_the_wait(run):
    stop = threading.Event()
    stop.set()
    begun = time.monotonic()
    assert run._connect(stop) is None and time.monotonic() - begun < 1.0
