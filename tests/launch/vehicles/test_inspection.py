"""Folders with one fault each: each is named, with its file, and nothing else is said."""

import re
import shutil

import pytest
import yaml

from launch.vehicles.inspection import inspect
from uvf.models.scenario import ROOT

URDF, YAML = "burger.urdf", "vehicle.yaml"
MOVED = '<origin xyz="0 0.08 0.033"/>'
CHASSIS = '<cylinder radius="0.07" length="0.143"/>'
LOOSE = '<link name="hook"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link></robot>'
FOOT = '<link name="base_footprint"/><joint name="f" type="fixed"><parent link="lidar"/><child link="base_footprint"/></joint></robot>'
LEFT_BALL = '<collision>\n      <geometry><sphere radius="0.033"/></geometry>\n    </collision>'

BROKEN = {
    "zero inertia": (
        URDF,
        'ixx="0.002414"',
        'ixx="0"',
        ["burger.urdf:13: link 'base_link': mass, ixx, iyy and izz must be numbers above zero"],
    ),
    "impossible inertia": (URDF, 'izz="0.002019"', 'izz="0.009"', ["burger.urdf:13: link 'base_link': no body has the principal moments"]),
    "a missing mesh": (
        URDF,
        '<box size="0.10 0.08 0.036"/>',
        '<mesh filename="package://x/body.stl"/>',
        ["no mesh file 'package://x/body.stl'"],
    ),
    "a detached link": (URDF, "</robot>", LOOSE, ["one link must be the root, but without a parent joint are: base_link, hook"]),
    "a link given twice": (URDF, "</robot>", LOOSE.replace("hook", "lidar"), ["link 'lidar' is given twice"]),
    "a second base_footprint": (
        URDF,
        "</robot>",
        FOOT,
        ["link 'base_footprint': every vehicle has a frame of that name above base_link"],
    ),
    "an unknown kind of joint": (URDF, 'type="fixed"', 'type="fixd"', ["joint 'castor_joint': type 'fixd'; did you mean 'fixed'?"]),
    "a wheel in the air": (
        URDF,
        MOVED,
        '<origin xyz="0 0.08 0.043"/>',
        ["left wheel 'wheel_left_joint' does not touch the floor: its lowest"],
    ),
    "a wheel off the axle": (URDF, MOVED, '<origin xyz="0.011 0.08 0.033"/>', ["the middle of the axle is at x = 0.005"]),
    "an axis backwards": (URDF, '<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>', ["left wheel 'wheel_left_joint' would turn backwards"]),
    "an axis askew": (
        URDF,
        '<axis xyz="0 1 0"/>',
        '<axis xyz="1 0 0"/>',
        ["turns about (1.00, 0.00, 0.00) in base_link; a wheel turns about y"],
    ),
    "a wheel without collision": (URDF, LEFT_BALL, "", ["left wheel 'wheel_left_joint' has no <collision>"]),
    "a wheel that is fixed": (URDF, 'type="continuous"', 'type="fixed"', ["joint 'wheel_left_joint' is 'fixed', but a wheel needs"]),
    "an unbalanced body": (
        URDF,
        '<origin xyz="-0.032 0 0.060"/>',
        '<origin xyz="0.06 0 0.060"/>',
        ["unbalanced: the centre of mass is at x = 0.0"],
    ),
    "a broken tag": (URDF, "</robot>", "</robt>", ["burger.urdf:169: not valid XML"]),
    "a body under the floor": (
        URDF,
        CHASSIS,
        '<cylinder radius="0.07" length="0.180"/>',
        ["link 'base_link' reaches 10 mm below the floor"],
    ),
    "left and right mixed up": ("swap", "", "", ["vehicle.yaml:7: ground: drive: left: left and right are mixed up"]),
    "a wrong wheel radius": (
        YAML,
        "ground.drive.wheel_radius",
        0.04,
        ["ground: drive: wheel_radius: 0.04 m, but the left wheel", "but the right wheel"],
    ),
    "a wrong track": (YAML, "ground.drive.track", 0.2, ["ground: drive: track: 0.2 m, but the wheels of the URDF are 0.16 m apart"]),
    "too small a radius": (YAML, "ground.radius", 0.08, ["ground: radius: 0.08 m, but the body reaches 0.113 m"]),
    "an unknown key": (
        YAML,
        "ground.drive.wheel_radios",
        0.033,
        ["ground: drive: wheel_radios: unknown key 'wheel_radios'; did you mean 'wheel_radius'?"],
    ),
    "a speed that the motors do not reach": (
        YAML,
        "ground.max_linear",
        5.0,
        ["ground: max_linear: 5 m/s, but without load the motors reach "],
    ),
    "a turn that they do not reach": (YAML, "ground.max_angular", 50.0, ["ground: max_angular: 50 rad/s, but without load the motors"]),
    "a lidar that is too fast": (YAML, "sensors.lidar.hz", 200.0, ["sensors: lidar: hz: 200; the simulator gives 100 at most"]),
    "physics out of step": (YAML, "ground.physics_hz", 240.0, ["ground: physics_hz: 240; make it a multiple of 100"]),
    "an unknown joint": (YAML, "ground.drive.left", "wheel_left", ["no joint 'wheel_left' (named in vehicle.yaml)"]),
    "a missing URDF": (YAML, "ground.urdf", "burgr.urdf", ["burgr.urdf: no such file; did you mean 'burger.urdf'?"]),
    "a lidar below the floor": (
        YAML,
        "sensors.lidar.mount.xyz",
        [-0.032, 0.0, -0.1],
        [
            "sensors: lidar: mount: z -0.1 m is below the floor",
            "link 'lidar' of the URDF is 0.275 m from the mount; to move the lidar, change",
        ],
    ),
    "a tilted lidar": (
        YAML,
        "sensors.lidar.mount.rpy",
        [0.0, 0.5, 0.0],
        ["sensors: lidar: mount: the lidar is tilted by 0.5 rad; a planar scan has to be level: set roll and pitch to 0"],
    ),
    "ranges in millimetres": (
        YAML,
        "sensors.lidar.range_max",
        3500.0,
        ["range_max: 3500 m is farther than any planar scanner sees (300 m); give metres (if this is in millimetres: 3.5)"],
    ),
    "a sensor on no link": (YAML, "sensors.lidar.mount.link", "lidr", ["sensors: lidar: mount: link: no link 'lidr'"]),
    "a sensor far from its link": (
        YAML,
        "sensors.imu.frame",
        "wheel_left_link",
        ["sensors: imu: frame: link 'wheel_left_link' of the URDF is"],
    ),
    "two sensors of one frame": (YAML, "sensors.camera.frame", "imu", ["'imu' is the frame of imu too"]),
    "a lidar inside the body": (
        YAML,
        "sensors.lidar.mount.xyz",
        [-0.032, 0.0, 0.08],
        ["the lidar is inside of link 'base_link'", "link 'lidar' of the URDF is 0.095 m from the mount"],
    ),
}


@pytest.fixture
def folder(tmp_path):
    shutil.copytree(ROOT / "vehicles" / "burger", tmp_path / "burger")
    return tmp_path / "burger"


def edit_yaml(folder, way, value):
    data = yaml.safe_load((folder / YAML).read_text())
    *above, last = way.split(".")
    inner = data
    for key in above:
        inner = inner[key]
    inner[last] = value
    (folder / YAML).write_text(yaml.safe_dump(data, sort_keys=False))


def spoil(folder, file, what, new):
    if file == URDF:
        text = (folder / URDF).read_text()
        assert what in text
        (folder / URDF).write_text(text.replace(what, new, 1))
    elif file == YAML:
        edit_yaml(folder, what, new)
    else:
        edit_yaml(folder, "ground.drive.left", "wheel_right_joint")
        edit_yaml(folder, "ground.drive.right", "wheel_left_joint")


@pytest.mark.parametrize("case", BROKEN)
def test_a_fault_is_named_and_no_other(folder, case):
    file, what, new, expected = BROKEN[case]
    spoil(folder, file, what, new)
    faults = inspect(folder).faults
    for text in expected:
        assert any(text in line for line in faults), faults
    assert len(faults) == len(expected), faults
    assert all(str(folder) in line and "\n" not in line for line in faults)


def test_a_missing_urdf_is_told_once_by_a_vehicle_with_a_sensor_on_a_link(folder):
    edit_yaml(folder, "sensors.lidar.mount", {"link": "lidar"})
    edit_yaml(folder, "ground.urdf", "burgr.urdf")
    (fault,) = inspect(folder).faults
    assert "burgr.urdf: no such file" in fault


def test_a_lidar_upside_down_is_level(folder):
    edit_yaml(folder, "sensors.lidar.mount.rpy", [3.1416, 0.0, 0.0])
    assert inspect(folder).faults == []


def test_of_a_sensor_apart_from_its_link_both_ways_to_move_it_are_said(folder):
    edit_yaml(folder, "sensors.lidar.mount.xyz", [-0.1, 0.0, 0.3])
    (fault,) = inspect(folder).faults
    wanted = "change its place in the URDF and write mount: {link: lidar}, or give it another frame"
    assert fault.endswith(f"to move the lidar, {wanted}")


def test_all_faults_come_in_one_run(folder):
    for case in ("zero inertia", "a wheel in the air", "an axis backwards", "a wrong track", "too small a radius"):
        spoil(folder, *BROKEN[case][:3])
    faults = inspect(folder).faults
    for case in ("zero inertia", "a wheel in the air", "an axis backwards", "a wrong track", "too small a radius"):
        assert any(BROKEN[case][3][0].removeprefix("burger.urdf:13: ") in line for line in faults), case


def test_faults_of_the_urdf_show_beside_those_of_the_file(folder):
    spoil(folder, *BROKEN["an unknown key"][:3])
    spoil(folder, *BROKEN["an unknown kind of joint"][:3])
    assert len(inspect(folder).faults) == 2


def test_a_castor_that_is_missing_is_named(folder):
    text = (folder / URDF).read_text()
    (folder / URDF).write_text(
        text.replace('<geometry><sphere radius="0.008"/></geometry>', '<geometry><sphere radius="0.003"/></geometry>', 1)
    )
    (fault,) = inspect(folder).faults
    assert "stands on a line, its wheels alone; give it a castor" in fault


def test_castors_that_take_the_wheels_weight_are_a_note(folder):
    link, joint = (
        re.search(f'<{tag} name="castor_{tag}".*?</{tag}>', (folder / "burger.urdf").read_text(), re.DOTALL)[0] for tag in ("link", "joint")
    )
    second = (link + joint).replace("castor_", "front_").replace('name="castor', 'name="front').replace('xyz="-0.081', 'xyz="0.081')
    spoil(folder, URDF, "</robot>", second + "</robot>")
    assert any("castors before and behind the axle" in note for note in inspect(folder).notes)


@pytest.mark.parametrize("kind", ["lidar", "encoders"])
def test_a_sensor_that_every_mission_needs_is_missed_in_a_note(folder, kind):
    data = yaml.safe_load((folder / YAML).read_text())
    del data["sensors"][kind]
    (folder / YAML).write_text(yaml.safe_dump(data, sort_keys=False))
    found = inspect(folder)
    assert found.faults == []
    assert any(note.startswith(f"no {kind}: no mission takes it") for note in found.notes)


def test_a_ring_of_joints_about_a_wheel_is_named(folder):
    hub = '<link name="hub"/>'
    ends = (("wheel_left_link", "hub"), ("hub", "wheel_left_link"))
    joints = "".join(f'<joint name="ring_{a}" type="fixed"><parent link="{a}"/><child link="{b}"/></joint>' for a, b in ends)
    spoil(folder, URDF, "</robot>", hub + joints + "</robot>")
    assert any("hangs on itself in a ring of joints" in fault for fault in inspect(folder).faults)


def test_beams_that_meet_the_body_are_a_note(folder):
    edit_yaml(folder, "sensors.lidar.mount.xyz", [-0.15, 0.0, 0.08])
    edit_yaml(folder, "sensors.lidar.frame", "scanner")
    found = inspect(folder)
    assert found.faults == []
    assert any("% of the lidar's beams meet the vehicle's own body" in line for line in found.notes)


def test_a_scanner_in_a_slot_that_the_collision_shape_bridges_is_no_fault(folder):
    """Between two decks, at their rim, as MiR's stands in a corner of its hull: most beams leave through the slot."""
    edit_yaml(folder, "sensors.lidar.mount.xyz", [0.03, 0.0, 0.08])
    edit_yaml(folder, "sensors.lidar.frame", "scanner")
    found = inspect(folder)
    assert found.faults == []
    assert any("% of the lidar's beams meet the vehicle's own body" in line for line in found.notes)


def test_an_aircraft_that_its_engine_refuses_is_named(tmp_path):
    shutil.copytree(ROOT / "vehicles" / "milvus", tmp_path / "milvus")
    edit_yaml(tmp_path / "milvus", "air.model", "milvos")
    assert any("there is no milvos/milvos.xml" in line for line in inspect(tmp_path / "milvus").faults)


def test_sides_that_no_lidar_sees_are_a_note(folder):
    edit_yaml(folder, "sensors.lidar.beams", 180)
    edit_yaml(folder, "sensors.lidar.angle_min", -1.5708)
    found = inspect(folder)
    assert found.faults == []
    (line,) = [line for line in found.notes if line.startswith("no lidar sees")]
    assert line.endswith("deg, counter-clockwise from ahead: only what was seen there before is known of")
