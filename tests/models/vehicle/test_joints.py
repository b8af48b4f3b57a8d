"""Joints in a vehicle's file and its URDF: each thing that cannot work is one line that says what to do."""

import pytest

from launch.vehicles.inspection import inspect
from services.sim_ground.build import build
from tests.services.mast import LIFT, MAST, PAN, mast_folder, mast_site, mast_urdf
from uvf.models.urdf.model import engine_urdf, load_urdf
from uvf.models.vehicle.joints import moved_joints
from uvf.models.yaml_data import BadInput


def faults(folder, urdf="", ground=None, **changed):
    return "\n".join(inspect(mast_folder(folder, urdf, ground={**MAST["ground"], **(ground or {})}, **changed)).faults)


def test_a_mast_with_a_lift_a_pan_and_a_spring_has_no_faults(tmp_path):
    assert faults(tmp_path) == ""


def test_range_speed_and_effort_are_those_of_the_urdf_also_of_the_one_that_engines_load(tmp_path):
    path = mast_folder(tmp_path) / "mast.urdf"
    for file in (path, engine_urdf(path)):
        joints = moved_joints(load_urdf(file), [LIFT, PAN])
        assert joints[LIFT] == (0.0, 0.3, 0.1, 30.0)
        assert joints[PAN] == (-float("inf"), float("inf"), 1.0, 2.0)


@pytest.mark.parametrize(
    ("urdf", "ground", "why"),
    [
        ({}, {"joints": ["lift_jont"]}, "no joint 'lift_jont' (named in vehicle.yaml); did you mean 'lift_joint'?"),
        ({}, {"joints": ["castor_joint"]}, "joint 'castor_joint' is 'fixed' and does not move"),
        ({}, {"joints": ["wheel_left_joint"]}, "the joint wheel_left_joint is named twice"),
        ({}, {"joints": [LIFT, LIFT]}, "joints[1]: the joint lift_joint is named twice"),
        ({}, {"springs": {LIFT: {"stiffness": 1.0, "damping": 1.0}}}, "the joint lift_joint is named twice; what is driven is not on"),
        ({"lift": '<limit lower="0" upper="0.3"/>'}, {}, 'joint \'lift_joint\': give its <limit> velocity="..." and effort="..."'),
        ({"lift": '<limit lower="0.1" upper="0.3" velocity="1" effort="1"/>'}, {}, "goes from 0.1 to 0.3: every joint begins at zero"),
        ({}, {"springs": {"tray_joint": {"stiffness": 8000.0, "damping": 4.0}}}, "needs physics_hz: 300"),
        ({}, {"springs": {"tray_joint": {"stiffness": 100.0, "damping": 100.0}}}, "needs physics_hz: 1000"),
        ({}, {"springs": {"tray_joint": {"stifness": 100.0, "damping": 1.0}}}, "stiffness"),
    ],
)
def test_what_cannot_move_is_a_fault(tmp_path, urdf, ground, why):
    assert why in faults(tmp_path, mast_urdf(**urdf), ground)


@pytest.mark.parametrize(
    ("sensors", "why"),
    [
        ({"lidar": {"mount": {"xyz": [0.0, 0.0, 0.1], "link": "head"}}}, "lidar: it sits on a link that is moved on command"),
        ({"camera": {"mount": {"link": "head"}, "depth": True}}, "camera: it sits on a link that is moved on command, but depth pictures"),
    ],
)
def test_what_is_read_as_on_the_body_is_not_mounted_on_what_moves(tmp_path, sensors, why):
    assert why in faults(tmp_path, sensors=sensors)


def test_a_mission_with_such_a_vehicle_is_refused_with_the_same_words(tmp_path):
    site = mast_site(tmp_path)
    mast_folder(tmp_path, mast_urdf(lift='<limit lower="0" upper="0.3"/>'))
    with pytest.raises(BadInput, match="give its <limit> velocity"):
        build(site)
