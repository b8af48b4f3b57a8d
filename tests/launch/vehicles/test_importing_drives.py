"""What drives robots of others is found: several wheels a side, with rollers, steered; wrong figures are told."""

import re

import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from tests.launch.vehicles.foreign_robots import car, import_one
from uvf.models.vehicle.file import load_vehicle

BEHIND = "<inertial><pose>-0.06 0.02 0 0 0 0</pose><mass>10<"


def test_skid_steer_turns_about_base_link_wherever_its_mass_is(tmp_path):
    """As the wheels bear it, not about the middle of the wheels."""
    notes = import_one(tmp_path, "skid_steer", ("<inertial><mass>10<", BEHIND))
    folder = tmp_path / "vehicles" / "it"
    drive_file = load_vehicle(folder.parent, "it").ground.drive
    assert drive_file.kind == "skid_steer"
    assert drive_file.left == ["wheel_left_1_joint", "wheel_left_2_joint"]
    assert drive_file.track < drive_file.effective_track < 0.4 + 0.32**2 / 0.4  # shorter than under equal loads
    assert any("m apart, about (-0.0" in line for line in notes), notes
    assert inspect(folder).faults == []
    driven = drive(folder, (0.0, 0.6), np.pi / 0.6)
    assert np.hypot(*driven.pose[:2]) < 0.01
    assert driven.pose[2] == pytest.approx(np.pi, rel=0.02)
    driven = drive(folder, (0.3, 0.3), 4.0)
    assert driven.pose == pytest.approx(driven.expected, abs=0.06)  # what pulls it inwards on the arc shifts the slip a little


LEFT = "- wheel_left_{}_joint\n    - wheel_left_{}_joint"
MECANUM = "libgazebo_ros_skid_steer_drive.so", "gz-sim-mecanum-drive-system"


@pytest.mark.parametrize("twist", [(0.0, 0.0, 0.3), (0.2, 0.0, -0.2), (0.2, 0.5, 0.1)])
def test_mecanum_wheels_drive_it_every_way(tmp_path, twist):
    notes = import_one(tmp_path, "skid_steer", MECANUM)
    folder = tmp_path / "vehicles" / "it"
    drive_file = load_vehicle(folder.parent, "it").ground.drive
    assert (drive_file.kind, drive_file.track, drive_file.wheelbase) == ("mecanum", pytest.approx(0.4), pytest.approx(0.32))
    assert any("mecanum wheels" in line for line in notes) and inspect(folder).faults == []
    driven = drive(folder, twist, 4.0)
    assert driven.pose == pytest.approx(driven.expected, abs=0.02)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("wheelbase: .*", "wheelbase: 0.4", "drive: wheelbase: 0.4 m, but the left wheels are 0.32 m apart in the URDF"),
        (
            "- wheel_left_1_joint\\n    - wheel_left_2",
            "- wheel_left_2_joint\\n    - wheel_left_1",
            "behind the second; name the front wheel first",
        ),
    ],
)
def test_mecanum_wheels_that_the_urdf_has_elsewhere_are_a_fault(tmp_path, old, new, why):
    import_one(tmp_path, "skid_steer", MECANUM)
    path = tmp_path / "vehicles" / "it" / "vehicle.yaml"
    path.write_text(re.sub(old, new, path.read_text()))
    assert any(why in fault for fault in inspect(path.parent).faults)


def import_car(tmp_path, *edits):
    """Its folder and notes."""
    source = car(tmp_path / "source")
    for old, new in edits:
        assert old in source.read_text()
        source.write_text(source.read_text().replace(old, new))
    folder = tmp_path / "vehicles" / "it"
    return folder, import_vehicle(source, folder)


@pytest.mark.parametrize("twist", [(0.5, 0.0), (0.4, 0.4), (0.4, -0.4), (-0.3, 0.2)])
def test_a_car_drives_where_it_is_steered(tmp_path, twist):
    folder, notes = import_car(tmp_path)
    drive_file = load_vehicle(folder.parent, "it").ground.drive
    assert (drive_file.kind, drive_file.track, drive_file.wheelbase) == ("ackermann", pytest.approx(0.4), pytest.approx(0.5))
    assert 0.4 < drive_file.max_steering < 0.55  # of the middle; the inner wheel is at the file's smaller limit
    assert any("a car: its wheels are steered: left_steering_hinge, right_steering_hinge" in line for line in notes), notes
    assert any("motors and the rate of the steering" in line for line in notes)
    assert inspect(folder).faults == []
    driven = drive(folder, twist, 5.0)
    assert driven.pose == pytest.approx(driven.expected, abs=0.02)


def test_castors_that_swivel_make_no_car(tmp_path):
    folder, _ = import_car(tmp_path, ('"0 0 0"/><axis', '"-0.06 0 0"/><axis'))
    assert load_vehicle(folder.parent, "it").ground.drive.kind == "differential"


def test_wheels_in_front_that_hang_a_little_high_are_put_on_the_floor(tmp_path):
    folder, notes = import_car(tmp_path, ('"0.25 0.2 -0.02', '"0.25 0.2 -0.015'), ('"0.25 -0.2 -0.02', '"0.25 -0.2 -0.015'))
    assert any("steered wheels put on the floor: front_left_wheel_joint by -5.0 mm" in line for line in notes), notes
    assert inspect(folder).faults == []


def test_how_far_it_steers_is_guessed_where_no_file_says_it(tmp_path):
    _, notes = import_car(tmp_path, ('lower="-0.55" upper="0.6"', 'lower="0" upper="0"'))
    assert any("set it in vehicle.yaml" in line and "how far it steers" in line for line in notes), notes


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("wheelbase: .*", "wheelbase: 0.6", "wheelbase: 0.6 m, but the wheel 'steered_left_joint' of the URDF is 0.5 m from the axle"),
        ("max_steering: .*", "max_steering: 0.6", "max_steering: 0.6 rad turns 'steering_left_joint' by 0.75"),
        (
            "steering_left_joint: .*\n(.*)steering_right_joint: .*",
            "steering_left_joint: steered_right_joint\n\\1steering_right_joint: steered_left_joint",
            "the wheel 'steered_right_joint' does not hang in it, so it would not be steered",
        ),
        ("steering_left_joint: .*", "wheel_left_joint: steered_left_joint", "the joint wheel_left_joint is named twice"),
        ("max_angular: .*", "max_angular: 9.0", "max_angular: 9 rad/s, but without load the motors reach"),
    ],
)
def test_a_car_that_the_urdf_has_otherwise_is_a_fault(tmp_path, old, new, why):
    folder, _ = import_car(tmp_path)
    path = folder / "vehicle.yaml"
    path.write_text(re.sub(old, new, path.read_text()))
    faults = inspect(folder).faults
    assert any(why in fault for fault in faults), faults


def test_a_wrong_effective_track_is_a_fault_that_names_the_right_one(tmp_path):
    import_one(tmp_path, "skid_steer")
    path = tmp_path / "vehicles" / "it" / "vehicle.yaml"
    path.write_text(re.sub("effective_track: .*", "effective_track: 0.5", path.read_text()))
    (fault,) = inspect(path.parent).faults
    assert "ground: drive: effective_track: 0.5 m, but in the simulator it turns as with 0.6" in fault


def test_castors_that_swivel_are_no_skid_steer(tmp_path):
    castors = "".join(
        f'<link name="fork_{x}"/><joint name="turn_{x}" type="continuous"><parent link="telaio"/><child link="fork_{x}"/>'
        f'<origin xyz="{x} 0 -0.07"/><axis xyz="0 0 1"/></joint><link name="roll_{x}"><visual><origin rpy="1.57079633 0 0"/>'
        f'<geometry><cylinder radius="0.03" length="0.02"/></geometry></visual></link><joint name="axle_{x}" type="continuous">'
        f'<parent link="fork_{x}"/><child link="roll_{x}"/><axis xyz="0 1 0"/></joint>'
        for x in (-0.05, 0.2)
    )
    notes = import_one(tmp_path, "bare", ("</robot>", castors + "</robot>"))
    assert not any("skid steer" in line for line in notes)
    assert any("castors became balls" in line and "roll_-0.05" in line and "roll_0.2" in line for line in notes)


def hung(name, parent, kind, place, axis, inside):
    joint = f'<joint name="{name}_joint" type="{kind}"><parent link="{parent}"/><child link="{name}"/>'
    return f'<link name="{name}">{inside}</link>{joint}<origin xyz="{place}"/><axis xyz="{axis}"/></joint>'


def wheel_shape(radius):
    shape = f'<origin rpy="1.5708 0 0"/><geometry><cylinder radius="{radius}" length="0.04"/></geometry>'
    inertia = '<inertia ixx="2e-4" iyy="3e-4" izz="2e-4" ixy="0" ixz="0" iyz="0"/>'
    return f'<inertial><mass value="0.3"/>{inertia}</inertial><visual>{shape}</visual><collision>{shape}</collision>'


def turning(name, place, radius=0.06, parent="base_link"):
    return hung(name, parent, "continuous", place, "0 1 0", wheel_shape(radius))


BOTH = "".join(turning(f"wheel_{side}", f"0 {y} -0.03") for side, y in (("left", 0.16), ("right", -0.16)))
BOX = '<geometry><box size="0.4 0.25 0.08"/></geometry>'
HULL = (
    '<link name="base_link"><inertial><mass value="8"/><inertia ixx="0.05" iyy="0.1" izz="0.12" ixy="0" ixz="0" iyz="0"/></inertial>'
    f"<visual>{BOX}</visual><collision>{BOX}</collision></link>"
)


def taken(tmp_path, *parts):
    """The drive of the vehicle that is made of them, its folder and the notes."""
    (tmp_path / "x.urdf").write_text(f'<robot name="it">{HULL}{"".join(parts)}</robot>')
    notes = import_vehicle(tmp_path / "x.urdf", tmp_path / "it")
    return load_vehicle(tmp_path, "it").ground.drive, tmp_path / "it", notes


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_wheels_on_rockers_and_springs_drive_as_those_on_the_body(tmp_path, kind):
    """As of the Leo Rover: a rocker on each side that turns as the wheels do."""
    parts = []
    for side, y in (("left", 0.16), ("right", -0.16)):
        parts.append(hung(f"rocker_{side}", "base_link", kind, f"0 {y} -0.01", "0 1 0" if kind == "revolute" else "0 0 1", ""))
        ends = (("front", 0.14), ("rear", -0.14))
        parts += [turning(f"wheel_{end}_{side}", f"{x} 0 -0.03", parent=f"rocker_{side}") for end, x in ends]
    drive_file, folder, _ = taken(tmp_path, *parts)
    assert (drive_file.kind, len(drive_file.left)) == ("skid_steer", 2)
    assert [line for line in inspect(folder).faults if "lidar" not in line] == []


def test_of_wheels_of_a_track_those_that_stand_on_the_floor_drive(tmp_path):
    """As of AgileX' Bunker: sprockets larger than the road wheels hang above the floor."""
    parts = []
    for side, y in (("left", 0.16), ("right", -0.16)):
        parts += [turning(f"sprocket_{end}_{side}", f"{x} {y} 0.06", 0.08) for end, x in (("a", 0.3), ("b", -0.3))]
        parts += [turning(f"wheel_{i}_{side}", f"{x} {y} -0.03", 0.05) for i, x in enumerate((0.18, 0.0, -0.18))]
    drive_file, folder, _ = taken(tmp_path, *parts)
    assert (drive_file.kind, len(drive_file.left), drive_file.wheel_radius) == ("skid_steer", 3, pytest.approx(0.05))
    assert [line for line in inspect(folder).faults if "lidar" not in line] == []
    driven = drive(folder, (0.0, 0.5), np.pi / 0.5)
    assert driven.pose[2] == pytest.approx(np.pi, rel=0.03)


def test_a_body_that_hangs_on_its_belly_is_found_by_driving_it(tmp_path):
    """Nothing is wrong with its figures; it just does not move as its wheels turn."""
    belly = '<collision><geometry><box size="0.3 0.2 0.0405"/></geometry></collision>'
    _, folder, _ = taken(tmp_path, BOTH, hung("belly", "base_link", "fixed", "0 0 -0.07", "1 0 0", belly))
    assert any("in the simulator" in line or "reaches" in line for line in inspect(folder).faults)


def test_packages_of_a_workspace_are_found_wherever_they_lie_in_it(tmp_path):
    """As of TurtleBot 4, which is built on Create 3's description in another repository."""
    parts = tmp_path / "src" / "parts_repo" / "group" / "parts_description"
    robot = tmp_path / "src" / "robot_repo" / "robot_description" / "urdf"
    for folder, package in ((parts, "parts_description"), (robot.parent, "robot_description")):
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(f"<package><name>{package}</name></package>")
    robot.mkdir()
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    (parts / "wheels.xacro").write_text(f'<robot {space}><xacro:macro name="wheels">{BOTH}</xacro:macro></robot>')
    include = '<xacro:include filename="$(find parts_description)/wheels.xacro"/><xacro:wheels/>'
    (robot / "it.urdf.xacro").write_text(f'<robot name="it" {space}>{HULL}{include}</robot>')
    import_vehicle(robot / "it.urdf.xacro", tmp_path / "it")
    assert load_vehicle(tmp_path, "it").ground.drive.kind == "differential"
