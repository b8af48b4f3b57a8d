"""Aircraft that come with JSBSim become vehicles by one command: they have no faults and fly on as they begin."""

import re
import shutil
from pathlib import Path

import jsbsim
import numpy as np
import pytest

from benchmarks.autopilot.landings import without_wheels
from launch.vehicles.aircraft_rules import SEA_LEVEL
from launch.vehicles.aircraft_trial import level
from launch.vehicles.importing import NOTES, import_vehicle
from launch.vehicles.inspection import inspect
from services.sim_air.engine.airframe import Airframe
from uvf.models.jsbsim.model_file import steers_by_brakes
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

SHIPPED = Path(jsbsim.get_default_root_dir()) / "aircraft"
KINDS = {"c172x": "its autopilot and actuators with hysteresis", "T37": "two jets", "sgs126": "a glider"}
SECONDS = 10.0
pytestmark = pytest.mark.timeout(400)  # the trim of a whole aircraft takes minutes on a busy machine


@pytest.fixture(scope="module", params=KINDS)
def aircraft(request, tmp_path_factory):
    """Folder and notes."""
    folder = tmp_path_factory.mktemp("vehicles") / request.param
    return folder, import_vehicle(SHIPPED / request.param, folder)


def test_it_has_no_faults_and_its_notes_are_kept(aircraft):
    folder, notes = aircraft
    assert inspect(folder).faults == []
    assert all(line in (folder / NOTES).read_text() for line in notes)
    assert any(line.startswith("found: steady flight at ") for line in notes)


def test_it_flies_on_as_it_begins(aircraft):
    folder, _ = aircraft
    air = load_vehicle(folder.parent, folder.name).air
    airframe = Airframe(folder, air, SEA_LEVEL)
    trim = airframe.start(level(air.trim_speed))
    for _ in range(round(SECONDS * air.physics_hz)):
        airframe.step()
    motion = airframe.motion()
    sunk = air.trim_speed * np.sin(trim.glide) * SECONDS
    assert motion.airspeed == pytest.approx(air.trim_speed, rel=0.03)
    assert motion.position[2] == pytest.approx(level(1.0).position[2] - sunk, abs=3.0)


def test_what_has_an_engine_has_figures_for_the_autopilot(aircraft):
    folder, notes = aircraft
    params = load_vehicle(folder.parent, folder.name).params
    assert ("autopilot_air" in params) != ("no autopilot figures: it has no engine, and glides" in notes)


def shipped_copy(tmp_path, name):
    """In the layout of JSBSim's distribution."""
    for folder in ("engine", "systems"):
        shutil.copytree(SHIPPED.parent / folder, tmp_path / folder)
    return shutil.copytree(SHIPPED / name, tmp_path / "aircraft" / name) / f"{name}.xml"


def test_a_file_that_is_missing_is_told_with_where_to_put_it(tmp_path):
    model = shipped_copy(tmp_path, "c172x")
    (tmp_path / "systems" / "GNCUtilities.xml").unlink()
    with pytest.raises(BadInput, match=r"c172x\.xml: no 'GNCUtilities' for the system; put it into .*Systems and begin again"):
        import_vehicle(model, tmp_path / "vehicles" / "x")
    assert not (tmp_path / "vehicles").exists()


def test_a_model_that_ends_the_process_is_one_line(tmp_path):
    model = shipped_copy(tmp_path, "c172p")
    text, count = re.subn(
        r'(<function name="aero/coefficient/Cmadot">.*?)<product>.*?</product>', r"\1", model.read_text(), count=1, flags=re.DOTALL
    )
    assert count
    model.write_text(text)
    with pytest.raises(BadInput, match=r"c172p\.xml: JSBSim ends the process with this model \(SIG[A-Z]+"):
        import_vehicle(model, tmp_path / "vehicles" / "x")


def test_a_model_that_jsbsim_does_not_load_is_refused_with_its_reason_and_the_name_that_was_given(tmp_path):
    model = shipped_copy(tmp_path, "c172p")
    names = re.findall(r'<function name="(aero/coefficient/\w+)">', model.read_text())
    model.write_text(model.read_text().replace(f'"{names[1]}"', f'"{names[0]}"'))
    with pytest.raises(BadInput) as refused:
        import_vehicle(model, tmp_path / "vehicles" / "x")
    assert str(refused.value).startswith(f"{model}: JSBSim refuses it: Error loading aerodynamic function in {names[0]}")


def test_what_the_model_tells_is_not_guessed(tmp_path):
    notes = import_vehicle(SHIPPED / "J3Cub", tmp_path / "cub")
    file = load_vehicle(tmp_path, "cub")
    assert file.air.controls.flap.limit == 0.0 and "found: it has no flaps" in notes
    assert 0.3 < file.params["autopilot_air"]["gear_height"] < 3.0
    assert any(
        re.match(r"found: it stands \d\.\d\d m high on wheels, one of them under its tail, its nose \d+ degrees up", n) for n in notes
    )
    assert file.air.settings == {"propulsion/fuel_freeze": 1.0} and any("its fuel does not burn away" in note for note in notes)
    assert file.params["autopilot_air"]["gear"] == "tail_wheel" and 0.1 < file.params["autopilot_air"]["rest_pitch"] < 0.3


def test_a_model_without_wheels_is_thrown_and_slides(tmp_path):
    root = without_wheels("stick25", tmp_path)
    notes = import_vehicle(root / "vehicles" / "stick25" / "stick25", tmp_path / "belly")
    file = load_vehicle(tmp_path, "belly")
    assert set(file.air.skids) == {"nose_keel", "left_keel", "right_keel", "tail_keel"}
    assert file.params["autopilot_air"]["gear"] == "belly" and file.params["autopilot_air"]["launch_push"] > 0
    assert any("it has no wheels: it is thrown" in note for note in notes)


def test_without_a_wheel_that_follows_the_rudder_it_is_steered_by_its_brakes(tmp_path):
    model = tmp_path / "stick25" / "stick25.xml"
    shutil.copytree(ROOT / "vehicles" / "stick25" / "stick25", model.parent)
    shutil.copytree(ROOT / "vehicles" / "stick25" / "engine", tmp_path / "engine")
    assert not steers_by_brakes(model)
    model.write_text(model.read_text().replace("<max_steer unit='DEG'>-20</max_steer>", "<max_steer unit='DEG'>360</max_steer>"))
    assert steers_by_brakes(model)


def test_a_travel_that_is_not_the_same_both_ways_is_told(tmp_path):
    notes = import_vehicle(SHIPPED / "c172p", tmp_path / "c172p")
    assert "found: the elevator goes from -0.496 to 0.394 rad, by what it does" in notes
