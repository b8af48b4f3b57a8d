"""Robots as published files have them: axles on rollers, cars without rolling wheels, weightless wheels, cliff sensors of many rays."""

import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from tests.launch.vehicles.foreign_robots import import_one
from tests.launch.vehicles.test_importing_drives import BOTH, BOX, HULL, hung, taken, turning, wheel_shape
from tests.launch.vehicles.test_importing_sensors import ray
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput

SIDES = (("left", 0.16), ("right", -0.16))
MECANUM = """
base_controller:
  type: "mecanum_drive_controller/MecanumDriveController"
  front_left_wheel_joint: wheel_front_left_joint
  back_left_wheel_joint: wheel_rear_left_joint
  front_right_wheel_joint: wheel_front_right_joint
  back_right_wheel_joint: wheel_rear_right_joint
  linear: {x: {max_velocity: 1.1, max_acceleration: 2.0}}
  angular: {z: {max_velocity: 2.0}}
ekf: {two_d_mode: true, two_d_mode: true}
"""


def in_a_package(folder, parts, controllers, place="config/control.yaml"):
    """The robot of these parts in a package's folder urdf, with a file of controllers in the package beside it."""
    for package in ("it_description", "it_control"):
        (folder / package).mkdir(parents=True)
        (folder / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
    path = folder / "it_control" / place
    path.parent.mkdir(parents=True)
    path.write_text(controllers)
    urdf = folder / "it_description" / "it.urdf"
    urdf.write_text(f'<robot name="it">{HULL}{"".join(parts)}</robot>')
    return urdf


def faults(folder):
    return [line for line in inspect(folder).faults if "lidar" not in line]


def four_wheels(parent="base_link"):
    """Those in front on ``parent``, the others on the body."""
    parts = [turning(f"wheel_front_{side}", f"0.14 {y} -0.03", parent=parent) for side, y in SIDES]
    return parts + [turning(f"wheel_rear_{side}", f"-0.14 {y} -0.03") for side, y in SIDES]


def test_a_front_axle_that_rolls_is_no_steering_and_its_controller_says_that_the_wheels_have_rollers(tmp_path):
    """As of Clearpath's Ridgeback; a key that is given twice is nothing to ROS."""
    parts = [hung("front_rocker", "base_link", "revolute", "0 0 0", "1 0 0", ""), *four_wheels("front_rocker")]
    notes = import_vehicle(in_a_package(tmp_path / "src", parts, MECANUM), tmp_path / "it")
    ground = load_vehicle(tmp_path, "it").ground
    assert (ground.drive.kind, len(ground.drive.left), ground.max_linear, ground.max_angular) == ("mecanum", 2, 1.1, 2.0)
    assert any("taken from: control.yaml" in line for line in notes)
    assert faults(tmp_path / "it") == []


def test_the_same_without_rollers_is_skid_steer(tmp_path):
    drive_file, _, _ = taken(tmp_path, hung("front_rocker", "base_link", "revolute", "0 0 0", "1 0 0", ""), *four_wheels("front_rocker"))
    assert (drive_file.kind, len(drive_file.left)) == ("skid_steer", 2)


PREFIXED = """
base:
  left_wheel: ['$(arg prefix)front_left_joint', '$(arg prefix)rear_left_joint']
  right_wheel: ['$(arg prefix)front_right_joint', '$(arg prefix)rear_right_joint']
  linear: {x: {max_velocity: 3.0}}
"""
WHOLE = "robot: {linear_speed_limit: 1.5, angular_speed_limit: 2.5}"


@pytest.mark.parametrize(("text", "place"), [(PREFIXED, "config/simulation/a.yaml"), (PREFIXED, "bringup/config/a.yaml")])
def test_controllers_are_found_in_any_folder_and_under_any_prefix(tmp_path, text, place):
    import_vehicle(in_a_package(tmp_path / "src", four_wheels(), text, place), tmp_path / "it")
    assert load_vehicle(tmp_path, "it").ground.max_linear == 3.0


def test_limits_of_the_robot_as_a_whole_fill_what_its_controller_leaves_out(tmp_path):
    urdf = in_a_package(tmp_path / "src", four_wheels(), WHOLE, "config/a.yaml")
    (tmp_path / "src" / "it_control" / "config" / "b.yaml").write_text(PREFIXED)
    import_vehicle(urdf, tmp_path / "it")
    ground = load_vehicle(tmp_path, "it").ground
    assert (ground.max_linear, ground.max_angular) == (3.0, 2.5)


def steered_flat(side, y, kind, limit=""):
    """A wheel on its steering alone: nothing rolls in the file."""
    joint = f'<joint name="front_{side}_wheel_hinge" type="{kind}"><parent link="base_link"/><child link="front_{side}_wheel"/>'
    axis = '<axis xyz="0 0 1"/>' if kind == "revolute" else ""
    return f'<link name="front_{side}_wheel">{wheel_shape(0.06)}</link>{joint}<origin xyz="0.25 {y} -0.03"/>{axis}{limit}</joint>'


@pytest.mark.parametrize(
    ("kind", "limit", "most"),
    [("revolute", '<limit lower="-0.4" upper="0.4" effort="5" velocity="4"/>', 0.4), ("continuous", "", 0.5)],
    ids=["ros2_control's carlike", "F1TENTH's gym"],
)
def test_a_car_whose_front_wheels_do_not_roll_is_a_car(tmp_path, kind, limit, most):
    front = [steered_flat(side, y, kind, limit) for side, y in SIDES]
    rear = [turning(f"rear_wheel_{side}", f"-0.25 {y} -0.03") for side, y in SIDES]
    drive_file, folder, _ = taken(tmp_path, *front, *rear)
    assert (drive_file.kind, drive_file.wheelbase) == ("ackermann", pytest.approx(0.5))
    inner = np.arctan(0.5 * np.tan(drive_file.max_steering) / (0.5 - 0.16 * np.tan(drive_file.max_steering)))
    assert inner == pytest.approx(most, abs=0.01)
    assert faults(folder) == []


def test_wheels_in_the_middle_that_stand_for_both_are_left_out(tmp_path):
    parts = [turning("virtual_rear_wheel", "0 0 -0.03"), BOTH, hung("caster", "base_link", "fixed", "0.15 0 -0.06", "0 1 0", ball(0.03))]
    drive_file, folder, notes = taken(tmp_path, *parts)
    assert (drive_file.kind, drive_file.track) == ("differential", pytest.approx(0.32))
    assert any("in the middle of an axle" in line and "virtual_rear_wheel" in line for line in notes)
    assert "virtual" not in (folder / "it.urdf").read_text()


def ball(radius):
    return f'<collision><geometry><sphere radius="{radius}"/></geometry></collision>'


def test_wheels_like_those_that_drive_are_told_of_where_they_are_taken_for_castors(tmp_path):
    """As of KUKA's youBot, whose forks are called castors."""
    _, _, notes = taken(tmp_path, *four_wheels(), *[hung(f"x_{i}", "base_link", "fixed", "0 0 0", "1 0 0", "") for i in range(2)])
    assert not any("wheels like those that drive" in line for line in notes)
    parts = [part.replace("wheel_rear", "caster_wheel_rear") for part in four_wheels()]
    (tmp_path / "other").mkdir()
    _, _, notes = taken(tmp_path / "other", *parts)
    assert any("wheels like those that drive" in line and "caster_wheel_rear_left_joint" in line for line in notes)


def test_a_wheel_that_steers_and_drives_alone_is_told_of(tmp_path):
    fork = hung("fork", "base_link", "revolute", "0.25 0 0.02", "0 0 1", "").replace('<axis xyz="0 0 1"/>', STEERED)
    _, _, notes = taken(tmp_path, BOTH, fork, turning("traction", "0 0 -0.05", parent="fork"))
    assert any("steered alone" in line and "traction_joint" in line for line in notes)


STEERED = '<axis xyz="0 0 1"/><limit lower="-1.5" upper="1.5" effort="5" velocity="4"/>'


def test_wheels_that_weigh_next_to_nothing_are_given_a_mass_and_are_a_fault_where_a_file_has_them(tmp_path):
    light = BOTH.replace('<mass value="0.3"/>', '<mass value="1e-5"/>').replace("2e-4", "1e-9").replace("3e-4", "1e-9")
    _, folder, notes = taken(tmp_path, light, hung("caster", "base_link", "fixed", "0.15 0 -0.06", "0 1 0", ball(0.03)))
    assert any("masses guessed" in line and "wheel_left_link" in line for line in notes)
    assert faults(folder) == []
    path = folder / "it.urdf"
    heavy = path.read_text()
    mass = heavy.split('<link name="wheel_left_link">')[1].split('<mass value="')[1].split('"')[0]
    path.write_text(heavy.replace(f'<mass value="{mass}"', '<mass value="1e-5"'))
    assert any("so light a wheel slips" in line for line in faults(folder))


def test_a_body_that_almost_touches_the_floor_is_raised_where_wheels_carry_it(tmp_path):
    """As of Festo's Robotino: 0.8 mm above the floor, it would carry the robot once the tyres have given."""
    low = BOX.replace("0.08", "0.1784")
    hull = HULL.replace(BOX, low)
    (tmp_path / "x.urdf").write_text(f'<robot name="it">{hull}{"".join(four_wheels())}</robot>')
    notes = import_vehicle(tmp_path / "x.urdf", tmp_path / "it")
    assert any("raised to 8 mm" in line for line in notes)
    driven = drive(tmp_path / "it", (0.3, 0.0), 3.0)
    assert driven.pose[0] == pytest.approx(driven.expected[0], rel=0.02)
    assert driven.bearing == ()


def test_what_keeps_a_vehicle_from_driving_is_named(tmp_path):
    belly = '<collision><geometry><box size="0.3 0.2 0.0405"/></geometry></collision>'
    _, folder, _ = taken(tmp_path, BOTH, hung("belly", "base_link", "fixed", "0 0 -0.07", "1 0 0", belly))
    assert "belly" in drive(folder, (0.3, 0.0), 1.0).bearing


def test_cliff_sensors_of_many_rays_are_range_finders_and_a_scanner_on_its_side_is_no_lidar(tmp_path):
    """As of Kobuki: 50 rays in 5 degrees that reach 15 cm, and no lidar in the file."""
    rays = [ray("cliff", 50, 0.087, 0.15, "0 1.5708 0"), ray("wall_scanner", 360, 3.0, 10.0, "1.5708 0 0")]
    notes = import_one(tmp_path, "bare", ("</robot>", "".join(rays) + "</robot>"))
    sensors = load_vehicle(tmp_path / "vehicles", "it").sensors
    assert [(f.range_max, f.frame) for f in sensors.rangefinders] == [(0.15, "cliff_range_1")]
    assert sensors.lidar is None
    assert any("not level dropped" in line and "wall_scanner" in line for line in notes)


def test_a_package_may_keep_one_folder_deeper_what_it_installs_at_its_top(tmp_path):
    """As ros2_control's template does."""
    package, space = tmp_path / "demo", 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    (package / "description" / "urdf").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>demo</name></package>")
    (package / "description" / "urdf" / "wheels.xacro").write_text(
        f'<robot {space}><xacro:macro name="wheels">{BOTH}</xacro:macro></robot>'
    )
    include = '<xacro:include filename="$(find demo)/urdf/wheels.xacro"/><xacro:wheels/>'
    source = package / "description" / "urdf" / "it.urdf.xacro"
    source.write_text(f'<robot name="it" {space}>{HULL}{include}</robot>')
    import_vehicle(source, tmp_path / "it")
    assert load_vehicle(tmp_path, "it").ground.drive.kind == "differential"


def test_the_mass_of_a_body_counts_against_all_that_is_fast_to_it(tmp_path):
    """As of the Ridgeback, whose root is a rocker of 3 litres."""
    heavy = HULL.replace(BOX, '<geometry><box size="0.05 0.05 0.02"/></geometry>')
    crate = f"<visual>{BOX.replace('0.08', '0.3')}</visual><collision>{BOX.replace('0.08', '0.3')}</collision>"
    parts = [*four_wheels(), hung("crate", "base_link", "fixed", "0 0 0.16", "1 0 0", crate)]
    (tmp_path / "x.urdf").write_text(f'<robot name="it">{heavy}{"".join(parts)}</robot>')
    import_vehicle(tmp_path / "x.urdf", tmp_path / "it")
    assert faults(tmp_path / "it") == []


def test_a_package_of_another_version_is_told_from_one_that_is_not_there(tmp_path):
    package, space = tmp_path / "parts", 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    package.mkdir()
    (package / "package.xml").write_text("<package><name>parts</name></package>")
    source = tmp_path / "it.urdf.xacro"
    include = '<xacro:include filename="$(find {})/wheels.xacro"/><xacro:wheels/>'
    for name, remedy in (("parts", "packages that are there have no such file"), ("none", "put their packages in a folder about it")):
        source.write_text(f'<robot name="it" {space}>{HULL}{include.format(name)}</robot>')
        with pytest.raises(BadInput, match=remedy):
            import_vehicle(source, tmp_path / "it")
