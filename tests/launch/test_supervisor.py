"""Processes that die or hang come back at once; those that die too often, or of bad input, are given up."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from launch import supervisor as module
from launch.supervisor import DEATHS, HANGS, Child, Supervisor
from schemas.messages import Process
from tests.runtime.modes import free_port

PATIENCE = 20.0
BUSY = "while True: pass"


def nowhere(line):
    pass


@pytest.fixture
def supervised():
    told = []
    supervisor = Supervisor(lambda line, given_up: told.append((line, given_up)), {"UVF_ROUTER": "tcp/127.0.0.1:9"})
    yield supervisor, told
    supervisor.end()
    for child in supervisor.children.values():
        assert child.popen.poll() is not None


def until(supervisor, condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        supervisor.look()
        time.sleep(0.02)


def test_a_killed_process_is_started_again_and_its_end_told(supervised, tmp_path):
    supervisor, told = supervised
    supervisor.start("recorder", ["record", str(tmp_path)], nowhere)
    child = supervisor.children["recorder"]
    first = child.popen.pid
    os.kill(first, signal.SIGKILL)
    until(supervisor, lambda: child.restarts == 1)
    assert child.popen.pid != first
    assert child.state == Process.RUNNING
    assert told == [("recorder ended by signal 9; started again", False)]


def test_three_deaths_in_a_row_give_it_up(supervised, tmp_path):
    supervisor, told = supervised
    supervisor.start("recorder", ["record", str(tmp_path)], nowhere)
    child = supervisor.children["recorder"]
    for _ in range(DEATHS):
        deaths = len(child.deaths)
        os.kill(child.popen.pid, signal.SIGKILL)
        until(supervisor, lambda n=deaths: len(child.deaths) > n)
    assert child.state == Process.FAILED
    assert told[-1] == ("recorder ended by signal 9; given up", True)


def test_bad_input_is_not_tried_again_and_its_line_is_told(supervised):
    supervisor, told = supervised
    supervisor.start("slam", ["service", "slm"], nowhere)
    until(supervisor, lambda: bool(told))
    line, given_up = told[0]
    assert given_up
    assert "no service 'slm'; did you mean 'slam'?" in line


def test_a_process_whose_loop_no_longer_goes_round_is_ended_and_started_again(supervised, monkeypatch):
    supervisor, told = supervised
    monkeypatch.setattr(module, "HANGS", 2.0)
    supervisor.start("router", ["router", "--listen", f"tcp/127.0.0.1:{free_port()}"], nowhere)
    child = supervisor.children["router"]
    until(supervisor, child.alive.exists)
    hung = child.popen.pid
    os.kill(hung, signal.SIGSTOP)
    until(supervisor, lambda: child.restarts == 1)
    assert child.popen.pid != hung
    assert told == [("router was silent for 2 s and has been ended; started again", False)]


def test_a_process_that_has_not_begun_its_loop_is_given_all_the_time_it_needs(supervised, monkeypatch, tmp_path):
    """Waiting for a router or compiling kernels is no hanging."""
    supervisor, _ = supervised
    printed = []
    monkeypatch.setattr(module, "HANGS", 0.0)
    supervisor.start("recorder", ["record", str(tmp_path)], printed.append)
    until(supervisor, lambda: any(b"waiting: no router" in line for line in printed))
    assert supervisor.children["recorder"].restarts == 0
    assert supervisor.children["recorder"].state == Process.RUNNING


@pytest.fixture
def child(tmp_path):
    alive = tmp_path / "alive"
    alive.touch()
    return Child("toy", [], print, alive)


def test_without_a_sign_of_life_it_hangs(child, monkeypatch):
    monkeypatch.setattr(Child, "_waited", lambda self: 3.0)
    assert not child.is_silent(100.0)
    assert not child.is_silent(100.0 + HANGS)
    assert child.is_silent(100.1 + HANGS)


def test_the_time_in_which_there_was_no_processor_for_it_does_not_count(child, monkeypatch):
    waited = [3.0]
    monkeypatch.setattr(Child, "_waited", lambda self: waited[0])
    assert not child.is_silent(100.0)
    waited[0] += 8.0
    assert not child.is_silent(107.9 + HANGS)
    assert child.is_silent(108.1 + HANGS)


@pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="this system does not tell how long a process waits")
def test_two_on_one_processor_keep_each_other_waiting(child):
    command = [sys.executable, "-c", f"import os; os.sched_setaffinity(0, [{min(os.sched_getaffinity(0))}])\n{BUSY}"]
    child.popen, other = subprocess.Popen(command), subprocess.Popen(command)
    try:
        end = time.monotonic() + 30
        while child._waited() < 0.5:
            assert time.monotonic() < end
            time.sleep(0.01)
    finally:
        for popen in (child.popen, other):
            popen.kill()
            popen.wait()
    assert child._waited() == 0.0
