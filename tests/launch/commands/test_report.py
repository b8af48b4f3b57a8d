"""``uvf log`` and ``uvf replay``: a log alone is enough, services go by the names that are printed elsewhere, odd input is one line."""

import pytest

from launch.attachments import attachments
from launch.commands.log_tools import describe_log, replay_into
from launch.commands.run import run_and_report
from launch.run import run_lockstep
from services.slam.odometry.service import OdometryService
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.reading import log_attachments
from uvf.runtime.log.recording import Recorder


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "log-000.mcap"
    run_lockstep(load_scenario(ROOT / "missions" / "demo.yaml"), 1.0, path)
    return path


@pytest.mark.parametrize(
    ("name", "vehicle", "instances"),
    [
        ("autopilot", None, "autopilot_air of milvus, autopilot_ground of burger"),
        ("autopilot", "burger", "autopilot_ground of burger"),
        ("autopilot_ground", None, "autopilot_ground of burger"),
        ("odometry", "burger", "odometry of burger"),
    ],
)
def test_a_log_is_replayed_into_a_service_by_the_names_of_uvf_service_and_node_list(log, capsys, name, vehicle, instances):
    assert replay_into(log, name, vehicle, None) == 0
    assert capsys.readouterr().out.strip() == f"{instances}: output is identical"


@pytest.mark.parametrize(
    ("name", "vehicle", "line"),
    [
        ("odometri", None, "no service 'odometri' in demo.yaml to replay into; did you mean 'odometry'?"),
        ("odometry", "milvus", "no service 'odometry' of 'milvus' in demo.yaml"),
        ("slam", "burgr", "no vehicle 'burgr' in demo.yaml; did you mean 'burger'?"),
    ],
)
def test_a_name_that_is_not_there_is_one_line(log, name, vehicle, line):
    with pytest.raises(BadInput, match=line.replace("?", r"\?")):
        replay_into(log, name, vehicle, None)


def test_a_log_without_its_mission_names_the_flag(tmp_path):
    with Recorder(tmp_path / "a.mcap"):
        pass
    with pytest.raises(BadInput, match="--mission"):
        replay_into(tmp_path / "a.mcap", "odometry", None, None)


def test_a_run_attaches_what_was_run(log):
    assert log_attachments(log) == attachments(load_scenario(ROOT / "missions" / "demo.yaml"))


def test_a_log_is_described_by_topic(log, capsys):
    describe_log(log)
    lines = capsys.readouterr().out.splitlines()
    imu = next(line for line in lines if line.startswith("uvf/milvus/sensor/imu "))
    assert "uvf.v1.Imu" in imu and "100.0 Hz" in imu
    assert "complete: true" in lines and {"hash", "recorded", "python", "jsbsim"} <= {line.partition(": ")[0] for line in lines}


def test_an_empty_log_is_described_too(tmp_path, capsys):
    with Recorder(tmp_path / "a.mcap"):
        pass
    describe_log(tmp_path / "a.mcap")
    assert "0 messages, 0.0 s" in capsys.readouterr().out


def test_a_mission_in_which_an_instance_has_failed_is_not_passed(tmp_path, capsys, monkeypatch):
    def fails(self, t, given):
        raise ZeroDivisionError("as told")

    monkeypatch.setattr(OdometryService, "step", fails)
    monkeypatch.setattr(OdometryService, "stale", fails)
    assert run_and_report("demo", 0.5, tmp_path / "log.mcap", []) == 1
    said = capsys.readouterr()
    assert "odometry of burger failed: 3 of its steps" in said.err
    assert "burger since" in said.out and "autopilot in mode" in said.out  # why the criteria do not hold
