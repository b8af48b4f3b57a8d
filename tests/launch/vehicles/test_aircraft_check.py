"""``uvf vehicle check`` of JSBSim aircraft: each mistake is one line that says where and how to mend it."""

import re
import shutil

import pytest

from launch.vehicles.inspection import inspect
from uvf.models.scenario import ROOT


def changed(tmp_path, model, *changes):
    """A copy of a vehicle in which (file, pattern, new text) are put in place of what was there."""
    folder = shutil.copytree(ROOT / "vehicles" / model, tmp_path / model)
    for name, old, new in changes:
        text, count = re.subn(old, new, (folder / name).read_text(), flags=re.DOTALL)
        assert count
        (folder / name).write_text(text)
    return inspect(folder)


YAML, XML = "vehicle.yaml", "stick25/stick25.xml"
FAULTS = {
    "no body has such inertia": [(XML, "> 0.15364 <", "> 0.9 <")],
    "ixx is '0'; it must be a number above zero": [(XML, "> 0.07151 <", "> 0 <")],
    "there is no <ground_reactions> section; add it": [(XML, "<ground_reactions>.*</ground_reactions>", "")],
    "no engine/stick25_moter.xml for the engine; did you mean 'stick25_motor'?": [(XML, "stick25_motor", "stick25_moter")],
    "no engine/prop.xml for the thruster": [(XML, "stick25_propeller", "prop")],
    "stick25_motor.xml:8: not valid XML": [("engine/stick25_motor.xml", "</brushless_dc_motor>", "</motor>")],
    "stick25.xml:199: not valid XML": [(XML, "</fdm_config>", "")],
    "controls: elevator: property: the model has no property 'fcs/elevator-cmd'; did you mean 'fcs/elevator-cmd-norm'?": [
        (YAML, r"elevator: {limit", "elevator: {property: fcs/elevator-cmd, limit")
    ],
    "a positive aileron ought to be one that rolls right, and this does the opposite; turn its sign": [
        (YAML, r"aileron: {limit", "aileron: {sign: -1, limit")
    ],
    "a positive elevator ought to be one that pitches down": [(YAML, r"elevator: {limit", "elevator: {sign: -1, limit")],
    "a positive rudder ought to be one that yaws left": [(YAML, r"rudder: {limit", "rudder: {sign: -1, limit")],
    "controls: elevator move nothing; name the properties": [(XML, "<input>fcs/elevator-cmd-norm", "<input>fcs/pitch-trim-cmd-norm")],
    "trim_speed: ": [(YAML, "trim_speed: 17.0", "trim_speed: 45.0")],
    "at 14.0 m/s it needs -0.5": [(YAML, "trim_speed: 17.0", "trim_speed: 14.0"), (XML, "<value>-0.8488</value>", "<value>-0.2</value>")],
}


@pytest.mark.parametrize("why", FAULTS)
def test_a_mistake_is_one_line(tmp_path, why):
    found = changed(tmp_path, "stick25", *FAULTS[why])
    assert any(why in line for line in found.faults), found.faults
    assert all("\n" not in line and str(tmp_path) in line for line in found.faults)


def test_several_mistakes_of_a_model_are_told_at_once(tmp_path):
    found = changed(tmp_path, "stick25", (XML, "> 0.07151 <", "> 0 <"), (XML, "stick25_motor", "m"), (XML, "> 1.959 <", "> -1 <"))
    assert len(found.faults) == 3


def test_a_landing_gear_that_is_unstable_is_told_with_the_rate_it_needs(tmp_path):
    found = changed(tmp_path, "stick25", (YAML, "physics_hz: 400.0", "physics_hz: 50.0"))
    (line,) = found.faults
    needed = re.search(r"at 50 Hz the landing gear is unstable; set (\d+) Hz", line)
    assert needed, line
    (tmp_path / "again").mkdir()
    assert changed(tmp_path / "again", "stick25", (YAML, "physics_hz: 400.0", f"physics_hz: {needed[1]}")).faults == []


def test_wheels_that_do_not_hold_it_up_are_told(tmp_path):
    found = changed(tmp_path, "stick25", (XML, '<spring_coeff unit="N/M">[0-9]+<', '<spring_coeff unit="N/M">1<'))
    assert "look at <ground_reactions>" in found.faults[-1]


def test_an_aircraft_without_ailerons_may_leave_them_out_but_not_name_them(tmp_path):
    assert changed(tmp_path, "nas10").notes == []
    (tmp_path / "named").mkdir()
    found = changed(tmp_path / "named", "nas10", (YAML, "controls:", "controls:\n    aileron: {limit: 0.3}"))
    assert found.notes == ["its aileron does nothing, though vehicle.yaml has one"]
