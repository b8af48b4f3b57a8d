"""The odometry and mapping services step by step, on messages."""

from pathlib import Path

import numpy as np
import pytest

from schemas.messages import FrameTransform, Imu, LaserScan, MappingRequest, Quaternion, Vector3, WheelTicks
from services.slam import mapping_service
from services.slam.mapping_service import MappingParams, MappingService
from services.slam.odometry.service import OdometryService
from tests.runtime.stepping import stepped
from tests.services.live_params import all_settable_are_read
from tests.slam.room import ANGLES, measured
from uvf.estimation.odometry.params import OdometryParams
from uvf.maths.rotations import from_euler
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import Lidar, Mount
from uvf.runtime.messages.convert import occupancy_cells, planar_pose, quaternion, stamp, yaw_of
from uvf.runtime.messages.frames import FrameBuffer
from uvf.slam.graph.method import GraphSlam
from uvf.slam.hector.method import HectorSlam
from uvf.slam.methods import make_method, method_params

BURGER = load_vehicle(Path(ROOT) / "vehicles", "burger")
START = (2.0, 1.0, np.pi / 2)
RADIANS_PER_TICK = 0.001
LIDAR = Lidar(Mount((-0.03, 0.0, 0.2)), hz=5, beams=360, angle_min=0.0, angle_increment=0.01745, range_min=0.1, range_max=3.5)
BASE_FROM_LIDAR = (-0.03, 0.0, 0.0)


def drive(service, steps, turn_rate=0.0, ticks=4, correction=None):
    """On by ``ticks`` per wheel and step, turning as the gyroscope says; the last outputs."""
    body = BURGER.ground
    aside = turn_rate * body.drive.track / 2 * 0.02 / body.drive.wheel_radius / RADIANS_PER_TICK
    for k in range(1, steps + 1):
        t = 0.02 * k
        left, right = round((ticks - aside) * k), round((ticks + aside) * k)
        wheels = WheelTicks(timestamp=stamp(t - 0.02), left=left, right=right, radians_per_tick=RADIANS_PER_TICK)
        imu = [Imu(timestamp=stamp(t - 0.02 - s), angular_velocity=Vector3(z=turn_rate)) for s in (0.01, 0.0)]
        outputs = stepped(service, t, wheels=wheels, imu=imu, correction=correction)
    return outputs


def odometry_service():
    return OdometryService("v", BURGER, START, OdometryParams())


def speed_of(ticks):
    return ticks * RADIANS_PER_TICK * BURGER.ground.drive.wheel_radius / 0.02


def test_odometry_begins_at_zero_and_the_pose_at_the_start():
    outputs = drive(odometry_service(), 100)
    way = speed_of(4) * 2.0
    assert outputs["odometry"].pose.position.x == pytest.approx(way - speed_of(4) * 0.02, abs=1e-3)
    position = outputs["pose"].pose.position
    assert (position.x, position.y) == pytest.approx((2.0, 1.0 + way), abs=2e-3)
    assert yaw_of(outputs["pose"].pose.orientation) == pytest.approx(np.pi / 2)


def test_the_frames_are_named_after_the_vehicle():
    outputs = drive(odometry_service(), 2)
    odometry, moving = outputs["odometry"], outputs["moving"]
    assert (odometry.frame_id, odometry.body_frame_id) == ("v/odom", "v/base_footprint")
    assert (moving.parent_frame_id, moving.child_frame_id) == ("v/odom", "v/base_footprint")


def test_the_transform_of_the_base_is_the_odometry():
    outputs = drive(odometry_service(), 50, turn_rate=0.3)
    pose, moving = outputs["odometry"].pose, outputs["moving"]
    assert (moving.translation.x, moving.translation.y) == (pose.position.x, pose.position.y)
    assert yaw_of(moving.rotation) == pytest.approx(yaw_of(pose.orientation))


def test_the_map_corrects_the_pose_but_not_the_odometry():
    correction = FrameTransform(translation=Vector3(x=0.5), rotation=Quaternion(w=1.0))
    plain, corrected = drive(odometry_service(), 10), drive(odometry_service(), 10, correction=correction)
    assert corrected["odometry"] == plain["odometry"]
    assert corrected["pose"].pose.position.y - plain["pose"].pose.position.y == pytest.approx(0.5)


def test_the_motion_is_told_in_the_world_frame():
    state = drive(odometry_service(), 50)["nav_state"]
    assert (state.velocity.x, state.velocity.y) == pytest.approx((0.0, speed_of(4)), abs=1e-6)
    assert state.position_sigma >= OdometryParams().map_sigma


def test_a_wheel_message_seen_twice_moves_nothing():
    service = odometry_service()
    drive(service, 50, turn_rate=0.3)
    again = WheelTicks(timestamp=stamp(0.98), left=200, right=200, radians_per_tick=RADIANS_PER_TICK)
    first = stepped(service, 1.02, wheels=again, imu=[], correction=None)["odometry"].pose.position.x
    later = stepped(service, 3.0, wheels=again, imu=[], correction=None)["odometry"].pose.position.x
    assert later - first < speed_of(4) * 0.1


def test_parameters_of_the_odometry_count_while_running():
    service = odometry_service()
    with all_settable_are_read(service, besides=("correction_speed", "map_drift")):  # of satellites
        drive(service, 5)
    trusting, doubting = odometry_service(), odometry_service()
    doubting.params = OdometryParams(distance_noise=0.2)
    covariances = [drive(s, 50)["odometry"].pose_covariance[0] for s in (trusting, doubting)]
    assert covariances[1] > 100 * covariances[0]


def scan_at(t, pose):
    ranges = measured(pose, base_from_lidar=BASE_FROM_LIDAR)
    return LaserScan(timestamp=stamp(t), frame_id="v/lidar", start_angle=ANGLES[0], end_angle=ANGLES[-1], ranges=ranges.tolist())


def frame_at(t, parent, child, pose):
    flat = planar_pose(*pose)
    shift = Vector3(x=pose[0], y=pose[1])
    return FrameTransform(
        timestamp=stamp(t), parent_frame_id=f"v/{parent}", child_frame_id=f"v/{child}", translation=shift, rotation=flat.orientation
    )


def frames_with(poses):
    """The lidar's mount, and where the base was in the odometry's frame: poses by time."""
    frames = FrameBuffer()
    frames.add(frame_at(0.0, "base_footprint", "lidar", BASE_FROM_LIDAR), is_static=True)
    for t, pose in poses.items():
        frames.add(frame_at(t, "odom", "base_footprint", pose))
    return frames


def mapping(**params):
    return MappingService("v", [LIDAR], START, MappingParams(**params), lambda name: make_method(name, method_params(name, {}, "test")))


def map_for(seconds, pose_at, odometry_of, asked=None, service=None):
    """Steps a mapping service through a drive; all that it published. asked: requests by the number of the step."""
    service = service or mapping()
    said = []
    for k in range(1, round(seconds * 10) + 1):
        t = 0.1 * k
        frames = frames_with({t - s: odometry_of(pose_at(t - s)) for s in (0.2, 0.1, 0.0) if t - s > -1e-9})
        taken_at = 0.2 * (k // 2)
        said.append((t, stepped(service, t, scan=scan_at(taken_at, pose_at(taken_at)), frames=frames, mapping=(asked or {}).get(k, []))))
    return said


def straight(t):
    return (-1.0 + 0.2 * t, 0.2, 0.0)


@pytest.fixture(scope="module")
def drifting_run():
    """Odometry that begins at zero and reads 5 % too long."""
    return map_for(8.0, straight, lambda p: (1.05 * (p[0] + 1.0), p[1] - 0.2, p[2]))


def test_the_correction_takes_the_drift_away(drifting_run):
    correction = drifting_run[-1][1]["correction"]
    assert (correction.parent_frame_id, correction.child_frame_id) == ("v/map", "v/odom")
    assert correction.translation.x == pytest.approx(-0.05 * 0.2 * 8.0, abs=0.02)


def test_the_correction_never_jumps(drifting_run):
    shifts = [out["correction"].translation.x for _, out in drifting_run]
    assert np.abs(np.diff(shifts)).max() <= 0.01 + 1e-9


def test_the_map_is_published_once_a_second_and_only_when_it_has_changed(drifting_run):
    times = [t for t, out in drifting_run if "map" in out]
    assert np.diff(times).min() >= 1.0 - 1e-9
    assert len(times) >= 4
    standing = map_for(5.0, lambda t: (0.0, 0.0, 0.0), lambda p: p)
    assert sum("map" in out for _, out in standing) == 1


def test_keyframes_are_looked_through_only_when_there_is_one_more(monkeypatch):
    looked = []
    for name in ("keyframes", "session"):
        told = getattr(GraphSlam, name)
        monkeypatch.setattr(GraphSlam, name, lambda self, name=name, told=told: looked.append(name) or told(self))
    map_for(15.0, lambda t: (0.0, 0.0, 0.0), lambda p: p)
    assert looked == ["keyframes", "session", "keyframes"]  # the session holds the keyframes


def test_where_nothing_comes_back_the_floor_is_mapped_as_free_on_the_way(monkeypatch):
    monkeypatch.setitem(globals(), "measured", lambda *_, **__: np.zeros(len(ANGLES)))
    said = map_for(20.0, straight, lambda p: (p[0] + 1.0, p[1] - 0.2, p[2]))
    known = [(occupancy_cells(out["map"]) >= 0).sum() for _, out in said if "map" in out]
    assert known[-1] > 1.5 * known[0]


def test_the_map_shows_the_room_where_it_is(drifting_run):
    grid = [out["map"] for _, out in drifting_run if "map" in out][-1]
    cells = occupancy_cells(grid)
    assert grid.frame_id == "v/map"

    def at(x, y):
        """Of a point in the room: the map begins where the drive did."""
        column = (x + 1.0 - grid.pose.position.x) / grid.cell_size.x
        row = (y - 0.2 - grid.pose.position.y) / grid.cell_size.y
        return cells[int(row), int(column)]

    assert at(-0.5, 0.2) < 30
    assert max(at(0.0, y) for y in (1.93, 1.97)) > 60
    assert at(0.0, 2.3) == -1


def test_a_scanner_that_hangs_upside_down_draws_no_mirror_image():
    pose = (-1.0, 0.2, 0.3)
    upright, hanging = (mapping() for _ in range(2))
    expected = stepped(upright, 0.1, scan=scan_at(0.1, pose), frames=frames_with({0.1: pose}))["map"]
    seen = scan_at(0.1, pose)
    mirrored = LaserScan(timestamp=seen.timestamp, frame_id=seen.frame_id, start_angle=-seen.end_angle, ranges=seen.ranges[::-1])
    frames = frames_with({0.1: pose})
    mount = frame_at(0.0, "base_footprint", "lidar", BASE_FROM_LIDAR)
    mount.rotation.CopyFrom(quaternion(from_euler(np.pi, 0.0, 0.0)))
    frames.add(mount, is_static=True)
    drawn, meant = occupancy_cells(stepped(hanging, 0.1, scan=mirrored, frames=frames)["map"]), occupancy_cells(expected)
    assert drawn.shape == meant.shape and np.mean(drawn != meant) < 0.01


def test_the_map_is_placed_in_the_world_once(drifting_run):
    placings = [out["placing"] for _, out in drifting_run if "placing" in out]
    assert len(placings) == 1
    assert (placings[0].parent_frame_id, placings[0].child_frame_id) == ("world", "v/map")
    assert placings[0].translation.x == 2.0


def test_a_scan_waits_until_it_is_known_where_the_vehicle_was():
    service = mapping()
    scan = scan_at(0.2, (0.0, 0.2, 0.0))
    assert stepped(service, 0.2, scan=scan, frames=frames_with({0.18: (0.0, 0.0, 0.0)})) == {}
    assert "map" in stepped(service, 0.3, scan=scan, frames=frames_with({0.18: (0.0, 0.0, 0.0), 0.28: (0.0, 0.0, 0.0)}))


def test_scans_without_a_place_are_told_of_once_with_the_reason():
    service = mapping()
    frames = FrameBuffer()
    frames.add(frame_at(0.1, "odom", "base_footprint", (0.0, 0.0, 0.0)))
    events = [e for k in range(1, 80) for e in stepped(service, 0.1 * k, scan=scan_at(0.1, (0.0, 0.2, 0.0)), frames=frames)["events"]]
    assert [(e.text, e.cause) for e in events] == [("scans cannot be mapped", "no frame 'v/lidar'; there are: v/base_footprint, v/odom")]


def test_parameters_of_the_mapping_count_while_running():
    service = mapping()
    changed = 0

    def step(k):
        t = 0.2 * k
        pose = (0.05 * k - 1.0, 0.2, 0.0)
        return stepped(service, t, scan=scan_at(t, pose), frames=frames_with({t: (0.05 * k, 0.0, 0.0)}))

    with all_settable_are_read(service):
        for k in range(1, 11):
            changed += "map" in step(k)
    assert changed >= 1


def asked_for(action, method=""):
    return [MappingRequest(action=action, method=method)]


def test_a_map_that_is_held_stays_as_it_is_until_it_goes_on():
    said = map_for(
        8.0, straight, lambda p: (p[0] + 1.0, p[1] - 0.2, p[2]), {20: asked_for(MappingRequest.HOLD), 60: asked_for(MappingRequest.GO_ON)}
    )
    assert all(out["mapping"][0].accepted for _, out in said if out["mapping"])
    held = [out for t, out in said if 2.0 < t < 5.9]
    assert not any("map" in out or "fix" in out for out in held) and all("correction" in out for out in held)
    assert any("fix" in out for t, out in said if t > 6.2)


def test_another_map_is_begun_with_another_method_where_the_vehicle_is(monkeypatch):
    made = []
    monkeypatch.setattr(mapping_service, "warm_up", made.append)
    service = mapping()
    said = map_for(8.0, straight, lambda p: (p[0] + 1.0, p[1] - 0.2, p[2]), {40: asked_for(MappingRequest.BEGIN, "hector")}, service)
    assert isinstance(service._method, HectorSlam) and service.params.method == "hector" and len(made) == 1
    (told,) = [event for _, out in said for event in out["events"] if event.text == "another map is begun"]
    assert told.cause == "with method hector"
    x, y = said[-1][1]["fix"].x, said[-1][1]["fix"].y
    assert (x, y) == pytest.approx((1.6, 0.0), abs=0.1)


def test_a_method_that_there_is_not_is_refused_and_the_map_goes_on():
    said = map_for(
        3.0, straight, lambda p: (p[0] + 1.0, p[1] - 0.2, p[2]), {20: asked_for(MappingRequest.BEGIN, "gmaping"), 21: asked_for(99)}
    )
    replies = [out["mapping"][0] for _, out in said if out["mapping"]]
    assert not any(reply.accepted for reply in replies)
    assert "no SLAM method 'gmaping'" in replies[0].reason and "no action 99" in replies[1].reason
    assert any("fix" in out for t, out in said if t > 2.2)
