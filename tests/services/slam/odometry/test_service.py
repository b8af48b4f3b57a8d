"""The odometry service on messages: slip and calibration are told once, satellites move the pose and not the odometry, work is taken up."""

import msgspec
import numpy as np
import pytest

from schemas.messages import FrameTransform, Imu, KeyValuePair, MapFix, Odometry, Vector3, WheelTicks
from services.slam.odometry.service import SCALES, OdometryService
from tests.estimation.odometry.test_satellites import GOOD, TANGENT, fix_at
from tests.runtime.stepping import recall, stepped
from tests.services.live_params import all_settable_are_read
from uvf.estimation.odometry.params import OdometryParams
from uvf.maths.kinematics import Twist, move
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.messages.convert import quaternion, seconds, stamp, yaw_of

BURGER = load_vehicle(ROOT / "vehicles", "burger")
HEARING = msgspec.structs.replace(BURGER, sensors=msgspec.structs.replace(BURGER.sensors, gnss=GOOD))
START = Pose2(100.0, -40.0, 0.5)
TICK, DT = 0.0005, 0.02  # rad, s


class Bench:
    """A vehicle that moves as it is told, and its service; the wheels' true radii are ``radius`` times those of the file."""

    def __init__(self, params=None, file=BURGER, radius=1.0):
        self.service = OdometryService("v", file, START, params or OdometryParams(), TANGENT)
        self.radius, self.t, self.pose, self.before = radius, 0.0, IDENTITY, Twist(0.0, 0.0)
        self.turned = np.zeros(2)
        self.events, self.said = [], []
        self.rng = np.random.default_rng(1)

    def drive(self, duration, twist, *, spin=0.0, corrected=None, fixes=False, matched=None):
        """twist: of the vehicle; spin: m/s that both wheels roll on top; corrected: map_from_odom by the odometry's pose.

        matched: where scans are matched, by the true pose.
        """
        for _ in range(round(duration / DT)):
            self.t += DT
            mean = Twist(*((a + b) / 2 for a, b in zip(self.before, twist, strict=True)))
            force = (twist.linear - self.before.linear) / DT
            self.before = twist
            self.pose = move(self.pose, mean, DT)
            side = mean.angular * BURGER.ground.drive.track / 2
            ways = np.array((mean.linear - side, mean.linear + side)) + spin
            self.turned += ways * DT / (BURGER.ground.drive.wheel_radius * self.radius)
            left, right = (int(n) for n in np.floor(self.turned / TICK))
            stamped = stamp(self.t - DT)
            wheels = WheelTicks(timestamp=stamped, left=left, right=right, radians_per_tick=TICK)
            imu = Imu(
                timestamp=stamped,
                angular_velocity=Vector3(z=mean.angular),
                specific_force=Vector3(x=force + mean.angular**2 * 0.032, z=9.81),
            )
            told = self.said[-1]["odometry"] if self.said else None
            correction = corrected(self, told) if corrected and told else None
            fix = [fix_at(self.t - DT, compose(START, self.pose), mean, self.rng)] if fixes and round(self.t / DT) % 10 == 0 else []
            match = MapFix(timestamp=stamped, **matched(self.pose)._asdict()) if matched and round(self.t / DT) % 10 == 0 else None
            self.said.append(stepped(self.service, self.t, wheels=wheels, imu=[imu], correction=correction, gnss=fix, fix=match))
            self.events += self.said[-1].get("events", [])
        return self

    @property
    def newest(self):
        return self.said[-1]


def by_scans(bench, told):
    """A map that knows the pose, ten times a second."""
    if round(bench.t / DT) % 5:
        return None
    odom = Pose2(told.pose.position.x, told.pose.position.y, yaw_of(told.pose.orientation))
    x, y, yaw = compose(bench.pose, inverse(odom))
    noise = 0.002 * bench.rng.standard_normal(2)
    return FrameTransform(
        timestamp=stamp(bench.t), translation=Vector3(x=x + noise[0], y=y + noise[1]), rotation=quaternion(from_euler(0.0, 0.0, yaw))
    )


@pytest.mark.parametrize("kind", ["ekf", "ukf"])
def test_either_filter_follows_the_vehicle(kind):
    bench = Bench(OdometryParams(filter=kind)).drive(1.0, Twist(0.0, 0.0)).drive(4.0, Twist(0.3, 0.5))
    told = bench.newest["odometry"].pose
    assert (told.position.x, told.position.y) == pytest.approx(bench.pose[:2], abs=0.02)
    assert yaw_of(told.orientation) == pytest.approx(bench.pose.yaw, abs=0.02)


def test_slip_is_told_once_with_what_disagrees_and_in_the_quality():
    bench = Bench().drive(1.0, Twist(0.0, 0.0)).drive(1.0, Twist(0.2, 0.0)).drive(2.0, Twist(0.2, 0.0), spin=0.3)
    (event,) = bench.events
    assert event.source == "odometry" and "slip" in event.text
    assert "wheel rolls 0.50 m/s" in event.cause
    assert max(out["quality"].slip_ratio for out in bench.said if "quality" in out) > 1.0
    assert bench.newest["odometry"].pose.position.x == pytest.approx(bench.pose.x, abs=0.15)


def test_wheels_that_grip_are_not_accused():
    bench = Bench().drive(1.0, Twist(0.0, 0.0)).drive(3.0, Twist(0.3, 0.4)).drive(2.0, Twist(-0.2, 0.0)).drive(1.0, Twist(0.0, 0.0))
    assert bench.events == []


def test_a_closed_loop_moves_the_matches_and_neither_the_odometry_nor_its_trust_in_the_wheels():
    """By half a metre; the correction glides there at 0.1 m/s."""
    offset = [0.0, 0.0]

    def gliding(bench, told):
        offset[1] = min(offset[1] + 0.1 * DT, offset[0])
        return FrameTransform(timestamp=stamp(bench.t), translation=Vector3(x=-offset[1]), rotation=quaternion(from_euler(0.0, 0.0, 0.0)))

    def matched(pose):
        return Pose2(pose.x - offset[0], pose.y, pose.yaw)

    bench = Bench().drive(1.0, Twist(0.0, 0.0), corrected=gliding, matched=matched)
    bench.drive(4.0, Twist(0.2, 0.0), corrected=gliding, matched=matched)
    offset[0] = 0.5
    bench.drive(6.0, Twist(0.2, 0.0), corrected=gliding, matched=matched)
    assert bench.events == []
    assert min(out["odometry"].linear_velocity.x for out in bench.said[-300:]) > 0.19
    assert bench.newest["odometry"].pose.position.x == pytest.approx(bench.pose.x, abs=0.01)


def test_motion_that_the_scans_do_not_see_is_no_motion():
    """A vehicle that has lost its inertial unit and spins against a wall."""
    service, t, events = OdometryService("v", BURGER, START, OdometryParams()), 0.0, []
    for k in range(500):
        t += DT
        ticks = round(0.3 * t / BURGER.ground.drive.wheel_radius / TICK)
        wheels = WheelTicks(timestamp=stamp(t - DT), left=ticks, right=ticks, radians_per_tick=TICK)
        out = stepped(service, t, wheels=wheels, imu=[], fix=MapFix(timestamp=stamp(t - DT)) if k % 10 == 0 else None)
        events += out.get("events", [])
    assert [e.cause.startswith("the wheels rolled") for e in events] == [True]
    assert out["odometry"].pose_covariance[0] > 0.01


def test_scales_are_offered_once_they_are_certain():
    bench = Bench(OdometryParams(calibrate="tell"), radius=1.04)
    way_and_back(bench)
    (event,) = bench.events
    assert "params: {odometry: {left_scale: 1.0" in event.text and "to use them" in event.text
    offered = float(event.text.split("left_scale: ")[1].split(",")[0])
    assert offered == pytest.approx(1.04, abs=0.015)
    assert SCALES not in {pair.key for pair in bench.newest["odometry"].metadata}


def way_and_back(bench):
    bench.drive(1.0, Twist(0.0, 0.0))
    for _ in range(6):
        bench.drive(4.0, Twist(0.45, 0.0), corrected=by_scans).drive(2.0, Twist(0.2, 1.3), corrected=by_scans)
        bench.drive(2.0, Twist(0.3, -0.9), corrected=by_scans)


def test_scales_are_put_in_force_where_that_is_wanted_and_outlive_the_service():
    bench = Bench(OdometryParams(calibrate="apply"), radius=1.04)
    way_and_back(bench)
    assert len(bench.events) == 1 and "in force" in bench.events[0].text
    left_over = {pair.key: pair.value for pair in bench.newest["odometry"].metadata}
    assert float(left_over[SCALES].split()[0]) == pytest.approx(1.04, abs=0.015)
    again = Bench(OdometryParams(calibrate="apply"), radius=1.04)
    recall(again.service, odometry=bench.newest["odometry"])
    again.t, again.turned, again.pose, again.before = bench.t, bench.turned.copy(), bench.pose, bench.before
    start = bench.newest["odometry"].pose.position
    again.drive(2.0, bench.before)
    end = again.newest["odometry"].pose.position
    assert again.said[0]["odometry"].pose_covariance[0] == pytest.approx(bench.newest["odometry"].pose_covariance[0], rel=0.1)
    gone = np.hypot(end.x - start.x, end.y - start.y)
    assert gone == pytest.approx(np.hypot(again.pose.x - bench.pose.x, again.pose.y - bench.pose.y), rel=0.02)


def test_off_says_nothing():
    bench = Bench(OdometryParams(calibrate="off"), radius=1.04)
    way_and_back(bench)
    assert bench.events == []


def test_satellites_move_the_pose_in_the_world_and_not_the_odometry():
    hearing, deaf = (
        Bench(file=file).drive(1.0, Twist(0.0, 0.0)).drive(8.0, Twist(0.4, 0.1), fixes=file is HEARING) for file in (HEARING, BURGER)
    )
    assert hearing.newest["odometry"].pose == deaf.newest["odometry"].pose
    state, true = hearing.newest["nav_state"], compose(START, hearing.pose)
    assert np.hypot(state.position.x - true.x, state.position.y - true.y) < 4 * state.position_sigma
    assert state.position_sigma < 0.3
    assert hearing.newest["pose"].pose.position.x == state.position.x
    assert [out for out in hearing.said if "quality" in out][-1]["quality"].position_known


def test_parameters_of_the_satellites_count_while_running():
    bench = Bench(file=HEARING)
    with all_settable_are_read(bench.service):
        bench.drive(2.0, Twist(0.2, 0.0), fixes=True, corrected=by_scans)


def test_the_covariance_of_pose_and_speed_is_told():
    told = Bench().drive(1.0, Twist(0.0, 0.0)).drive(5.0, Twist(0.3, 0.3)).newest["odometry"]
    pose, speed = (np.array(c).reshape(6, 6) for c in (told.pose_covariance, told.velocity_covariance))
    assert np.linalg.eigvalsh(pose).min() > -1e-15
    assert 0.0 < pose[0, 0] < 0.1 and pose[5, 5] > 0.0 and pose[2, 2] == 0.0
    assert 0.0 < speed[0, 0] < 0.01 and 0.0 < speed[5, 5] < 0.01


def test_the_quality_comes_twice_a_second_and_knows_whether_scans_are_matched():
    doubtful = OdometryParams(distance_noise=0.2)
    blind = Bench(doubtful).drive(8.0, Twist(0.3, 0.0))
    seeing = Bench(doubtful).drive(8.0, Twist(0.3, 0.0), corrected=by_scans)
    assert sum("quality" in out for out in blind.said) == 16
    assert [[out["quality"].position_known for out in b.said if "quality" in out][-1] for b in (blind, seeing)] == [False, True]


@pytest.mark.parametrize("scales", ["x", "1 1", "nan 1 1", "9 9 9", "1 1 1 1"])
def test_scales_left_by_somebody_else_are_not_taken_up_blindly(scales):
    left = {"wheel_ticks": "0 0", "gyro_bias": "0.0", SCALES: scales}
    bench = Bench()
    metadata = [KeyValuePair(key=k, value=v) for k, v in left.items()]
    recall(bench.service, odometry=Odometry(metadata=metadata, pose_covariance=[-1.0] * 36))
    told = bench.drive(2.0, Twist(0.2, 0.0)).newest["odometry"]
    assert told.pose.position.x == pytest.approx(0.4, abs=0.05)
    assert seconds(told.timestamp) == pytest.approx(2.0)
