"""The demo mission to its end, by the command that people type: every criterion holds, and another process writes the same bytes."""

import os
import re
import subprocess
import sys

import pytest

from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.log.reading import log_metadata, read_log

pytestmark = pytest.mark.timeout(300)
DEMO = ROOT / "missions" / "demo.yaml"
BEGINNING = 30.0  # s; both vehicles move, the map grows, loops are closed: a difference would not wait until the end


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """(what the command said, its log)"""
    log = tmp_path_factory.mktemp("demo") / "log.mcap"
    command = [sys.executable, "-m", "launch.cli", "run", "demo", "--lockstep", "--until", "120", "--log", str(log)]
    environment = {**os.environ, "PYTHONHASHSEED": "7", "COLUMNS": "200"}
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300, check=False), log


def test_every_criterion_holds_and_it_exits_with_0(demo):
    done, _ = demo
    verdicts = re.findall(r"\b(passed|failed)\b", done.stdout)
    assert (verdicts.count("passed"), verdicts.count("failed"), done.returncode) == (8, 0, 0), done.stdout + done.stderr


def test_nothing_is_missing_in_its_log(demo):
    done, log = demo
    said = log_metadata(log)
    assert (said["carried"], said["complete"]) == ("0", "true")
    assert said["hash"] == re.search(r"hash (\w{64})", done.stdout.replace("\n", "")).group(1)
    assert int(said["messages"]) == sum(1 for _ in read_log(log))


def beginning(log):
    """What was said up to then: key, stamp, sequence number and bytes."""
    found = [(s.key, s.stamp_ns, s.seq, s.payload) for s in read_log(log) if s.stamp_ns <= BEGINNING * 1e9]
    return sorted(found)


def test_another_process_gives_the_same_bytes(demo, tmp_path):
    run_lockstep(load_scenario(DEMO), BEGINNING, tmp_path / "log.mcap")
    again = beginning(tmp_path / "log.mcap")
    assert len(again) > 10_000
    assert again == beginning(demo[1])
