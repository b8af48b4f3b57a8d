"""Lifts, heads and arms of others: what their makers move on command stays a joint, and everything that hangs on it goes with it."""

import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from launch.vehicles.inspection import inspect
from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from tests.launch.vehicles.test_importing_drives import BOTH, HULL
from uvf.models.urdf.model import engine_urdf, load_urdf
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.joints import moved_joints
from uvf.models.yaml_data import BadInput

CASTOR = (
    '<link name="castor"><collision><geometry><sphere radius="0.02"/></geometry></collision></link><joint name="castor" type="fixed">'
    '<parent link="base_link"/><child link="castor"/><origin xyz="-0.17 0 -0.07"/></joint>'
)
INERTIAL = '<inertial><mass value="{m}"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>'
BLOCK = '<collision><geometry><box size="0.06 0.06 0.06"/></geometry></collision>'


def link(name, mass=None, shape=BLOCK):
    return f'<link name="{name}">{INERTIAL.format(m=mass) if mass else ""}{shape}</link>'


def joint(name, kind, parent, child, place, axis, more=""):
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{place}"/><axis xyz="{axis}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{more}</joint>'


def limit(low, high, speed=0.2, effort=80.0):
    return f'<limit lower="{low}" upper="{high}" velocity="{speed}" effort="{effort}"/>'


def transmission(name, interface="hardware_interface/PositionJointInterface"):
    face = f"<hardwareInterface>{interface}</hardwareInterface>"
    return f'<transmission name="t_{name}"><type>Simple</type><joint name="{name}">{face}</joint></transmission>'


BODY = [
    link("pillar", 1.0),
    joint("pillar_joint", "fixed", "base_link", "pillar", "-0.06 0 0.1", "0 0 1"),
    link("torso", 2.0),
    joint("torso_joint", "prismatic", "pillar", "torso", "0.02 0 0.1", "0 0 1", limit(0.0, 0.4)),
    link("neck", shape=""),
    joint("neck_joint", "fixed", "torso", "neck", "0 0 0.1", "0 0 1"),
    link("head", 0.3),
    joint("head_joint", "revolute", "neck", "head", "0 0 0.1", "0 0 1", limit(-1.0, 1.0, 1.5, 3.0)),
    link("eye", 0.1),
    joint("eye_joint", "fixed", "head", "eye", "0.05 0 0", "0 0 1"),
    link("flap", 0.1),
    joint("flap_joint", "revolute", "base_link", "flap", "0 0 0.08", "0 1 0", limit(-1.0, 1.0)),
    link("finger", 0.1),
    joint("finger_joint", "prismatic", "head", "finger", "0 0.05 0", "0 1 0", limit(0.0, 0.1) + '<mimic joint="torso_joint"/>'),
]
CAMERA = (
    '<gazebo reference="eye"><sensor type="camera" name="eye"><update_rate>5</update_rate><camera><horizontal_fov>1.2</horizontal_fov>'
    "<image><width>64</width><height>48</height></image></camera></sensor></gazebo>"
)
MOVED = ("torso_joint", "head_joint", "finger_joint", "wheel_left_joint", "wheel_right_joint")
TRANSMISSIONS = "".join(map(transmission, MOVED))
CONTROL = "".join(f'<joint name="{name}"><command_interface name="position"/></joint>' for name in MOVED)


def taken(tmp_path, *parts, joints=()):
    (tmp_path / "x.urdf").write_text(f'<robot name="it">{HULL}{BOTH}{CASTOR}{"".join(BODY)}{"".join(parts)}</robot>')
    notes = import_vehicle(tmp_path / "x.urdf", tmp_path / "it", joints=joints)
    return tmp_path / "it", notes


@pytest.mark.parametrize("told", [TRANSMISSIONS, f'<ros2_control name="c" type="system">{CONTROL}</ros2_control>'])
def test_what_their_makers_move_stays_a_joint_with_its_range_and_strength(tmp_path, told):
    folder, notes = taken(tmp_path, told)
    file, model = load_vehicle(folder.parent, "it"), load_urdf(folder / "it.urdf")
    assert file.ground.joints == ["torso_joint", "head_joint"]
    assert moved_joints(model, file.ground.joints) == {"torso_joint": (0.0, 0.4, 0.2, 80.0), "head_joint": (-1.0, 1.0, 1.5, 3.0)}
    assert any("joints that are moved on command: torso_joint, head_joint" in line for line in notes)
    assert any("held fast at zero" in line and "flap_joint" in line and "finger_joint" in line for line in notes)
    assert [line for line in inspect(folder).faults if "lidar" not in line] == []


def test_every_link_is_where_the_file_has_it_whatever_the_joints_do(tmp_path):
    folder, _ = taken(tmp_path, TRANSMISSIONS)
    theirs, ours = load_urdf(tmp_path / "x.urdf"), load_urdf(folder / "it.urdf")
    for angles in ({}, {"torso_joint": 0.3, "head_joint": 0.7}):
        before, after = theirs.link_poses(angles), ours.link_poses(angles)
        for name in ("torso", "head", "eye", "finger", "flap"):
            floor = 0.09  # base_link of theirs is that high above the floor
            assert after[name].translation == pytest.approx(before[name].translation + np.array((0.0, 0.0, floor)), abs=1e-6)
            assert abs(after[name].rotation @ before[name].rotation) == pytest.approx(1.0)


def test_nothing_is_gained_or_lost_of_what_it_weighs(tmp_path):
    folder, _ = taken(tmp_path, TRANSMISSIONS)
    model = load_urdf(folder / "it.urdf")
    masses = {name: link.inertial.mass for name, link in model.links.items() if link.inertial is not None}
    assert masses["torso"] == pytest.approx(2.0) and masses["head"] == pytest.approx(0.5)
    assert sum(masses.values()) == pytest.approx(8 + 2 * 0.3 + 1.0 + 2.0 + 0.3 + 0.1 + 0.1 + 0.1)


def test_it_rises_and_turns_in_the_physics(tmp_path):
    folder, _ = taken(tmp_path, TRANSMISSIONS)
    body = load_vehicle(folder.parent, "it").ground
    world = BulletWorld([], {"it": BodyPlacement(body, engine_urdf(folder / body.urdf), (0.0, 0.0, 0.0))})
    world.advance({}, 3.0, joints={"it": {"torso_joint": 0.35, "head_joint": -0.6}})
    assert [position for position, _ in world.state("it").joints] == pytest.approx([0.35, -0.6], abs=3e-3)
    assert np.linalg.norm(world.state("it").position) < 2e-3
    world.close()


def test_a_camera_on_the_head_goes_with_it(tmp_path):
    folder, _ = taken(tmp_path, TRANSMISSIONS, CAMERA)
    mount = load_vehicle(folder.parent, "it").sensors.camera.mount
    assert mount.link == "eye" and mount.xyz == pytest.approx((0.01, 0.0, 0.49), abs=1e-6)


def test_a_depth_camera_on_the_head_stays_at_zero_and_is_told_of(tmp_path):
    folder, notes = taken(tmp_path, TRANSMISSIONS, CAMERA.replace('type="camera"', 'type="depth"'))
    assert load_vehicle(folder.parent, "it").sensors.camera.mount.link is None
    assert any("sensors on links that are moved on command stay where they are at zero: eye" in line for line in notes)


def test_without_a_word_of_it_all_is_held_unless_it_is_asked_for(tmp_path):
    (tmp_path / "a").mkdir(), (tmp_path / "b").mkdir()
    folder, notes = taken(tmp_path / "a")
    assert load_vehicle(folder.parent, "it").ground.joints == []
    assert any("held fast at zero" in line and "torso_joint" in line and "--joint" in line for line in notes)
    folder, _ = taken(tmp_path / "b", joints=["torso_joint"])
    assert load_vehicle(folder.parent, "it").ground.joints == ["torso_joint"]


def test_a_joint_that_is_not_there_is_refused_with_the_nearest(tmp_path):
    with pytest.raises(BadInput, match="no joint 'torso_jont'; did you mean 'torso_joint'"):
        taken(tmp_path, joints=["torso_jont"])


def test_what_weighs_nothing_and_states_no_speed_gets_some_and_is_told_of(tmp_path):
    bare = [link("pan", shape=""), joint("pan_joint", "continuous", "base_link", "pan", "0 0 0.2", "0 0 1"), transmission("pan_joint")]
    folder, notes = taken(tmp_path, *bare)
    assert [line for line in inspect(folder).faults if "lidar" not in line] == []
    assert any("guessed: speed and effort" in line and "pan_joint" in line for line in notes)


def test_a_range_without_zero_is_told_of(tmp_path):
    odd = [
        link("arm", 0.2),
        joint("arm_joint", "revolute", "base_link", "arm", "0 0 0.2", "0 1 0", limit(0.2, 1.0)),
        transmission("arm_joint"),
    ]
    folder, notes = taken(tmp_path, *odd)
    assert load_vehicle(folder.parent, "it").ground.joints == []
    assert any("whose range does not hold zero" in line and "arm_joint" in line for line in notes)


def test_gazebos_position_controllers_tell_it_too(tmp_path):
    plugin = '<plugin filename="gz-sim-joint-position-controller-system" name="p"><joint_name>torso_joint</joint_name></plugin>'
    folder, _ = taken(tmp_path, f"<gazebo>{plugin}</gazebo>")
    assert load_vehicle(folder.parent, "it").ground.joints == ["torso_joint"]
