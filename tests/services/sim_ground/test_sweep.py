"""A lidar that takes its time: each beam from where the body was at its moment."""

import copy
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from schemas import topics
from services.sim_ground.rig import Moment, Rig
from tests.services.sim_ground.ground_scene import body_at, scene_of
from tests.services.sim_ground.ride import ride, site_with
from tests.services.sim_ground.test_lidar import QUIET
from uvf.maths.kinematics import Twist
from uvf.models.vehicle.sensors import Mount
from uvf.runtime.messages.convert import seconds
from uvf.sensors.range_sensors import LidarModel

SLOW = msgspec.structs.replace(QUIET, sweep_time=0.2, mount=Mount((-0.05, 0.02, 0.182)))
END = 1.0  # s, at the last beam
BOX = scene_of(((2.5, 0.0, 1.0), (1.0, 20.0, 2.0)), ((0.0, 2.5, 1.0), (20.0, 1.0, 2.0)), ((-1.4, -1.2, 1.0), (0.5, 0.7, 2.0)))
MOMENTS = np.linspace(END - 0.2, END, SLOW.beams)


def turning(t):
    return body_at(yaw=1.5 * t)


def on_an_arc(t):
    """Faster and faster."""
    return body_at(0.5 * t * t, 0.2 * t, yaw=1.5 * np.sin(3.0 * t), roll=0.02 * t)


def swept(lidar, body_at_time):
    model = LidarModel(lidar, BOX, np.random.default_rng(0))
    for k in range(101):
        model.track.add(0.01 * k, body_at_time(0.01 * k))
    return model.sweep(END, [])


def one_by_one(lidar, body_at_time, moments):
    """Beam k of a scan that is taken at once at the moment of beam k."""
    at_once = LidarModel(lidar, BOX, np.random.default_rng(0))
    return np.array([at_once.scan(body_at_time(t), [])[k] for k, t in enumerate(moments)])


@pytest.mark.parametrize("motion", [turning, on_an_arc])
@pytest.mark.parametrize("clockwise", [False, True], ids=["left about", "right about"])
def test_each_beam_is_cast_from_where_the_body_was(motion, clockwise):
    lidar = msgspec.structs.replace(SLOW, clockwise=clockwise)
    found = swept(lidar, motion)
    meant = one_by_one(lidar, motion, MOMENTS[::-1] if clockwise else MOMENTS)
    assert np.quantile(np.abs(found - meant), 0.98) < 1e-3  # but beams that just meet an edge or just do not
    assert np.mean(np.abs(found - LidarModel(lidar, BOX, np.random.default_rng(0)).scan(motion(END), [])) > 0.02) > 0.2


@pytest.mark.parametrize("clockwise", [False, True], ids=["left about", "right about"])
def test_the_last_beam_is_that_of_a_scan_taken_now(clockwise):
    lidar = msgspec.structs.replace(SLOW, clockwise=clockwise)
    now = LidarModel(lidar, BOX, np.random.default_rng(0)).scan(on_an_arc(END), [])
    last = 0 if clockwise else -1
    assert swept(lidar, on_an_arc)[last] == pytest.approx(now[last], abs=1e-9)


def test_standing_still_a_sweep_is_a_scan():
    standing = body_at(0.3, -0.2, 0.7)
    noisy = msgspec.structs.replace(SLOW, noise=0.01)
    scan = LidarModel(noisy, BOX, np.random.default_rng(0)).scan(standing, [])
    np.testing.assert_allclose(swept(noisy, lambda t: standing), scan, atol=1e-9)


def slow_site(folder, sweep_time, latency=0.0):
    """The burger in the house, its lidar changed."""
    site = site_with(folder, {"burger": (2.2, 1.3, 0.5)})
    burger = site.members["burger"]
    lidar = msgspec.structs.replace(burger.file.sensors.lidar, sweep_time=sweep_time, latency=latency)
    sensors = msgspec.structs.replace(burger.file.sensors, lidar=lidar)
    return replace(site, members={"burger": replace(burger, file=msgspec.structs.replace(burger.file, sensors=sensors))})


@pytest.mark.parametrize("sweep_time", [0.0, 0.15])
def test_the_stamp_is_that_of_the_first_beam_and_the_scan_comes_after_the_last(tmp_path, sweep_time):
    record = ride(slow_site(tmp_path, sweep_time, latency=0.03), 1.0, {"burger": lambda t: Twist(0.0, 1.0)})
    stamps = [seconds(scan.timestamp) for scan in record.of(topics.SCAN)]
    assert stamps == pytest.approx([0.2 * k - sweep_time for k in range(1, 5)])
    sent = [stamp_ns / 1e9 for key, stamp_ns, _ in record.data if key == topics.SCAN.at("burger")]
    assert sent == pytest.approx([0.2 * k + 0.03 for k in range(1, 5)])


def test_a_state_that_is_kept_within_a_sweep_goes_on_with_its_first_half(tmp_path):
    site = slow_site(tmp_path, 0.2)
    member = site.members["burger"]
    rig = Rig(site, member, member.file.ground, BOX)

    def scan(rig, steps, turn):
        return [rig.read(0.01 * k, Moment(body_at(yaw=turn * 0.01 * k))).get("scan") for k in steps][-1]

    scan(rig, range(1, 31), 1.5)
    kept = copy.deepcopy(rig)
    assert scan(rig, range(31, 41), -3.0).ranges != scan(copy.deepcopy(kept), range(31, 41), 1.5).ranges
    whole = Rig(site, member, member.file.ground, BOX)
    assert scan(kept, range(31, 41), 1.5).ranges == scan(whole, range(1, 41), 1.5).ranges
