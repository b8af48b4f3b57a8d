"""Robots of others become folders without faults that drive; what was dropped or guessed is told."""

import shutil

import numpy as np
import pytest
import trimesh

from launch.vehicles.importing import NOTES, import_vehicle
from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from tests.launch.vehicles.foreign_robots import ROBOTS, import_one
from uvf.models.shapes.mesh import triangles
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

XACRO = '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">'
TOLD = {
    "solidworks": ["axes turned: forward was (0, 1, 0)", "guessed: whl_l (left) and whl_r (right) drive; wheel radius 0.06 m, track 0.3 m"],
    "gazebo_urdf": [
        "included file not found, left out: somewhere_else/urdf/extras.xacro",
        "transmissions dropped",
        "plugins dropped: libgazebo_ros_laser.so",
        "meshes taken to be in millimetres",
        "castors became balls",
        "wheel radius of 0.05 m is not that of the shapes, which counts: 0.04 m",
        "inertia that no such body has, replaced by that of its box: base_link",
    ],
    "gazebo_sdf": ["caster_wheel (ball)", "plugins dropped: libsomething.so", "radar on chassis", "rates above 100 Hz lowered"],
    "skid_steer": [
        "front_left_joint, rear_left_joint (left) and front_right_joint, rear_right_joint (right)",
        "skid steer: it turns as two wheels do",
    ],
    "kobuki": [
        "castors before and behind the axle lifted by 0.5 mm",
        "wheel_left (left) and wheel_right (right) drive; wheel radius 0.035 m",
    ],
    "bare": ["masses guessed", "no collision shape in the file", "giunto_sinistra (left)"],
}


@pytest.fixture(scope="module", params=ROBOTS)
def imported(request, tmp_path_factory):
    """Name, folder and notes."""
    root = tmp_path_factory.mktemp(request.param)
    folder = root / "vehicles" / request.param
    return request.param, folder, import_vehicle(ROBOTS[request.param](root / "source"), folder)


def test_it_has_no_faults(imported):
    assert inspect(imported[1]).faults == []


def test_what_was_dropped_or_guessed_is_told_and_kept(imported):
    name, folder, notes = imported
    for text in TOLD[name]:
        assert any(text in line for line in notes), (text, notes)
    kept = (folder / NOTES).read_text()
    assert all(line in kept for line in notes)


def test_it_drives_a_metre_straight_on(imported):
    driven = drive(imported[1], (0.25, 0.0), 4.0)
    assert driven.pose[0] == pytest.approx(1.0, rel=0.02)
    assert abs(driven.pose[1]) < 0.02
    assert driven.tilt < 0.02


def test_it_turns_on_the_spot(imported):
    driven = drive(imported[1], (0.0, 0.8), np.pi / 0.8)
    assert np.hypot(*driven.pose[:2]) < 0.01
    assert driven.pose[2] == pytest.approx(np.pi, rel=0.02)


def test_a_pose_in_a_link_may_name_another_frame_of_the_model(tmp_path):
    plain = '<sensor name="scan" type="gpu_lidar"><pose>0.9 0 0.4 0 0 0</pose>'
    named = (
        '<frame name="mast" attached_to="chassis"><pose>0.5 0 0.3 0 0 1.57079632679</pose></frame>',
        '<sensor name="scan" type="gpu_lidar"><pose relative_to="mast">0 -0.4 0.1 0 0 -1.57079632679</pose>',
    )
    mounts = []
    for edit in ((plain, plain), (plain, named[1])):
        source = ROBOTS["gazebo_sdf"](tmp_path / "source")
        source.write_text(source.read_text().replace(*edit).replace("</model>", named[0] + "</model>"))
        import_vehicle(source, tmp_path / "vehicles" / f"it{len(mounts)}")
        mounts.append(load_vehicle(tmp_path / "vehicles", f"it{len(mounts)}").sensors.lidar.mount)
    assert mounts[1].xyz == pytest.approx(mounts[0].xyz)
    assert mounts[1].rpy == pytest.approx(mounts[0].rpy, abs=1e-6)


def test_a_base_footprint_below_base_link_is_not_doubled(tmp_path):
    """As the Husky has it: the frame is there already, above base_link."""
    foot = '<link name="base_footprint"/><joint name="f" type="fixed"><parent link="telaio"/><child link="base_footprint"/></joint></robot>'
    notes = import_one(tmp_path, "bare", ("</robot>", foot))
    assert any("frames without mass or shape dropped: base_footprint" in line for line in notes)
    assert "base_footprint" not in (tmp_path / "vehicles" / "it" / "it.urdf").read_text()


def weight(folder):
    model = load_urdf(folder / "it.urdf")
    return sum(link.inertial.mass for link in model.links.values() if link.inertial is not None)


def test_a_body_whose_mass_stands_in_a_frame_of_its_own_is_not_given_more(tmp_path):
    """As the Husky has it: 46 kg in inertial_link, which has no shape, and none in base_link and the plate on it, which have shapes."""
    tensor = '<inertia ixx="0.6" ixy="0" ixz="0" iyy="1.7" iyz="0" izz="2.0"/>'
    mass = (
        f'<link name="inertial_link"><inertial><mass value="46"/>{tensor}</inertial></link><joint name="m" type="fixed">'
        '<parent link="telaio"/><child link="inertial_link"/><origin xyz="-0.05 0 0.02"/></joint></robot>'
    )
    without = import_one(tmp_path, "bare")
    assert any("masses guessed from the size of the shapes; weigh them: base_link" in line for line in without)
    shutil.rmtree(tmp_path / "vehicles")
    notes = import_one(tmp_path, "bare", ("</robot>", mass))
    assert not any("masses guessed" in line and "base_link" in line for line in notes)
    assert 46.0 < weight(tmp_path / "vehicles" / "it") < 48.0
    assert inspect(tmp_path / "vehicles" / "it").faults == []


def test_a_mesh_that_is_missing_is_told_as_the_file_names_it(tmp_path):
    notes = import_one(tmp_path, "gazebo_urdf", ("package://bot/meshes/shell.stl", "package://elsewhere/gone.stl"))
    assert any("meshes that are missing: package://elsewhere/gone.stl" in line for line in notes)


def test_a_joint_may_be_placed_by_its_parent_and_the_link_by_the_joint(tmp_path):
    """As sdformat writes a URDF."""
    source = ROBOTS["gazebo_sdf"](tmp_path / "source")
    plain = source.read_text()
    import_vehicle(source, tmp_path / "vehicles" / "plain")
    for side, y in (("left", 0.625029), ("right", -0.625029)):
        x = 0.554283 if side == "left" else 0.554282
        joint = f'<joint name="{side}_wheel_joint" type="revolute">'
        plain = plain.replace(joint, f'{joint}<pose relative_to="chassis">{x + 0.151427} {y} -0.2 0 0 0</pose>')
        plain = plain.replace(f'relative_to="__model__">{x} {y} -0.025 -1.5707 0 0', f'relative_to="{side}_wheel_joint">0 0 0 -1.5707 0 0')
    assert plain.count('relative_to="chassis"') == plain.count('_wheel_joint">0 0 0') == 2
    source.write_text(plain)
    import_vehicle(source, tmp_path / "vehicles" / "converted")
    one, other = (load_vehicle(tmp_path / "vehicles", name).ground for name in ("plain", "converted"))
    assert (other.drive.track, other.drive.wheel_radius) == pytest.approx((one.drive.track, one.drive.wheel_radius), abs=1e-4)
    assert other.radius == pytest.approx(one.radius, abs=1e-4)


def test_arguments_of_the_xacro_reach_it(tmp_path):
    notes = import_one(tmp_path, "gazebo_urdf", arguments={"prefix": "left_handed_"})
    assert any("left_handed_left_wheel_joint (left)" in line for line in notes)


def test_a_robot_on_one_wheel_or_on_wings_is_refused_with_what_to_do(tmp_path):
    with pytest.raises(BadInput, match="no two wheels of one size on one axis; joints that turn: giunto_sinistra") as caught:
        import_one(tmp_path, "bare", ('name="giunto_destra" type="continuous"', 'name="giunto_destra" type="fixed"'))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "vehicles").exists()


def test_a_folder_that_exists_is_left_alone(tmp_path):
    import_one(tmp_path, "bare")
    with pytest.raises(BadInput, match="exists"):
        import_vehicle(tmp_path / "source" / "carro.urdf", tmp_path / "vehicles" / "it")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no xml",
        "<html/>",
        "<robot/>",
        '<sdf version="1.6"/>',
        '<sdf version="1.6"><model name="x"/></sdf>',
        '<sdf version="new"><model name="x"><joint name="j"/></model></sdf>',
        XACRO + '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/></robot>',
        XACRO + '<xacro:include filename="x.urdf"/></robot>',
    ],
)
def test_a_file_that_is_no_robot_is_refused_in_one_line(tmp_path, text):
    (tmp_path / "x.urdf").write_text(text)
    with pytest.raises(BadInput) as caught:
        import_vehicle(tmp_path / "x.urdf", tmp_path / "it")
    assert "\n" not in str(caught.value) and "x.urdf" in str(caught.value)


def test_a_small_part_of_a_robot_in_millimetres_is_in_millimetres_too(tmp_path):
    screw = '<link name="${p}laser"><visual><geometry><mesh filename="meshes/screw.stl"/></geometry></visual></link>'
    source = ROBOTS["gazebo_urdf"](tmp_path / "source")
    trimesh.creation.icosphere(radius=3.0).export(source.parent / "meshes" / "screw.stl")
    source.write_text(source.read_text().replace('<link name="${p}laser"/>', screw))
    import_vehicle(source, tmp_path / "vehicles" / "it")
    model = load_urdf(next((tmp_path / "vehicles" / "it").glob("*.urdf")))
    (looks,) = next(link.visuals for name, link in model.links.items() if name.endswith("laser"))
    assert np.ptp(triangles(looks)[0], axis=0).max() == pytest.approx(0.006, rel=0.01)


CONTROLLER_1 = """
mobile_base:
  type: "diff_drive_controller/DiffDriveController"
  left_wheel: ['$(arg prefix)giunto_sinistra']
  right_wheel: ['$(arg prefix)giunto_destra']
  linear: {x: {has_velocity_limits: true, max_velocity: 1.6, has_acceleration_limits: true, max_acceleration: 20.0}}
  angular: {z: {has_velocity_limits: true, max_velocity: 3.5, has_acceleration_limits: false, max_acceleration: 6.0}}
"""
CONTROLLER_2 = """
base:
  ros__parameters:
    left_wheel_names: ["giunto_sinistra"]
    linear.x.has_velocity_limits: true
    linear.x.max_velocity: 0.46
    linear.x.max_acceleration: 0.9
    angular.z.max_velocity: 1.9
    angular.z.max_acceleration: 7.7
"""
OTHER = "arm: {left_wheel: no_such_joint, linear: {x: {max_velocity: 9.0}}}"


@pytest.mark.parametrize(
    ("files", "limits", "told"),
    [
        ({"config/a.yaml": OTHER, "config/control.yaml": CONTROLLER_1}, (1.6, 3.5, 2.5), "taken from: control.yaml"),
        ({"param/control.yaml": CONTROLLER_2}, (0.46, 1.9, 0.9), "taken from: control.yaml"),
        ({"config/a.yaml": OTHER, "config/b.yaml": "!degrees [1"}, (0.5, 2.0, 0.5), "for no file states it; set it in vehicle.yaml: speed"),
    ],
    ids=["ROS 1", "ROS 2", "of others"],
)
def test_limits_that_the_makers_state_are_taken_over(tmp_path, files, limits, told):
    for package in ("description", "control"):
        (tmp_path / "source" / package).mkdir(parents=True)
        (tmp_path / "source" / package / "package.xml").write_text("<package/>")
    for name, text in files.items():
        path = tmp_path / "source" / "control" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    source = ROBOTS["bare"](tmp_path / "source" / "description")
    notes = import_vehicle(source, tmp_path / "vehicles" / "it")
    ground = load_vehicle(tmp_path / "vehicles", "it").ground
    assert (ground.max_linear, ground.max_angular, ground.max_linear_acceleration) == limits
    assert any(told in line for line in notes)
    assert ground.motor.no_load_speed * ground.drive.wheel_radius > 2 * ground.max_linear
