"""However a process ends, it ends: no hang, no abort."""

import os
import signal
import subprocess
import sys

import pytest

from tests.runtime.modes import free_port
from uvf.models.scenario import ROOT
from uvf.runtime.bus.zenoh_bus import open_router

PATIENCE = 20.0


@pytest.fixture(scope="module")
def endpoint():
    where = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(where)
    yield where
    router.close()


def start(case, endpoint, **environment):
    command = [sys.executable, "-m", "tests.distributed.scripts", case, endpoint]
    pipe = subprocess.PIPE
    return subprocess.Popen(
        command, cwd=ROOT, stdout=pipe, stderr=pipe, text=True, env={**os.environ, "UVF_ROUTER": endpoint, **environment}
    )


def finish(process):
    try:
        _, errors = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        pytest.fail("hangs")
    return process.returncode, errors


@pytest.mark.parametrize(
    ("case", "code"), [("normal_end", 0), ("sys_exit", 3), ("exception", 1), ("unanswered_query", 0), ("publishing_thread", 0)]
)
def test_every_way_out_of_the_block_closes_the_session(endpoint, case, code):
    returned, errors = finish(start(case, endpoint))
    assert returned == code, errors
    assert ("RuntimeError: boom" in errors) == (case == "exception")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.parametrize("case", ["waiting", "unreachable"])
def test_a_signal_ends_it_in_order(endpoint, case, number):
    process = start(case, endpoint if case == "waiting" else f"tcp/127.0.0.1:{free_port()}")
    process.stdout.readline()
    process.send_signal(number)
    code, errors = finish(process)
    assert code == 0, errors


def test_it_ends_when_its_launcher_is_gone(endpoint):
    process = start("waiting", endpoint, UVF_PARENT="1" if os.getpid() != 1 else "2")
    assert finish(process)[0] == 0
