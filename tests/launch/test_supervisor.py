"""Processes that die come back at once; those that die too often, or of bad input, are given up."""

import os
import signal
import time

import pytest

from schemas.messages import Process
from uvf.launch.supervisor import DEATHS, Supervisor, last_line

PATIENCE = 20.0


@pytest.fixture
def supervised(tmp_path):
    told = []
    supervisor = Supervisor(tmp_path, lambda line, given_up: told.append((line, given_up)), {"UVF_ROUTER": "tcp/127.0.0.1:9"})
    yield supervisor, told
    supervisor.stop()
    for child in supervisor.children.values():
        assert child.popen.poll() is not None


def until(supervisor, condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        supervisor.look()
        time.sleep(0.02)


def test_a_killed_process_is_started_again_and_its_end_told(supervised):
    supervisor, told = supervised
    supervisor.start("recorder", ["record", "/nowhere"])
    child = supervisor.children["recorder"]
    first = child.popen.pid
    os.kill(first, signal.SIGKILL)
    until(supervisor, lambda: child.restarts == 1)
    assert child.popen.pid != first
    assert child.state == Process.RUNNING
    assert told == [("recorder ended by signal 9; started again", False)]


def test_three_deaths_in_a_row_give_it_up(supervised):
    supervisor, told = supervised
    supervisor.start("recorder", ["record", "/nowhere"])
    child = supervisor.children["recorder"]
    for _ in range(DEATHS):
        deaths = len(child.deaths)
        os.kill(child.popen.pid, signal.SIGKILL)
        until(supervisor, lambda n=deaths: len(child.deaths) > n)
    assert child.state == Process.FAILED
    assert told[-1] == ("recorder ended by signal 9; given up", True)


def test_bad_input_is_not_tried_again_and_its_line_is_told(supervised):
    supervisor, told = supervised
    supervisor.start("slam", ["service", "slm"])
    until(supervisor, lambda: bool(told))
    line, given_up = told[0]
    assert given_up
    assert "no service 'slm'; did you mean 'slam'?" in line


def test_the_last_line_of_a_log_is_the_reason_unless_it_is_of_the_one_before(tmp_path):
    log = tmp_path / "x.log"
    log.write_text("one\nTraceback\nValueError: two\n\n")
    assert last_line(log) == "ValueError: two"
    assert last_line(log, log.stat().st_size) == ""
    assert last_line(tmp_path / "missing") == ""
