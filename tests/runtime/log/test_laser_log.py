"""Our own logs as SLAM is fed with them."""

import numpy as np
import pytest

from benchmarks.slam.slow_lidar import slow_site
from launch.attachments import attachments
from launch.slam.opening import open_log
from schemas import topics
from schemas.messages import FrameTransform, FrameTransforms, LaserScan, Odometry, Vector3
from uvf.maths.rotations import from_euler
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import planar_pose, quaternion, stamp

DEMO = ROOT / "tests" / "golden" / "demo.mcap"


def mount(vehicle, x=0.1, roll=0.0):
    def edge(parent, child, translation, turn):
        names = {"parent_frame_id": f"{vehicle}/{parent}", "child_frame_id": f"{vehicle}/{child}"}
        return FrameTransform(timestamp=stamp(0.0), translation=translation, rotation=quaternion(turn), **names)

    return FrameTransforms(transforms=[edge("base_footprint", "lidar", Vector3(x=x, z=0.2), from_euler(roll, 0.0, 0.0))])


def scan(vehicle, t, ranges=(1.0, 2.0, 0.0)):
    return LaserScan(timestamp=stamp(t), frame_id=f"{vehicle}/lidar", start_angle=0.0, end_angle=1.0, ranges=ranges)


def odometry(t, x, yaw=0.0):
    return Odometry(timestamp=stamp(t), pose=planar_pose(x, 0.0, yaw))


def recorded(folder, messages, name="made.mcap", files=None):
    """messages: (topic, vehicle, t, message); files: what is attached."""
    path = folder / name
    with Recorder(path, files) as recorder:
        for i, (topic, vehicle, t, message) in enumerate(messages):
            data = message if isinstance(message, bytes) else message.SerializeToString()
            recorder.write(Sample(topic.at(vehicle), topic.message.DESCRIPTOR.full_name, data, round(t * 1e9), i, 0))
    return path


def run(vehicle="rover", roll=0.0, scans=(0.2, 0.4, 0.6)):
    tracked = [(topics.ODOMETRY, vehicle, 0.1 * i, odometry(0.1 * i, 3.0 + 0.1 * i)) for i in range(1, 8)]
    swept = [(topics.SCAN, vehicle, t, scan(vehicle, t)) for t in scans]
    return [(topics.TF_STATIC, vehicle, 0.0, mount(vehicle, roll=roll)), *tracked, *swept]


def test_a_recorded_run_is_a_log():
    log = open_log(DEMO)
    reading = log.readings[3]
    assert (len(log), log.notes) == (40, ())
    assert log.name == "demo-burger"
    assert reading.beams.origin == pytest.approx((-0.032, 0.0))
    assert len(reading.beams.bearings) == len(reading.ranges) == 360
    assert 0 < reading.returned.sum() < 360
    assert log.readings[0].odom_from_base == pytest.approx((0.0, 0.0, 0.0))


def test_odometry_is_taken_at_the_stamp_of_the_scan(tmp_path):
    log = open_log(recorded(tmp_path, run(scans=(0.25, 0.45))))
    assert log.odom_from_base == pytest.approx(np.array([(0.0, 0.0, 0.0), (0.2, 0.0, 0.0)]))
    assert log.stamps.tolist() == [0.25, 0.45]
    assert log.readings[0].returned.tolist() == [True, True, False]


def test_a_lidar_upside_down_turns_the_other_way(tmp_path):
    upright, hanging = (open_log(recorded(tmp_path, run(roll=r))).readings[0].beams for r in (0.0, np.pi))
    assert upright.bearings == pytest.approx((0.0, 0.5, 1.0))
    assert hanging.bearings == pytest.approx((0.0, -0.5, -1.0))
    assert hanging.origin == pytest.approx((0.1, 0.0))


def points_of(reading):
    return reading.beams.directions * reading.ranges[:, None] + np.array(reading.beams.origin)


@pytest.mark.parametrize("clockwise", [False, True])
def test_the_sweeps_of_a_slow_lidar_are_set_straight(tmp_path, clockwise):
    """At 1 m/s, seen from the last beam's place, what the first of three beams has hit is 0.2 m farther back, and 0.1 m the second."""
    files = attachments(slow_site(tmp_path / "site", clockwise))
    slow = open_log(recorded(tmp_path, run(scans=(0.2, 0.4)), files=files))
    once = open_log(recorded(tmp_path, run(scans=(0.2, 0.4)), "bare.mcap"))
    assert slow.stamps == pytest.approx([0.4, 0.6])
    assert [r.t for r in slow] == pytest.approx([0.4, 0.6])
    assert slow.odom_from_base == pytest.approx(np.array([(0.0, 0.0, 0.0), (0.2, 0.0, 0.0)]))
    before, after = points_of(once.readings[0])[:2], points_of(slow.readings[0])
    back = np.array(((0.0, 0.0), (0.1, 0.0)) if clockwise else ((0.2, 0.0), (0.1, 0.0)))
    assert (after[::-1] if clockwise else after)[:2] == pytest.approx(before - back)
    assert slow.readings[0].returned.sum() == once.readings[0].returned.sum() == 2
    assert (slow.notes, once.notes) == ((), ())


def test_a_sweep_that_ends_after_the_odometry_is_left_out(tmp_path):
    log = open_log(recorded(tmp_path, run(scans=(0.2, 0.65)), files=attachments(slow_site(tmp_path / "site"))))
    assert log.stamps == pytest.approx([0.4])
    assert "1 scans without odometry" in log.notes[0]


def test_files_in_a_log_that_cannot_be_read_are_told_of(tmp_path):
    files = attachments(slow_site(tmp_path / "site")) | {"vehicles/slow/vehicle.yaml": b"kind: balloon"}
    log = open_log(recorded(tmp_path, run(scans=(0.2, 0.4)), files=files))
    assert log.stamps.tolist() == [0.2, 0.4]
    assert len(log.notes) == 1 and "the files of the run in it cannot be read" in log.notes[0]


def test_odometry_that_leaps_is_taken_for_standing_still(tmp_path):
    jumped = [(topics.ODOMETRY, "rover", 0.1 * i, odometry(0.1 * i, 90.0 + 0.1 * i)) for i in range(8, 20)]
    log = open_log(recorded(tmp_path, [*run(scans=(0.2, 1.8)), *jumped]))
    assert log.odom_from_base[1] == pytest.approx((1.5, 0.0, 0.0))
    assert "1 leaps" in log.notes[0]


def test_the_logs_of_a_run_are_one(tmp_path):
    whole = run(scans=(0.2, 0.4, 0.6))
    early, late = ([m for m in whole if m[2] == 0.0 or (m[2] < 0.35) is first] for first in (True, False))
    recorded(tmp_path, early, "log-000.mcap")
    recorded(tmp_path, late, "log-001.mcap")
    log = open_log(tmp_path)
    assert log.stamps == pytest.approx([0.2, 0.4, 0.6])
    assert log.odom_from_base[-1] == pytest.approx((0.4, 0.0, 0.0))


def test_of_several_vehicles_one_must_be_named(tmp_path):
    path = recorded(tmp_path, run("rover") + run("other"))
    with pytest.raises(BadInput, match="other, rover"):
        open_log(path)
    with pytest.raises(BadInput, match="did you mean 'rover'"):
        open_log(path, "rovr")
    assert len(open_log(path, "rover")) == 3


def test_what_cannot_be_used_is_left_out_and_told(tmp_path):
    broken = (topics.SCAN, "rover", 0.65, b"\xff\xff")
    log = open_log(recorded(tmp_path, [*run(scans=(0.2, 0.4, 5.0)), broken]))
    assert len(log) == 2
    assert "1 scans without odometry" in log.notes[0]
    assert "1 messages" in log.notes[1]


def test_what_is_no_number_is_left_out_and_told(tmp_path):
    pointless = scan("rover", 0.5)
    pointless.start_angle = float("nan")
    broken = [(topics.SCAN, "rover", 0.5, pointless), (topics.SCAN, "rover", 0.55, scan("rover", 0.55, ()))]
    for t, message in ((0.35, odometry(0.35, float("nan"))), (0.45, odometry(0.45, 1.0, float("nan")))):
        broken.append((topics.ODOMETRY, "rover", t, message))
    log = open_log(recorded(tmp_path, [*run(), *broken]))
    assert log.stamps == pytest.approx([0.2, 0.4, 0.6])
    assert log.odom_from_base[:, 0] == pytest.approx([0.0, 0.2, 0.4])
    assert len(log.notes) == 1 and "4 messages" in log.notes[0]


@pytest.mark.parametrize(
    ("kept", "told"), [("tf", "where the lidar sits"), ("odometry", "no odometry of 'rover'"), ("scan", "no scan in it")]
)
def test_a_log_that_lacks_something_says_what(tmp_path, kept, told):
    topic = {"tf": topics.TF_STATIC, "odometry": topics.ODOMETRY, "scan": topics.SCAN}[kept]
    with pytest.raises(BadInput, match=told):
        open_log(recorded(tmp_path, [m for m in run() if m[0] is not topic]))


def test_a_mount_that_is_no_number_is_not_told(tmp_path):
    with pytest.raises(BadInput, match="where the lidar sits"):
        open_log(recorded(tmp_path, [(topics.TF_STATIC, "rover", 0.0, mount("rover", x=float("nan"))), *run()[1:]]))


def test_files_of_other_kinds_are_refused_by_what_they_are(tmp_path):
    (tmp_path / "scan.csv").write_text("1,2")
    (tmp_path / "run.clf").write_text("")
    for name, told in (("scan.csv", "neither a CARMEN log"), ("", r"name a log in it: run\.clf"), ("run.clf", "is empty")):
        with pytest.raises(BadInput, match=told):
            open_log(tmp_path / name)
    with pytest.raises(BadInput, match="leave out --vehicle"):
        open_log(tmp_path / "run.clf", "rover")
