"""``uvf log events`` and ``uvf log echo``: of one log, or of all logs of a run."""

import pytest
from typer.testing import CliRunner

from launch.cli import app
from schemas import topics
from schemas.messages import Event, NavStatus
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.recording import Recorder

PLANNER, SYSTEM = topics.EVENTS.by("planner").at("kart"), topics.SYSTEM_EVENTS.by("recorder").at("sys")


def sample(key, message, t, seq):
    return Sample(key, message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), seq, 0)


STATUS = sample(topics.NAV_STATUS.at("kart"), NavStatus(reason="waiting for map"), 0.5, 1)
FIRST = [
    sample(PLANNER, Event(severity=Event.WARNING, text="no way", cause="walls"), 2.0, 1),
    sample(SYSTEM, Event(text="recording"), 1.0, 1),
    STATUS,
]
SECOND = [STATUS, sample(topics.NAV_STATUS.at("kart"), NavStatus(reason="outside"), 3.0, 2), sample(PLANNER, Event(severity=9), 4.0, 2)]


@pytest.fixture
def run(tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    for number, samples in enumerate((FIRST, SECOND)):
        with Recorder(folder / f"log-00{number}.mcap") as recorder:
            for each in samples:
                recorder.write(each)
    (tmp_path / "latest").symlink_to("run")
    return tmp_path / "latest"


def said(*arguments, code=0):
    result = CliRunner().invoke(app, ["log", *map(str, arguments)])
    assert result.exit_code == code, result.output
    return result.output.splitlines()


def test_events_come_in_order_with_time_vehicle_severity_text_and_cause(run):
    assert [line.strip() for line in said("events", run)] == [
        "1.000 s  system  info: recording",
        "2.000 s  kart  warning: no way (cause: walls)",
        f"4.000 s  kart  {PLANNER}: broken uvf.v1.Event: severity: 9 is none of INFO, NOTICE, WARNING, ERROR, CRITICAL",
    ]
    assert len(said("events", run / "log-000.mcap")) == 2


def test_info_counts_over_all_logs_of_a_run_and_what_is_repeated_once(run):
    lines = said("info", run)
    assert [line.split()[2] for line in lines[:3]] == ["2", "2", "1"]
    assert lines[3] == "5 messages, 4.0 s"


def test_of_a_log_that_was_cut_off_info_tells_what_is_whole_and_that_it_is_not(run):
    cut = run / "log-001.mcap"
    cut.write_bytes(cut.read_bytes()[:-100])
    lines = said("info", cut)
    assert "3 messages, 4.0 s" in lines
    assert lines[-1] == f"{cut}: still being written, or cut off: this is what is whole of it"
    assert not any(line.startswith("hash") for line in lines)
    assert "5 messages, 4.0 s" in said("info", run)


def test_a_log_without_events_says_so(tmp_path):
    with Recorder(tmp_path / "a.mcap"):
        pass
    assert said("events", tmp_path / "a.mcap") == [f"no events in {tmp_path / 'a.mcap'}"]


def test_echo_prints_the_messages_of_a_key_once(run):
    lines = said("echo", run, "kart/nav/status")
    assert lines == [
        "--- uvf/kart/nav/status  0.500 s  #1",
        'reason: "waiting for map"',
        "--- uvf/kart/nav/status  3.000 s  #2",
        'reason: "outside"',
    ]
    assert said("echo", run, "*/nav/status", "-n", "1") == lines[:2]


def test_a_key_that_the_log_has_not_is_one_line(run):
    (line,) = said("echo", run, "kart/nav/statu", code=2)
    assert line.endswith("no messages of 'kart/nav/statu'; did you mean 'kart/nav/status'?")
