"""Processes that die or hang come back at once; those that die too often, or of bad input, are given up."""

import os
import signal
import time

import pytest

from schemas.messages import Process
from tests.runtime.modes import free_port
from uvf.launch import supervisor as module
from uvf.launch.supervisor import DEATHS, Supervisor

PATIENCE = 20.0


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
