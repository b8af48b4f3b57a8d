"""The links of a URDF as frames: rooted in base_footprint, turned by their joints."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas.messages import JointState, JointStates
from uvf.maths.se3 import apply
from uvf.models.scenario import ROOT
from uvf.models.vehicle.sensors import ImuSensor, Mount, Sensors
from uvf.runtime.messages.convert import array, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.link_frames import Links

WHEELS = ("wheel_left_joint", "wheel_right_joint")
BURGER = ROOT / "vehicles" / "burger" / "burger.urdf"


def urdf(folder, links, *joints):
    """joints: (parent, child, attributes of origin, axis, type)."""
    rows = [f'<link name="{link}"/>' for link in links]
    for parent, child, origin, axis, kind in joints:
        ends = f'<parent link="{parent}"/><child link="{child}"/>'
        rows.append(f'<joint name="{child}_joint" type="{kind}">{ends}<origin {origin}/><axis xyz="{axis}"/></joint>')
    path = folder / "robot.urdf"
    path.write_text(f'<robot name="robot">{"".join(rows)}</robot>')
    return path


def fixed(parent, child, origin=""):
    return (parent, child, origin, "1 0 0", "fixed")


def buffer_of(links, states=None):
    frames = FrameBuffer()
    frames.add(links.resting("v", Sensors(), 0.0), is_static=True)
    if states is not None:
        frames.add(links.turned("v", states))
    return frames


def states_at(t, **angles):
    return JointStates(timestamp=stamp(t), joints=[JointState(name=name, position=angle) for name, angle in angles.items()])


@pytest.mark.parametrize(
    ("links", "joints", "way"),
    [
        (["base_link", "arm"], [fixed("base_link", "arm")], ["arm", "base_link", "base_footprint"]),
        (["base_footprint", "base_link"], [fixed("base_footprint", "base_link")], ["base_link", "base_footprint"]),
        (["chassis", "arm"], [fixed("chassis", "arm")], ["arm", "chassis", "base_link", "base_footprint"]),
        (["base_footprint", "arm"], [fixed("base_footprint", "arm")], ["arm", "base_footprint"]),
        (["frame", "base_link"], [fixed("frame", "base_link")], ["base_link", "frame", "base_footprint"]),
    ],
)
def test_every_tree_begins_with_base_footprint_and_has_a_base_link(tmp_path, links, joints, way):
    parents = {
        f.child_frame_id: f.parent_frame_id for f in Links(urdf(tmp_path, links, *joints), ()).resting("v", Sensors(), 0.0).transforms
    }
    for child, parent in pairwise(way):
        assert parents[f"v/{child}"] == f"v/{parent}"
    assert "v/base_footprint" not in parents
    assert "v/base_link" in parents


def test_an_offset_between_footprint_and_base_is_the_files(tmp_path):
    path = urdf(tmp_path, ["base_footprint", "base_link"], fixed("base_footprint", "base_link", 'xyz="0 0 0.01"'))
    assert buffer_of(Links(path, ())).lookup("v/base_footprint", "v/base_link").translation == pytest.approx((0, 0, 0.01))


def test_a_joint_turns_its_link_about_its_own_axis(tmp_path):
    joint = ("base_link", "wheel", 'xyz="1 2 3" rpy="0.3 -0.2 0.5"', "0 3 4", "continuous")
    links = Links(urdf(tmp_path, ["base_link", "wheel"], joint), ["wheel_joint"])
    found = buffer_of(links, states_at(1.0, wheel_joint=0.7)).lookup("v/base_link", "v/wheel", 1.0)
    rotation = Rotation.from_euler("ZYX", (0.5, -0.2, 0.3)) * Rotation.from_rotvec(0.7 * np.array((0, 0.6, 0.8)))
    points = np.array(((1.0, 0, 0), (0, 1.0, 0), (0.2, -0.1, 0.7)))
    assert apply(found, points) == pytest.approx(rotation.apply(points) + np.array((1, 2, 3)))


def test_a_wheel_rolling_forward_carries_its_top_forward():
    links = Links(BURGER, WHEELS)
    frames = buffer_of(links, states_at(1.0, wheel_left_joint=0.1, wheel_right_joint=0.2))
    for wheel, y, angle in (("left", 0.08, 0.1), ("right", -0.08, 0.2)):
        (top,) = apply(frames.lookup("v/base_footprint", f"v/wheel_{wheel}_link", 1.0), np.array(((0, 0, 0.033),)))
        assert top == pytest.approx((0.033 * np.sin(angle), y, 0.033 + 0.033 * np.cos(angle)))


def test_wheels_move_and_the_rest_is_static():
    links = Links(BURGER, WHEELS)
    resting = {f.child_frame_id for f in links.resting("v", Sensors(), 0.0).transforms}
    assert resting == {"v/base_link", "v/castor_link", "v/lidar"}
    turned = links.turned("v", states_at(1.0, wheel_left_joint=0.1, wheel_right_joint=0.2, propeller=1.0))
    assert {f.child_frame_id for f in turned.transforms} == {"v/wheel_left_link", "v/wheel_right_link"}


def test_a_joint_that_nobody_reads_stands_at_zero(tmp_path):
    joint = ("base_link", "swivel", 'xyz="-1 0 0"', "0 0 1", "continuous")
    frames = buffer_of(Links(urdf(tmp_path, ["base_link", "swivel"], joint), ()))
    assert frames.lookup("v/base_link", "v/swivel", 9.0).translation == pytest.approx((-1, 0, 0))


def test_a_sensors_mount_holds_over_a_link_of_its_name(tmp_path):
    links = Links(urdf(tmp_path, ["base_link", "imu"], fixed("base_link", "imu", 'xyz="0 0 9"')), ())
    sensors = Sensors(imu=ImuSensor(mount=Mount((0.0, 0.0, 0.5)), hz=100.0))
    told = [f for f in links.resting("v", sensors, 0.0).transforms if f.child_frame_id == "v/imu"]
    assert [array(f.translation).tolist() for f in told] == [[0.0, 0.0, 0.5]]
