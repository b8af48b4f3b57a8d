"""``uvf slam`` on a small log of a made-up room."""

import json

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from launch.cli import app
from tests.slam.room_log import PERIOD, READINGS, stamps, true_way, write_room_log
from uvf.maths.se2_arrays import composed, inverted
from uvf.models.scenario import ROOT
from uvf.models.world.map_file import load_map
from uvf.slam.evaluation.reference import Trajectory, absolute_error, read_trajectory
from uvf.slam.evaluation.relations import read_relations
from uvf.slam.maps.session import MappingSession

TRUTH = Trajectory(stamps(), true_way())


def slam(*words):
    return CliRunner().invoke(app, ["slam", *map(str, words)])


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """(what was printed, folder) of a run of the default method."""
    folder = tmp_path_factory.mktemp("slam")
    answer = slam(write_room_log(folder), "--out", folder / "results")
    assert answer.exit_code == 0, answer.output
    return answer.output, folder / "results"


def test_the_results_are_all_there(done):
    printed, folder = done
    names = {"trajectory.txt", "trajectory_online.txt", "map.pgm", "map.yaml", "figures.json", "params.yaml", "report.md"}
    assert names | {"map.png", "report.png", "session.npz"} == {p.name for p in folder.iterdir()}
    assert "errors of room.relations" in printed
    assert str(folder) in printed


def test_the_trajectory_is_that_of_the_room(done):
    final = read_trajectory(done[1] / "trajectory.txt")
    assert len(final) == READINGS
    assert final.stamps == pytest.approx(stamps())
    assert absolute_error(final, TRUTH).max < 0.03


def test_the_session_is_that_of_the_map(done):
    session = MappingSession.load(done[1] / "session.npz")
    assert session.method == "graph"
    assert len(session.keyframes) == json.loads((done[1] / "figures.json").read_text())["run"]["keyframes"]


def test_the_figures_are_those_of_the_trajectory(done):
    """The relations are the true motions: so the distances worked out here from the files must be those told."""
    told = json.loads((done[1] / "figures.json").read_text())["relations"]["room.relations"]["final"]
    final, relations = read_trajectory(done[1] / "trajectory.txt"), read_relations(done[1].parent / "room.relations")
    ends = np.rint((relations.stamps - stamps()[0]) / PERIOD).astype(int)
    moved = [composed(inverted(poses[ends[:, 0]]), poses[ends[:, 1]]) for poses in (final.world_from_base, true_way())]
    errors = np.hypot(*(moved[0] - moved[1])[:, :2].T)
    assert told["all"]["freiburg_m"]["mean"] == pytest.approx(errors.mean(), abs=1e-5)
    assert told["all"]["freiburg_m"]["max"] == pytest.approx(errors.max(), abs=1e-5)
    assert (told["near"]["number"], told["far"]["number"], told["all"]["gross"]) == (26, 2, 0)
    assert told["all"]["freiburg_m"]["mean"] < 0.02


def test_the_map_has_walls_where_the_room_has_them(done):
    """The room is 6 m by 4 m; the map begins at the first pose, which looks along y."""
    grid = load_map(done[1] / "map.yaml")
    rows, columns = np.nonzero(grid.cells > 50)
    width, height = np.ptp(columns) * grid.resolution, np.ptp(rows) * grid.resolution
    assert (min(width, height), max(width, height)) == pytest.approx((4.0, 6.0), abs=0.3)


def test_the_parameters_that_were_in_force_are_kept(done, tmp_path):
    kept = yaml.safe_load((done[1] / "params.yaml").read_text())
    assert kept["method"] == "graph"
    assert kept["params"]["keyframe_distance"] > 0.0
    answer = slam(write_room_log(tmp_path), "--set", "keyframe_distance=0.7", "--out", tmp_path / "r", "--resolution", "0.1")
    assert answer.exit_code == 0, answer.output
    kept = yaml.safe_load((tmp_path / "r" / "params.yaml").read_text())
    assert (kept["params"]["keyframe_distance"], kept["resolution"]) == (0.7, 0.1)


def test_odometry_alone_is_worse(done, tmp_path):
    answer = slam(write_room_log(tmp_path), "--method", "odometry", "--out", tmp_path / "r")
    assert answer.exit_code == 0, answer.output
    odometry, graph = (read_trajectory(folder / "trajectory.txt") for folder in (tmp_path / "r", done[1]))
    assert absolute_error(odometry, TRUTH).max > 2.0 * absolute_error(graph, TRUTH).max


def test_a_recorded_run_is_scored_by_the_truth(tmp_path):
    answer = slam(ROOT / "tests" / "golden" / "demo.mcap", "--out", tmp_path, "--method", "odometry")
    assert answer.exit_code == 0, answer.output
    truth = json.loads((tmp_path / "figures.json").read_text())["references"]["truth"]["final"]
    assert truth["absolute"]["number"] == 40
    assert truth["absolute"]["max_m"] < 0.05


def test_notes_on_the_log_are_told_once_and_stand_in_the_report(tmp_path):
    path = write_room_log(tmp_path)
    path.write_text(path.read_text() + "ROBOTLASER1 cut off\n")
    answer = slam(path, "--method", "odometry", "--out", tmp_path / "r")
    assert answer.output.count("left out 1 lines with") == 1
    assert "left out 1 lines with" in (tmp_path / "r" / "report.md").read_text()


def test_relations_of_another_log_are_refused(tmp_path):
    (tmp_path / "foreign.txt").write_text("1 2 0 0 0 0 0 0\n")
    answer = slam(write_room_log(tmp_path), "--relations", tmp_path / "foreign.txt", "--out", tmp_path / "r")
    assert (answer.exit_code, answer.output.count("\n")) == (2, 1)
    assert "foreign.txt: none of them is between two readings of the log" in answer.output


def test_a_folder_of_results_that_is_none_is_told_before_the_run(tmp_path):
    (tmp_path / "taken").write_text("")
    answer = slam(write_room_log(tmp_path), "--out", tmp_path / "taken")
    assert (answer.exit_code, answer.output.count("\n")) == (2, 1)
    assert "taken: cannot be a folder: File exists" in answer.output


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--method", "grpah"), "no SLAM method 'grpah'; did you mean 'graph'?"),
        (("--set", "keyframe_dist=1"), "did you mean 'keyframe_distance'?"),
        (("--set", "keyframe_distance=far"), "keyframe_distance: 'far' is not a number"),
        (("--set", "keyframe_distance"), "write NAME=VALUE"),
        (("--relations", "missing.relations"), "missing.relations: No such file"),
        (("--vehicle", "burger"), "leave out --vehicle"),
    ],
)
def test_bad_words_are_answered_in_one_line(tmp_path, words, told):
    answer = slam(write_room_log(tmp_path), *words, "--out", tmp_path / "r")
    assert answer.exit_code == 2
    assert told in answer.output
    assert answer.output.count("\n") == 1
    assert not (tmp_path / "r").exists()
