"""What the simulator sends: rates, frames, conventions, and the same bytes from the same seed."""

import numpy as np
import pytest

from schemas import topics
from tests.services.sim_ground.ride import STILL, ride, site_with
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import Twist
from uvf.maths.raycast import Rays, cast
from uvf.models.scenario import ROOT
from uvf.models.shapes.scene import scene
from uvf.models.world.file import load_world
from uvf.models.world.geometry import solids
from uvf.runtime.messages.convert import array, seconds

START = (6.0, 4.4, 0.3)


@pytest.fixture(scope="module")
def resting(tmp_path_factory):
    return ride(site_with(tmp_path_factory.mktemp("site"), {"burger": START}), 4.0, {"burger": lambda t: STILL})


@pytest.mark.parametrize(
    ("topic", "count"),
    [
        (topics.IMU, 400),
        (topics.SCAN, 20),
        (topics.WHEELS, 200),
        (topics.CONTACT, 80),
        (topics.JOINTS, 80),
        (topics.TRUTH, 200),
        (topics.TF_JOINTS, 80),
        (topics.TF_STATIC, 1),
    ],
)
def test_each_topic_keeps_its_rate(resting, topic, count):
    assert len(resting.of(topic)) == count


def test_stamps_are_the_times_of_the_readings(resting):
    assert [round(seconds(s.timestamp), 9) for s in resting.of(topics.SCAN)[:3]] == [0.2, 0.4, 0.6]


def test_at_rest_the_imu_feels_gravity_and_the_earths_field(resting):
    force = np.mean([array(m.specific_force) for m in resting.of(topics.IMU)], axis=0)
    assert force == pytest.approx((0.0, 0.0, GRAVITY), abs=0.1)
    field = np.mean([array(m.magnetic_field) for m in resting.of(topics.IMU)], axis=0)
    east = field[0] * np.cos(START[2]) - field[1] * np.sin(START[2])
    assert (east, field[2]) == pytest.approx((1.8e-6, -38.9e-6), abs=3e-7)


def test_the_gyroscope_has_noise_and_a_constant_bias(resting):
    rates = np.array([array(m.angular_velocity) for m in resting.of(topics.IMU)])
    assert rates.std(axis=0) == pytest.approx((0.002,) * 3, rel=0.2)
    assert 1e-5 < np.abs(rates.mean(axis=0)).max() < 0.005


def test_the_scan_goes_counter_clockwise_from_straight_ahead(resting):
    scan = resting.of(topics.SCAN)[-1]
    assert scan.frame_id == "burger/lidar"
    assert (scan.start_angle, scan.end_angle) == pytest.approx((0.0, np.radians(359)))
    x, y, yaw = START
    lidar = np.array((x - 0.032 * np.cos(yaw), y - 0.032 * np.sin(yaw), 0.182))
    angles = yaw + np.radians(np.arange(360))
    level = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(360)))
    true = cast(scene(solids(load_world(ROOT / "worlds", "house"))), [], Rays(lidar, level), 100.0)
    ranges = np.array(scan.ranges)
    near = (true > 0.2) & (true < 3.4)
    assert np.abs(ranges - true)[near].std() == pytest.approx(0.01 * np.sqrt(1 - 2 / np.pi), rel=0.3)
    assert (ranges[true > 3.6] == 0.0).all()


def test_the_frames_of_all_sensors_and_links_are_told_once(resting):
    frames = {f.child_frame_id: f.parent_frame_id for f in resting.of(topics.TF_STATIC)[0].transforms}
    assert frames == {
        "burger/base_link": "burger/base_footprint",
        "burger/castor_link": "burger/base_link",
        "burger/lidar": "burger/base_link",
        "burger/imu": "burger/base_link",
        "burger/camera": "burger/base_link",
        "burger/camera_optical": "burger/camera",
    }


def test_truth_is_the_point_on_the_floor_under_the_axle(resting):
    truth = resting.of(topics.TRUTH)[-1]
    assert array(truth.position) == pytest.approx((6.0, 4.4, 0.0), abs=1e-3)


def curve(t):
    return Twist(0.2, 0.6 * np.sin(t))


def test_the_same_seed_gives_the_same_bytes(tmp_path):
    first, second = (ride(site_with(tmp_path, {"burger": START}), 2.0, {"burger": curve}) for _ in range(2))
    assert len(first.data) == 531
    assert first.data == second.data


def test_another_seed_gives_other_noise_but_the_same_ride(tmp_path):
    first, second = (ride(site_with(tmp_path, {"burger": START}, seed), 1.0, {"burger": curve}) for seed in (1, 2))
    assert first.of(topics.TRUTH) == second.of(topics.TRUTH)
    assert first.of(topics.SCAN) != second.of(topics.SCAN)
