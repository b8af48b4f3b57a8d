"""Mistakes in a vehicle's files end in one line that names the file and the mend."""

import shutil
from dataclasses import replace

import pytest
import yaml

from services.sim_ground.build import build
from tests.services.sim_ground.ride import site_with
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput


@pytest.fixture
def root(tmp_path):
    """A copy of the burger and the house that a test may spoil."""
    for folder in ("vehicles/burger", "worlds/house"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    return tmp_path


def refusal(root, start=(6.0, 4.4, 0.0), more="", **start_more):
    mission = site_with(root, {"burger": start}).mission_path
    data = yaml.safe_load(mission.read_text()) | (yaml.safe_load(more) or {})
    data["vehicles"]["burger"]["start"] |= start_more
    mission.write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput) as caught:
        build(load_scenario(mission, root))
    assert "\n" not in str(caught.value)
    return str(caught.value)


def edit_urdf(root, old, new):
    path = root / "vehicles/burger/burger.urdf"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))


def edit_vehicle(root, change):
    path = root / "vehicles/burger/vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    change(data)
    path.write_text(yaml.safe_dump(data))


def test_a_broken_tag(root):
    edit_urdf(root, "</robot>", "</robt>")
    assert "not valid XML: Opening and ending tag mismatch: robot" in refusal(root)


def test_a_missing_urdf(root):
    edit_vehicle(root, lambda data: data["ground"].update(urdf="burgr.urdf"))
    assert "burgr.urdf: no such file; did you mean 'burger.urdf'?" in refusal(root)


def test_an_unknown_wheel_joint(root):
    edit_vehicle(root, lambda data: data["ground"]["drive"].update(left="wheel_left"))
    assert "no joint 'wheel_left' (named in vehicle.yaml); did you mean 'wheel_left_joint'?" in refusal(root)


def test_a_wheel_that_cannot_turn(root):
    edit_urdf(root, '"wheel_left_joint" type="continuous"', '"wheel_left_joint" type="fixed"')
    assert "joint 'wheel_left_joint' is 'fixed', but a wheel needs type=\"continuous\"" in refusal(root)


def test_a_link_without_mass(root):
    edit_urdf(root, '<mass value="0.114"/>', '<mass value="0"/>')
    assert "link 'lidar': mass, ixx, iyy and izz must be numbers above zero" in refusal(root)


def test_a_missing_mesh(root):
    edit_urdf(root, '<box size="0.10 0.08 0.036"/>', '<mesh filename="body.stl"/>')
    assert "link 'base_link': no mesh file 'body.stl' beside the URDF" in refusal(root)


def test_a_joint_on_an_unknown_link(root):
    edit_urdf(root, '<child link="castor_link"/>', '<child link="caster_link"/>')
    assert "joint 'castor_joint': no child link 'caster_link'; did you mean 'castor_link'?" in refusal(root)


def test_a_link_that_hangs_in_the_air(root):
    edit_urdf(root, "</robot>", '<link name="hook"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link></robot>')
    assert "one link must be the root, but without a parent joint are: base_link, hook" in refusal(root)


def test_another_kind_of_xml(root):
    (root / "vehicles/burger/burger.urdf").write_text("<sdf/>")
    assert "the outermost tag is <sdf>; a URDF begins with <robot>" in refusal(root)


def test_a_physics_rate_that_does_not_fit_the_step(root):
    edit_vehicle(root, lambda data: data["ground"].update(physics_hz=240.0))
    assert "physics_hz: 240; make it a multiple of 100" in refusal(root)


def test_a_sensor_rate_that_does_not_fit_the_step(root):
    edit_vehicle(root, lambda data: data["sensors"]["lidar"].update(hz=200.0))
    assert "lidar: hz: 200; the simulator gives 100 at most" in refusal(root)


def test_a_start_inside_the_furniture(root):
    assert "vehicles: burger: start: at (0.6, 2.2) the vehicle stands in a wall or furniture, its middle, too" in refusal(
        root, (0.6, 2.2, 0.0)
    )


def test_a_charger_under_the_furniture(root):
    assert "chargers[1]: (0.6, 2.2) lies under a wall or furniture" in refusal(root, more="chargers: [{x: 6.0, y: 4.4}, {x: 0.6, y: 2.2}]")


def test_who_has_no_battery_has_no_charge(root):
    edit_vehicle(root, lambda data: data["ground"].pop("battery"))
    assert "burger: start: charge: burger has no battery; give its vehicle.yaml one, or leave it out" in refusal(root, charge=0.5)
    waits = "tasks: [{TASK}]\nchargers: [{x: 6.0, y: 4.4}]"
    assert "charge: vehicle: burger has no battery" in refusal(root, more=waits.replace("TASK", "charge: {vehicle: burger}"))
    assert "when: charge_below: burger has no battery" in refusal(
        root, more=waits.replace("TASK", "when: {vehicle: burger, charge_below: 0.5}, arm: burger")
    )


def test_without_ground_vehicles_there_is_no_service(root):
    site = site_with(root, {"burger": (6.0, 4.4, 0.0)})
    assert build(replace(site, members={})) == []
