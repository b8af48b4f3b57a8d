"""``uvf run`` and the tools for logs: what is there already is not lost, and what is refused leaves no run behind."""

import pytest

from tests.launch.test_cli import uvf

MISSION = """about: A rover stands.
world: house
duration: 0.3
vehicles:
  anne: {model: burger, system_id: 1, start: {x: 2.2, y: 1.3, yaw: 0.5}}
criteria:
  - {vehicle: anne, measure: contacts, at_most: 0}
"""


@pytest.fixture
def mission(tmp_path):
    path = tmp_path / "stands.yaml"
    path.write_text(MISSION)
    return path


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """Of a run of a few ticks."""
    folder = tmp_path_factory.mktemp("runs")
    (folder / "stands.yaml").write_text(MISSION)
    assert uvf("run", str(folder / "stands.yaml"), "--log", str(folder / "log-000.mcap")).returncode == 0
    return folder / "log-000.mcap"


def run(*arguments, runs):
    return uvf("run", *map(str, arguments), UVF_RUNS=str(runs))


def test_a_mission_that_is_refused_begins_no_run(tmp_path, mission):
    runs = tmp_path / "runs"
    mission.write_text("")
    for arguments in ((), ("--set", "duration=3"), ("--seeds", "2")):
        assert run(mission, *arguments, runs=runs).returncode == 2
    assert not runs.exists()


def test_a_log_is_not_written_over_what_is_none(tmp_path, mission):
    said = run(mission, "--log", mission, runs=tmp_path)
    assert said.returncode == 2
    assert f"--log {mission}: is there and is no log; choose another name" in said.stderr
    assert mission.read_text() == MISSION


def test_a_log_that_is_replaced_is_told(tmp_path, mission):
    for told in (False, True):
        said = run(mission, "--log", tmp_path / "a.mcap", runs=tmp_path)
        assert (said.returncode, "the log that was there is replaced" in said.stderr) == (0, told)


def test_a_run_that_could_not_be_recorded_has_not_succeeded(tmp_path, mission):
    said = run(mission, "--log", "/dev/full", runs=tmp_path)
    assert said.returncode == 1
    assert "No space left on device" in said.stderr


@pytest.mark.parametrize("arguments", [("--seeds", "2", "--log", "x.mcap"), ("--until", "1e-9")])
def test_what_cannot_be_meant_is_refused(tmp_path, mission, arguments):
    assert run(mission, *arguments, runs=tmp_path).returncode == 2


@pytest.mark.parametrize("tool", ["page", "layout"])
def test_what_is_made_of_a_log_does_not_replace_it(log, tool):
    before = log.read_bytes()
    said = uvf("log", tool, str(log), "--out", str(log))
    assert said.returncode == 2
    assert "is no log; give it another ending" in said.stderr
    assert log.read_bytes() == before


def test_a_recovered_log_stands_for_the_broken_one_and_a_part_is_no_second_log(tmp_path, log):
    whole = log.read_bytes()
    (tmp_path / "log-000.mcap").write_bytes(whole)
    exported = uvf("log", "export", str(tmp_path), "anne/nav/odometry").stdout
    assert uvf("log", "cut", str(tmp_path / "log-000.mcap"), "--from", "0.1", "--to", "0.2").returncode == 0
    assert uvf("log", "export", str(tmp_path), "anne/nav/odometry").stdout == exported
    (tmp_path / "log-000.mcap").write_bytes(whole[: len(whole) * 2 // 3])
    assert "cut off: this is what is whole of it" in uvf("log", "export", str(tmp_path), "anne/nav/odometry").stderr
    assert uvf("log", "recover", str(tmp_path / "log-000.mcap")).returncode == 0
    again = uvf("log", "export", str(tmp_path), "anne/nav/odometry")
    assert (again.returncode, again.stderr) == (0, "")
    assert 0 < int(again.stdout.split()[0]) <= int(exported.split()[0])


def test_without_criteria_the_tasks_decide_and_what_was_not_done_is_told(tmp_path, mission):
    begin, _ = MISSION.split("criteria:")
    mission.write_text(begin + "tasks:\n  - {name: late, when: {at: 99}, arm: anne}\n")
    said = run(mission, runs=tmp_path)
    assert said.returncode == 1
    assert "task late: not begun: waits until it is 99 s" in said.stdout
    mission.write_text(begin + "tasks:\n  - {name: soon, when: {at: 0.2}}\n")
    assert run(mission, runs=tmp_path).returncode == 0


PROGRAM = """from uvf.runtime.contract.program import Program


class Broken(Program):
    name = "broken"
    hz = 10.0

    def step(self, t, now):
        raise ValueError("no good")
"""


def test_a_run_whose_program_fails_has_failed_in_its_report_too(tmp_path, mission):
    (tmp_path / "broken.py").write_text(PROGRAM)
    mission.write_text(MISSION.replace("yaw: 0.5}", "yaw: 0.5}, program: broken.py"))
    said = run(mission, runs=tmp_path / "runs")
    assert said.returncode == 1 and "broken of anne failed" in said.stderr
    latest = tmp_path / "runs" / "latest"
    for tool in (("report", str(latest)), ("compare", str(latest), str(latest))):
        assert "broken of anne has failed" in uvf(*tool, "--out", str(tmp_path / "out")).stderr
    assert '<span class="FAILED">FAILED</span>' in (tmp_path / "out" / "report.html").read_text()


def test_a_run_that_was_stopped_is_not_taken_for_a_whole_one(tmp_path, mission):
    mission.write_text(MISSION.replace("duration: 0.3", "duration: 30"))
    assert run(mission, "--until", "0.5", "--log", tmp_path / "log-000.mcap", runs=tmp_path).returncode == 0
    said = uvf("report", str(tmp_path), "--out", str(tmp_path / "out"))
    assert f"uvf: {tmp_path}: stopped at 0.5 s of 30 s" in said.stderr
    page = (tmp_path / "out" / "report.html").read_text()
    assert '<span class="passed">passed so far</span>' in page and "stopped at 0.5 s of 30 s" in page
