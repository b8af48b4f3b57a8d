"""The demo mission to its end: every criterion holds, and a run of its own in another process gives the same bytes."""

import os
import re
import subprocess
import sys

import pytest

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.log.reading import log_metadata

DEMO = ROOT / "missions" / "demo.yaml"


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    log = tmp_path_factory.mktemp("demo") / "log.mcap"
    return run_lockstep(load_scenario(DEMO), 120.0, log), log


def test_every_criterion_holds(demo):
    result, _ = demo
    assert len(result.verdicts) == 8
    assert {v.criterion.measure: v.value for v in result.verdicts if not v.passed} == {}


def test_nothing_is_missing_in_its_log(demo):
    result, log = demo
    assert log_metadata(log) == {"messages": str(result.messages), "carried": "0", "complete": "true", "hash": result.log_hash}


def test_another_process_gives_the_same_bytes_and_exits_with_0(demo, tmp_path):
    command = [sys.executable, "-m", "launch.cli", "run", "demo", "--lockstep", "--until", "120", "--log", str(tmp_path / "log.mcap")]
    environment = {**os.environ, "PYTHONHASHSEED": "7"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert re.search(r"hash (\w{64})", done.stdout.replace("\n", "")).group(1) == demo[0].log_hash
