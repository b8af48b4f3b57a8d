"""``uvf bench slam``: its cases come from the data, its rows from runs."""

import os
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from benchmarks.slam import methods
from benchmarks.slam.evaluation.variants import VARIANTS
from launch.cli import app
from tests.slam.room_log import write_room_log
from uvf.models.yaml_data import BadInput
from uvf.slam.methods import METHODS


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """A folder with a log and its relations, one without, and one that is none."""
    folder = tmp_path_factory.mktemp("data")
    for name in ("room", "bare"):
        (folder / "slam" / name).mkdir(parents=True)
    write_room_log(folder / "slam" / "room")
    write_room_log(folder / "slam" / "bare").rename(folder / "slam" / "bare" / "bare.clf")
    (folder / "slam" / "bare" / "room.relations").unlink()
    (folder / "slam" / "broken.clf").write_text("FLASER 3 1 1\n")
    return folder


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return tmp_path_factory.mktemp("runs")


@pytest.fixture(autouse=True)
def results_elsewhere(runs, monkeypatch):
    monkeypatch.setenv("UVF_RUNS", str(runs))


@pytest.fixture(scope="module")
def done():
    """Outcomes so far."""
    return {}


@pytest.fixture
def in_this_process(monkeypatch, done):
    """Without a process of its own, which takes seconds to start."""

    def outcome(log, method, variant):
        if (log, method, variant) not in done:
            best = None if variant == methods.UNCHANGED else outcome(log, methods.DEFAULT_METHOD, methods.UNCHANGED).poses["final"]
            done[log, method, variant] = methods.measured(log, method, variant, best)
        return done[log, method, variant]

    monkeypatch.setattr(methods, "_outcome", outcome)


def test_every_log_runs_by_every_method_and_those_with_relations_on_harder_variants(data):
    found = methods.cases(data)
    assert {name.split(":")[0] for name in found} == {"room", "bare", "broken"}
    assert {name.split(":")[1] for name in found} == set(METHODS)
    assert {name.split(":")[2] for name in found if name.startswith(f"room:{methods.DEFAULT_METHOD}:")} == set(VARIANTS)
    assert {name.split(":")[2] for name in found if name.startswith("bare:")} == {methods.UNCHANGED}


def test_published_figures_stand_beside_logs_of_their_name(data, tmp_path, monkeypatch):
    path = tmp_path / "published.yaml"
    path.write_text("room:\n  Somebody: {m: 0.02, deg: 0.4}\n")
    monkeypatch.setattr(methods, "PUBLISHED", path)
    case = methods.cases(data)["room:published:Somebody"]
    assert case(data) == {"room:published:Somebody": {"m": 0.02, "deg": 0.4}}
    assert not any("Somebody" in name for name in methods.cases(data) if not name.startswith("room:"))


def test_a_harder_variant_is_compared_with_the_same_relations_of_the_plain_log(data, in_this_process, runs):
    plain, thinned = (methods.cases(data)[f"room:graph:{v}"](data) for v in (methods.UNCHANGED, "every-third"))
    final, harder = plain["room:graph:plain final"], thinned["room:graph:every-third final"]
    assert (final["pairs"], final["> 0.5 m"], harder["pairs"]) == (28, 0, 26)
    assert 0.0 < final["m"] < 0.02
    assert 0.3 < harder["x m"] < 3.0
    assert "x m" not in final
    assert {p.name for p in (runs / "slam" / "bench").iterdir()} >= {"room-graph-plain", "room-graph-every-third"}
    assert (runs / "slam" / "bench" / "room-graph-plain" / "map.png").stat().st_size > 0


def test_odometry_twice_as_wrong_is_twice_as_wrong(data, in_this_process):
    plain = methods.cases(data)["room:odometry:plain"](data)["room:odometry:plain final"]
    doubled = methods._case(data / "slam" / "room" / "room.clf", "room", "odometry", "error-x2", data)["room:odometry:error-x2 final"]
    assert plain["deg"] > 0.1
    assert doubled["x deg"] == pytest.approx(2.0, abs=0.4)


def test_a_variant_that_no_relation_outlives_has_a_row_without_errors(data, in_this_process):
    outcome = methods._outcome(data / "slam" / "room" / "room.clf", "odometry", "plain")
    bare = replace(outcome, relations={"none": methods.NOTHING}, figures={**outcome.figures, "relations": {"none": {"final": {}}}})
    whole = replace(outcome, relations={"none": methods.NOTHING})
    assert methods._row(bare, whole, "final")["pairs"] == 0


def test_a_file_that_is_no_log_is_told_and_passed_over(data, in_this_process, capsys):
    assert methods.cases(data)["broken:odometry:plain"](data) == {}
    assert "broken.clf: no scan can be read" in capsys.readouterr().err


def test_a_case_runs_in_a_process_that_has_one_core_and_one_thread(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("NUMBA_NUM_THREADS", raising=False)
    assert len(methods.alone(os.sched_getaffinity, 0)) == 1
    assert methods.alone(os.getenv, "OMP_NUM_THREADS") == "1"
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "NUMBA_NUM_THREADS" not in os.environ


def test_the_command_prints_the_rows_of_the_cases_named(data, in_this_process):
    answer = CliRunner().invoke(app, ["bench", "slam", "bare:odometry", "--data", str(data)])
    assert answer.exit_code == 0, answer.output
    assert "bare:odometry:plain final" in answer.output
    assert "room" not in answer.output


def test_without_logs_the_command_says_what_is_missing(tmp_path):
    with pytest.raises(BadInput, match="--data"):
        methods.cases(None)
    answer = CliRunner().invoke(app, ["bench", "slam", "--data", str(tmp_path)])
    assert (answer.exit_code, answer.output.count("\n")) == (2, 1)
    assert "no folder" in answer.output
