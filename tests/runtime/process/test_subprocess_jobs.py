"""What ends a process ends only the one that it was given, and no such process outlives its parent."""

import os
import signal
import subprocess
import sys
import threading
import time

import psutil
import pytest

from tests.runtime import jobs
from uvf.models.yaml_data import BadInput
from uvf.runtime.process import subprocess_jobs
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess

HANGING = """
import sys
from tests.runtime import jobs
from uvf.runtime.process.subprocess_jobs import run_in_subprocess
run_in_subprocess(jobs.hang, sys.argv[1])
"""


def test_an_answer_comes_back_with_its_types():
    assert run_in_subprocess(jobs.pid) != os.getpid()
    assert run_in_subprocess(jobs.heavier, jobs.Body("a", float("nan")), 2.0)[1] == ["heavier"]
    assert run_in_subprocess(jobs.heavier, jobs.Body("a", 1.0), 2.0) == (jobs.Body("a", 3.0), ["heavier"])


def test_several_jobs_need_one_process():
    assert len({run_in_subprocess(jobs.pid) for _ in range(5)}) == 1


def test_bad_input_is_raised_here_and_ends_nothing():
    before = run_in_subprocess(jobs.pid)
    with pytest.raises(BadInput, match="a line"):
        run_in_subprocess(jobs.refuse)
    assert run_in_subprocess(jobs.pid) == before


def test_another_error_is_told_with_its_last_words():
    with pytest.raises(Died, match=r"exit code 1: .*KeyError: 'no such table'"):
        run_in_subprocess(jobs.fail)


def test_nothing_that_it_writes_is_seen(capfd):
    assert run_in_subprocess(jobs.shout) == 1
    assert capfd.readouterr() == ("", "")


def test_an_abort_is_told_with_the_last_words_even_where_output_is_discarded_and_the_next_job_is_done():
    run_in_subprocess(jobs.shout)
    with pytest.raises(Died, match=r"^SIGABRT: FATAL: no such table$"):
        run_in_subprocess(jobs.abort)
    assert run_in_subprocess(jobs.pid) != os.getpid()


def test_an_end_without_an_answer_is_told():
    with pytest.raises(Died, match=r"^exit code 3$"):
        run_in_subprocess(jobs.leave)


def test_what_never_ends_is_ended(monkeypatch, tmp_path):
    monkeypatch.setattr(subprocess_jobs, "PATIENCE", 3.0)
    with pytest.raises(Died, match="not done within 3 s"):
        run_in_subprocess(jobs.hang, str(tmp_path / "pid"))
    assert not psutil.pid_exists(int((tmp_path / "pid").read_text()))


def test_a_process_that_may_be_ending_is_not_asked_again(monkeypatch):
    before = run_in_subprocess(jobs.pid)
    monkeypatch.setattr(subprocess_jobs, "IDLE", subprocess_jobs.SPARE)
    assert run_in_subprocess(jobs.pid) != before


def test_one_that_was_killed_is_replaced():
    before = run_in_subprocess(jobs.pid)
    os.kill(before, signal.SIGKILL)
    psutil.wait_procs([psutil.Process(before)], timeout=10)
    assert run_in_subprocess(jobs.pid) != before


def test_each_thread_has_its_own():
    found = []
    thread = threading.Thread(target=lambda: found.append(run_in_subprocess(jobs.pid)))
    thread.start()
    thread.join()
    assert found and found[0] != run_in_subprocess(jobs.pid)


def test_a_fork_does_not_use_the_process_of_its_parent():
    before = run_in_subprocess(jobs.pid)
    reader, writer = os.pipe()
    if os.fork() == 0:
        os.write(writer, str(run_in_subprocess(jobs.pid)).encode())
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        assert int(pipe.read()) != before
    os.wait()
    assert run_in_subprocess(jobs.pid) == before


def test_a_job_does_not_outlive_a_parent_that_is_killed(tmp_path):
    file = tmp_path / "pid"
    with subprocess.Popen((sys.executable, "-c", HANGING, str(file))) as parent:
        deadline = time.monotonic() + 30
        while not (file.exists() and file.read_text()):
            assert parent.poll() is None and time.monotonic() < deadline
        job = psutil.Process(int(file.read_text()))
        parent.kill()
    gone, _ = psutil.wait_procs([job], timeout=10)
    assert gone == [job]


def test_one_that_has_a_process_of_its_own_ends_that_too():
    below = run_in_subprocess(jobs.pid_of_another)
    assert psutil.pid_exists(below)
    subprocess_jobs._mine.worker.end()
    assert not psutil.pid_exists(below)  # not even as one that nobody has waited for
