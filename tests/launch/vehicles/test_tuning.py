"""``uvf vehicle tune``: figures from the model, margins of the loops, a vehicle.yaml that keeps what it says, and flights with them."""

import shutil
from contextlib import closing
from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from benchmarks.autopilot import cost_and_slip as bench
from benchmarks.autopilot.accuracy.flight import PLANE, Probe
from launch.commands.vehicle import vehicle_app
from launch.vehicles.autopilot_guess import autopilot_figures
from launch.vehicles.parameter_lines import with_params
from launch.vehicles.tuning import SECONDS, steps, tune, write
from uvf.control.design.gain_search import GAIN, PEAK, PHASE, designed
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput, FileLocation

PLACE = FileLocation("vehicle.yaml")
FIGURES = {"roll_p": 0.05123456, "roll_time": 0.3}


MODELS = ["milvus", "stick25"]
pytestmark = pytest.mark.timeout(300)  # tune flies many steady flights


@pytest.fixture(scope="module", autouse=True)
def figures():
    """Many steady flights and a search, once for each model: what they come to depends on the model alone."""
    found, gains = {}, {}

    def once(airframe, body):
        key = body.model
        if key not in found:
            found[key] = autopilot_figures(airframe, body)
        return dict(found[key])

    def designed_once(aircraft, params, firmness):
        key = params.trim_airspeed, firmness
        if key not in gains:
            gains[key] = designed(aircraft, params, firmness)
        return gains[key]

    with mock.patch("launch.vehicles.tuning.autopilot_figures", once), mock.patch("launch.vehicles.tuning.designed", designed_once):
        yield


@pytest.fixture(params=MODELS)
def tuning(request, figures):
    return tune(ROOT / "vehicles" / request.param)


def test_every_loop_has_its_margins_at_every_airspeed(tuning):
    in_flight = {"path", "roll", "yaw", "height", "pitch", "airspeed", "airspeed by pitch"}
    firm = {"final path", "final roll", "flare", "flare pitch", "attitude roll", "attitude pitch"}
    assert {loop.name for loop in tuning.loops} == in_flight | firm
    assert len({loop.airspeed for loop in tuning.loops}) == 3
    for loop in tuning.loops:
        assert loop.stable
        if np.isnan(loop.margins.phase):  # no crossing: it never comes near to a gain of one
            assert loop.margins.peak < 1.1, (loop.name, loop.airspeed)
        else:
            assert np.degrees(loop.margins.phase) > PHASE, (loop.name, loop.airspeed)
        assert abs(loop.margins.gain_db) > GAIN, (loop.name, loop.airspeed)
        assert loop.margins.peak < PEAK, (loop.name, loop.airspeed)
    assert tuning.unmet == []


def test_it_stays_stable_with_derivatives_and_lags_that_are_off(tuning):
    assert tuning.unstable == []


def test_a_step_ends_at_what_is_asked_and_does_not_swing(tuning):
    t = np.linspace(0.0, SECONDS, 121)
    for name, step in steps(tuning, t).items():
        assert step[0] == pytest.approx(0.0, abs=0.01)
        assert step[-1] == pytest.approx(1.0, abs=0.15), name
        assert step.max() < 1.25, name


def test_what_is_unstable_is_not_written(tuning, tmp_path):
    folder = shutil.copytree(tuning.folder, tmp_path / tuning.folder.name)
    before = (folder / "vehicle.yaml").read_text()
    loops = [replace(loop, stable=False) if loop.name == "roll" else loop for loop in tuning.loops]
    with pytest.raises(BadInput, match=r"vehicle.yaml: not written: with the best gains that were found roll is unstable at"):
        write(replace(tuning, folder=folder, loops=loops))
    assert (folder / "vehicle.yaml").read_text() == before


def test_the_vehicles_have_the_figures_that_their_models_give(tuning):
    for name in ("alpha_zero_lift", "elev_zero_alpha"):
        assert tuning.before[name] == pytest.approx(tuning.figures[name], abs=2e-3)
    for name in ("alpha_per_load", "elev_per_alpha", "roll_ff", "pitch_ff", "trim_throttle", "flap_alpha"):
        assert tuning.before[name] == pytest.approx(tuning.figures[name], rel=0.02), name


def test_what_cannot_bank_is_refused():
    with pytest.raises(BadInput, match="nothing that the autopilot moves makes it roll"):
        tune(ROOT / "vehicles" / "nas10")


def test_it_is_printed_drawn_and_nothing_is_written_without_being_asked(tmp_path):
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


CORNERS = [(350.0, 0.0, 100.0), (350.0, 300.0, 115.0), (0.0, 300.0, 115.0)]
MISSION = [{"x": x, "y": y, "z": z} for x, y, z in CORNERS]
WIND = {"steady": [0.0, 4.0, 0.0]}


def tuned_by_files_alone(model, root):
    """A tree with the aircraft of the repository, of whose autopilot nothing is known but what tune finds out."""
    shutil.copytree(ROOT / "worlds" / "empty", root / "worlds" / "empty")
    folder = shutil.copytree(ROOT / "vehicles" / model, root / "vehicles" / model)
    path = folder / "vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    del data["params"]["autopilot_air"]
    path.write_text(yaml.safe_dump(data))
    write(tune(folder))
    return folder


def mission_of(model, speed, folder):
    start = {"x": 0.0, "y": 0.0, "z": 100.0, "yaw": 0.0, "speed": speed}
    vehicle = {"model": model, "system_id": 1, "start": start, "job": {"mission": MISSION}}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({"about": "m", "world": "empty", "seed": 3, "wind": WIND, "vehicles": {PLANE: vehicle}}))
    return path


@pytest.fixture(scope="module", params=MODELS)
def flown(request, figures, tmp_path_factory):
    root = tmp_path_factory.mktemp(request.param)
    speed = tune_speed(tuned_by_files_alone(request.param, root))
    site = load_scenario(mission_of(request.param, speed, root), root)
    lockstep = bench.lockstep_of(site)
    with closing(lockstep):
        probe = Probe(lockstep, site)
        lockstep.run(120.0, probe)
        assert probe.autopilot._mode_manager.navigator.finished
    return probe.flight(), speed


def tune_speed(folder):
    return yaml.safe_load((folder / "vehicle.yaml").read_text())["air"]["trim_speed"]


def test_it_keeps_to_its_path(flown):
    flight, _ = flown
    settled = flight.t > 5.0
    off = np.abs(flight.off_path[settled, 0])
    assert np.sqrt(np.mean(off**2)) < 1.2 and off.max() < 4.0


def test_it_keeps_its_airspeed_and_arrives_at_the_height(flown):
    flight, speed = flown
    assert abs(flight.airspeed[flight.t > 5.0, 0] - speed).max() < 0.12 * speed
    assert flight.truth[-1, 2] == pytest.approx(CORNERS[-1][2], abs=2.5)


def test_the_side_slip_of_crooked_rudders_goes_to_nothing():
    assert abs(bench.slip(bench.STRAIGHT, bench.RIGGED, False)) > 3.0
    assert abs(bench.slip(bench.STRAIGHT, bench.RIGGED, True)) < 0.5
