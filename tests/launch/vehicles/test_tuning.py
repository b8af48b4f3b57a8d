"""``uvf vehicle tune``: figures from the model, margins of the loops, and a vehicle.yaml that keeps what it says."""

import functools

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from launch.commands.vehicle import vehicle_app
from launch.vehicles.tuning import SECONDS, tune, with_params
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput, FileLocation

PLACE = FileLocation("vehicle.yaml")
FIGURES = {"roll_p": 0.05123456, "roll_time": 0.3}


tuned = functools.cache(tune)  # many steady flights: once for each aircraft


@pytest.fixture(params=["milvus", "stick25"])
def tuning(request):
    return tuned(ROOT / "vehicles" / request.param)


def test_the_loops_are_stable_with_room(tuning):
    for loop in tuning.loops:
        assert np.degrees(loop.margins.phase) > (30.0 if loop.axis == "height" else 45.0), loop.axis
        assert not loop.margins.gain < 2.0, loop.axis  # that of airspeed is without end
        assert loop.margins.delay > 0.1, loop.axis


def test_a_step_ends_at_what_is_asked_and_does_not_swing(tuning):
    for loop in tuning.loops:
        t = np.linspace(0.0, SECONDS[loop.axis], 121)
        step = loop.step(t)
        assert step[0] == pytest.approx(0.0, abs=0.01)
        assert step[-1] == pytest.approx(1.0, abs=0.15), loop.axis
        assert step.max() < 1.2, loop.axis


def test_the_vehicles_have_the_figures_that_their_models_give(tuning):
    for name in ("alpha_zero_lift", "elev_zero_alpha"):
        assert tuning.before[name] == pytest.approx(tuning.figures[name], abs=2e-3)
    for name in ("alpha_per_load", "elev_per_alpha", "roll_ff", "pitch_ff", "trim_throttle", "flap_alpha"):
        assert tuning.before[name] == pytest.approx(tuning.figures[name], rel=0.02), name


def test_what_cannot_bank_is_refused():
    with pytest.raises(BadInput, match="nothing that the autopilot moves makes it roll"):
        tune(ROOT / "vehicles" / "nas10")


def test_it_is_printed_drawn_and_nothing_is_written_without_being_asked(tmp_path, monkeypatch):
    monkeypatch.setattr("launch.vehicles.tuning.tune", tuned)
    before = (ROOT / "vehicles" / "stick25" / "vehicle.yaml").read_text()
    done = CliRunner().invoke(vehicle_app, ["tune", "stick25", "--picture", str(tmp_path / "t.png")])
    assert done.exit_code == 0, done.output
    assert "margins" in done.output and "--write" in done.output
    assert (tmp_path / "t.png").stat().st_size > 10_000
    assert (ROOT / "vehicles" / "stick25" / "vehicle.yaml").read_text() == before


def parsed(text):
    return yaml.safe_load(with_params(text, FIGURES, PLACE))["params"]["autopilot_air"]


def test_a_file_without_parameters_gets_them():
    assert parsed("kind: fixed_wing\n") == {"roll_p": 0.051235, "roll_time": 0.3}


def test_empty_braces_give_way_to_them_and_others_are_not_torn_apart():
    assert parsed("kind: fixed_wing\nparams: {}  # none\n") == {"roll_p": 0.051235, "roll_time": 0.3}
    with pytest.raises(BadInput, match="'params:' on a line of its own"):
        with_params("params: {slam: {a: 1}}\n", FIGURES, PLACE)


def test_parameters_of_others_stay():
    text = "params:\n  slam:\n    a: 1\nsensors: {}\n"
    made = yaml.safe_load(with_params(text, FIGURES, PLACE))
    assert made == {"params": {"autopilot_air": {"roll_p": 0.051235, "roll_time": 0.3}, "slam": {"a": 1}}, "sensors": {}}


def test_what_is_there_is_renewed_with_its_comment_and_its_place():
    text = "params:\n  # why\n  autopilot_air:\n    roll_p: 1.0  # firm\n    turn_bank: 0.7\n\nsensors: {}\n"
    made = with_params(text, FIGURES, PLACE)
    assert "    roll_p: 0.051235  # firm\n    turn_bank: 0.7\n" in made
    assert "  # why\n" in made
    assert yaml.safe_load(made)["params"]["autopilot_air"] == {"roll_p": 0.051235, "turn_bank": 0.7, "roll_time": 0.3}
    assert yaml.safe_load(made)["sensors"] == {}


def test_a_block_in_braces_is_not_torn_apart():
    with pytest.raises(BadInput, match="on a line of its own"):
        with_params("params: {autopilot_air: {roll_p: 1.0}}\n", FIGURES, PLACE)
