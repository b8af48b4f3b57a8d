"""The gimbal looks where it is told, level or with the aircraft, at its own rate; chase and gimbal send beside the camera there was."""

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from schemas import topics
from schemas.messages import CompressedImage, FrameTransform, GimbalCommand, NavState
from services.sim_camera.build import build
from services.sim_camera.fitted import FittedCamera
from services.sim_camera.gimbal import Aim, joints_of
from services.sim_camera.renderer import Pose
from services.sim_camera.service import SimCamera
from tests.runtime.stepping import stepped
from tests.services.sim_camera.test_service import CAMERA, GreyRenderer
from uvf.maths.rotations import from_euler, matrix, multiply
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import Chase, Gimbal, Mount
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import array, quaternion, seconds, stamp, vector, wxyz

NOTHING_TOLD = {"objects": None, "aircraft": None, "gimbals": {}}

GIMBAL = Gimbal(mount=Mount(xyz=(0.4, 0.0, -0.1), rpy=(0.0, 0.0, 0.0)), hz=5.0, width=32, height=24, fov=0.9, slew=1.0)
LEVEL = from_euler(0.0, 0.0, 0.0)
BANKED = from_euler(0.5, -0.2, 2.0)
"""world_from_body of an aircraft in a climbing turn."""
LEVEL_TRUTH = NavState(timestamp=stamp(0.18), position=vector(np.zeros(3)), orientation=quaternion(LEVEL))
FOLLOW, LOCK, BODY = GimbalCommand.FOLLOW, GimbalCommand.LOCK, GimbalCommand.BODY


class Watching(GreyRenderer):
    """Remembers from where each picture was taken."""

    def __init__(self):
        super().__init__()
        self.taken = []

    def take(self, camera, body):
        self.taken.append(camera_pose(camera, body))
        return super().take(camera, body)


def camera_pose(camera, body):
    """(4, 4) world from the camera, by scipy."""
    turned = Rotation.from_quat(np.roll(body.world_from_body, -1))
    pose = np.eye(4)
    pose[:3, :3] = (turned * Rotation.from_euler("xyz", camera.mount.rpy)).as_matrix()
    pose[:3, 3] = body.position + turned.apply(camera.mount.xyz)
    return pose


def turned(command, seconds, gimbal=GIMBAL, body=LEVEL):
    aim = Aim(gimbal)
    aim.tell(command)
    for _ in range(round(seconds * 5)):
        aim.turn(body, 0.2)
    return aim


def axes(aim, body=LEVEL):
    """Columns: the camera's forward, left and up in the world."""
    return matrix(multiply(body, aim.body_from_camera))


def test_each_joint_turns_at_its_own_rate_and_stops_where_it_was_told():
    assert turned(GimbalCommand(pan=1.0), 0.6).joints.pan == pytest.approx(0.6)
    assert turned(GimbalCommand(pan=1.0, tilt=0.5), 3.0).joints == pytest.approx((1.0, 0.0, 0.5))


def test_joints_keep_within_their_travel_and_ignore_what_is_no_command():
    narrow = msgspec.structs.replace(GIMBAL, pan_max=0.5, tilt_max=0.3, roll_max=0.2)
    aim = turned(GimbalCommand(pan=2.0, tilt=2.0, mode=BODY), 5.0, narrow)
    assert aim.joints == pytest.approx((0.5, 0.0, 0.3))
    for none in (GimbalCommand(pan=math.nan), GimbalCommand(mode=9, pan=0.1)):
        aim.tell(none)
        aim.turn(LEVEL, 0.2)
        assert aim.joints == pytest.approx((0.5, 0.0, 0.3))
    assert turned(GimbalCommand(), 5.0, narrow, from_euler(0.6, 0.0, 0.0)).joints.roll == pytest.approx(-0.2)


def test_a_gimbal_that_goes_round_takes_the_shorter_way():
    aim = turned(GimbalCommand(pan=3.0), 5.0)
    aim.tell(GimbalCommand(pan=-3.0))
    for pan in (-2 * math.pi + 3.2, -3.0):
        aim.turn(LEVEL, 0.2)
        assert aim.joints.pan == pytest.approx(pan)


@pytest.mark.parametrize(("mode", "yaw"), [(FOLLOW, 2.0 + 0.4), (LOCK, 0.4)])
@pytest.mark.parametrize("mount", [(0.0, 0.0, 0.0), (0.0, 0.7, 0.3)])
def test_stabilised_its_horizon_is_level_whatever_the_aircraft_does(mode, yaw, mount):
    gimbal = msgspec.structs.replace(GIMBAL, mount=Mount(rpy=mount), roll_max=1.5)
    forward, left, up = axes(turned(GimbalCommand(pan=0.4, tilt=0.3, mode=mode), 9.0, gimbal, BANKED), BANKED).T
    assert left[2] == pytest.approx(0.0, abs=1e-9) and up[2] > 0
    assert forward == pytest.approx((math.cos(yaw) * math.cos(0.3), math.sin(yaw) * math.cos(0.3), -math.sin(0.3)))


def test_straight_down_the_upper_edge_of_the_picture_is_where_it_was_panned_to():
    free = msgspec.structs.replace(GIMBAL, roll_max=1.5)
    for pan in (0.0, 0.7, -2.0):
        forward, _, up = axes(turned(GimbalCommand(pan=pan, tilt=math.pi / 2, mode=LOCK), 9.0, free, BANKED), BANKED).T
        assert forward == pytest.approx((0.0, 0.0, -1.0), abs=1e-9)
        assert up == pytest.approx((math.cos(pan), math.sin(pan), 0.0), abs=1e-9)


def test_fixed_to_the_body_it_turns_with_the_aircraft():
    aim = turned(GimbalCommand(pan=0.4, tilt=0.3, mode=BODY), 9.0, body=BANKED)
    assert aim.joints == pytest.approx((0.4, 0.0, 0.3))
    assert aim.body_from_camera == pytest.approx(from_euler(0.0, 0.3, 0.4))


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_joints_are_the_euler_angles_of_the_order_z_x_y(pan, roll, tilt):
    turn = Rotation.from_euler("ZXY", (pan, roll, tilt)).as_quat()
    assert joints_of(np.roll(turn, 1)) == pytest.approx((pan, roll, tilt), abs=1e-6)


def test_what_is_rendered_is_what_the_frame_and_the_joints_tell():
    renderer = Watching()
    camera = msgspec.structs.replace(GIMBAL, mount=Mount(xyz=(0.4, 0.0, -0.1), rpy=(0.0, 0.5, 0.2)))
    service = SimCamera(renderer, [FittedCamera("v", camera, np.random.default_rng(1), "gimbal")], lambda model: Path())
    truth = {"v": NavState(timestamp=stamp(0.18), position=vector(np.array((1.0, 2.0, 3.0))), orientation=quaternion(BANKED))}
    ask = {"v": GimbalCommand(pan=0.4, tilt=0.2)}
    sent = [stepped(service, n / 5, truth=truth, **{**NOTHING_TOLD, "gimbals": ask}) for n in range(1, 6)][-1]
    frame: FrameTransform = sent["gimbal_frame"]["v"]
    assert (frame.parent_frame_id, frame.child_frame_id) == ("v/base_link", "v/gimbal")
    assert sent["gimbal"]["v"].frame_id == "v/gimbal_optical"
    assert seconds(frame.timestamp) == seconds(sent["gimbal"]["v"].timestamp) == pytest.approx(0.18)
    body = Rotation.from_quat(np.roll(BANKED, -1))
    told = body * Rotation.from_quat(np.roll(wxyz(frame.rotation), -1))
    assert renderer.taken[-1][:3, :3] == pytest.approx(told.as_matrix())
    assert renderer.taken[-1][:3, 3] == pytest.approx(np.array((1.0, 2.0, 3.0)) + body.apply(array(frame.translation)))
    joints = {joint.name: joint.position for joint in sent["gimbal_joints"]["v"].joints}
    by_joints = Rotation.from_euler("xyz", camera.mount.rpy) * Rotation.from_euler("ZXY", [joints[n] for n in ("pan", "roll", "tilt")])
    assert (body * by_joints).as_matrix() == pytest.approx(told.as_matrix())


def test_each_camera_of_a_vehicle_has_its_own_topic():
    chase = Chase(mount=Mount(xyz=(-6.0, 0.0, 2.0)), hz=5.0, width=16, height=16, fov=1.2)
    cameras = {"image": CAMERA, "chase": chase, "gimbal": GIMBAL}
    fitted = [FittedCamera("v", camera, np.random.default_rng(1), output) for output, camera in cameras.items()]
    sent = stepped(SimCamera(GreyRenderer(), fitted, lambda model: Path()), 0.2, truth={"v": LEVEL_TRUTH}, **NOTHING_TOLD)
    frames = {output: sent[output]["v"].frame_id for output in cameras}
    assert frames == {"image": "v/camera_optical", "chase": "v/chase_optical", "gimbal": "v/gimbal_optical"}
    assert {sent[info]["v"].width for info in ("info", "chase_info", "gimbal_info")} == {32, 16}
    assert SimCamera.outputs["image"].at("v") == "uvf/v/sensor/camera/image"
    assert SimCamera.outputs["chase"].at("v") == "uvf/v/sensor/chase/image"


MISSION = """
about: A look about.
world: house
vehicles:
  survey: {model: milvus_survey, system_id: 1, start: {x: -60.0, y: 0.0, z: 40.0, speed: 25.0}}
"""


def test_the_chase_camera_sees_its_own_aircraft(tmp_path):
    path = tmp_path / "look.yaml"
    path.write_text(MISSION)
    (host,) = build(load_scenario(path))
    service = host.make()
    truth = NavState(timestamp=stamp(0.38), position=vector(np.array((-60.0, 0.0, 40.0))))
    truth.orientation.w = 1.0
    chase = next(fitted for fitted in service._cameras if fitted.output == "chase")
    alone = [stepped(service, t, truth={"survey": truth}, **NOTHING_TOLD)["chase"].get("survey") for t in (0.2, 0.4)][-1]
    assert isinstance(alone, CompressedImage)
    seen = service._renderer.take(*chase.looking(_pose(truth), {})).picture[60:130, 60:180]
    service.close()
    orange = ((seen[:, :, 0] > 150) & (seen[:, :, 2] < 0.5 * seen[:, :, 0])).sum()
    assert orange > 50  # its wing


def _pose(truth):
    return Pose(np.array((truth.position.x, truth.position.y, truth.position.z)), wxyz(truth.orientation))


def test_depth_is_of_the_first_camera_only(tmp_path):
    path = tmp_path / "look.yaml"
    path.write_text(MISSION)
    site = load_scenario(path)
    member = site.members["survey"]
    deep = msgspec.structs.replace(member.file.sensors, gimbal=msgspec.structs.replace(GIMBAL, depth=True))
    object.__setattr__(member, "file", msgspec.structs.replace(member.file, sensors=deep))
    with pytest.raises(BadInput, match="gimbal: depth: only 'camera'"):
        build(site)


def test_the_survey_variant_keeps_the_sensors_of_milvus():
    survey, milvus = load_vehicle(ROOT / "vehicles", "milvus_survey").sensors, load_vehicle(ROOT / "vehicles", "milvus").sensors
    assert (survey.imu, survey.gnss, survey.camera) == (milvus.imu, milvus.gnss, milvus.camera)
    assert survey.gimbal is not None
    assert survey.lidar.beams == 181
    assert topics.GIMBAL.by("client").at("survey") == "uvf/survey/cmd/client/gimbal"
