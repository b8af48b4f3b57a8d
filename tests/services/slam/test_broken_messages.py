"""Readings that cannot be true move no odometry and spoil no map; the service goes on with the next good one."""

import math

import numpy as np
import pytest

from schemas.messages import FrameTransform, Imu, KeyValuePair, LaserScan, Odometry, Quaternion, Vector3, WheelTicks
from services.slam.odometry.service import OdometryService
from tests.runtime.stepping import recall, stepped
from tests.services.slam.test_services import BURGER, LIDAR, START, drive, frames_with, mapping, scan_at
from tests.slam.room import ANGLES
from uvf.estimation.odometry.params import OdometryParams
from uvf.runtime.messages.convert import occupancy_cells, planar_pose, stamp


def scan(t, ranges):
    return LaserScan(timestamp=stamp(t), frame_id="v/lidar", start_angle=ANGLES[0], end_angle=ANGLES[-1], ranges=ranges)


def mapped(*scans):
    """The last map of a mapper that stands still and is handed these scans, and the mapper."""
    service = mapping(map_period=0.1)
    grid = None
    for k, ranges in enumerate(scans, 1):
        t = 0.2 * k
        frames = frames_with(dict.fromkeys((t - 0.05, t), (0.01 * k, 0.0, 0.0)))
        grid = stepped(service, t + 0.01, scan=scan(t, ranges), frames=frames).get("map", grid)
    return grid, service


def good():
    return np.full(len(ANGLES), 2.0).tolist()


@pytest.mark.parametrize("broken", [[math.nan] * 360, [math.inf] * 360, [-1.0] * 360, [1e9] * 360, [1e300] * 360, [], [0.0], [2.0]])
def test_no_scan_makes_the_map_grow_beyond_what_the_lidar_sees(broken):
    grid, _ = mapped(good(), broken, good())
    cells = occupancy_cells(grid)
    assert cells.shape[0] * 0.05 < 3 * 2 * LIDAR.range_max and cells.shape[1] * 0.05 < 3 * 2 * LIDAR.range_max
    assert (cells > 60).any()


def test_a_scan_whose_directions_are_no_numbers_is_left_out():
    service = mapping()
    pointless = scan(0.2, good())
    pointless.end_angle = math.nan
    stepped(service, 0.21, scan=pointless, frames=frames_with(dict.fromkeys((0.15, 0.2), (0.0, 0.0, 0.0))))
    out = stepped(service, 0.41, scan=scan(0.4, good()), frames=frames_with(dict.fromkeys((0.35, 0.4), (0.0, 0.0, 0.0))))
    assert (occupancy_cells(out["map"]) > 60).any()


def test_a_beam_beyond_the_range_is_no_return():
    far, none = mapped([9.0] * 360)[0], mapped([0.0] * 360)[0]
    assert far.data == none.data


@pytest.mark.parametrize("jump", [10**9, -(10**15), 2**62])
def test_counters_that_jump_move_nothing(jump):
    service = OdometryService("v", BURGER, START, OdometryParams())
    before = drive(service, 20)["odometry"].pose.position.x
    wheels = WheelTicks(timestamp=stamp(0.4), left=jump, right=jump, radians_per_tick=0.001)
    stepped(service, 0.42, wheels=wheels, imu=[], correction=None)
    after = stepped(
        service,
        0.44,
        wheels=WheelTicks(timestamp=stamp(0.42), left=jump + 4, right=jump + 4, radians_per_tick=0.001),
        imu=[],
        correction=None,
    )
    assert after["odometry"].pose.position.x == pytest.approx(before, abs=0.02)


@pytest.mark.parametrize("size", [0.0, -1.0, 1e11])
def test_ticks_of_no_size_move_nothing(size):
    service = OdometryService("v", BURGER, START, OdometryParams())
    drive(service, 5)
    out = stepped(service, 0.12, wheels=WheelTicks(timestamp=stamp(0.1), left=24, right=24, radians_per_tick=size), imu=[], correction=None)
    assert abs(out["odometry"].pose.position.x) < 0.05


@pytest.mark.parametrize("mad", [1e11, math.nan, math.inf])
@pytest.mark.parametrize("axis", ["x", "z"])
@pytest.mark.parametrize("of", ["angular_velocity", "specific_force"])
def test_an_inertial_unit_gone_mad_leaves_finite_numbers(mad, axis, of):
    service = OdometryService("v", BURGER, START, OdometryParams())
    drive(service, 5)
    imu = Imu(timestamp=stamp(0.1), specific_force=Vector3(z=9.81))
    setattr(getattr(imu, of), axis, mad)
    out = stepped(
        service, 0.12, wheels=WheelTicks(timestamp=stamp(0.1), left=24, right=24, radians_per_tick=0.001), imu=[imu], correction=None
    )
    assert_finite(out)


def assert_finite(out):
    for pose in (out["odometry"].pose, out["pose"].pose):
        assert all(map(math.isfinite, (pose.position.x, pose.position.y, pose.orientation.w, pose.orientation.z)))


@pytest.mark.parametrize("broken", [{"translation": Vector3(x=math.nan)}, {"rotation": Quaternion(w=math.nan)}])
def test_a_correction_that_is_no_number_is_none(broken):
    service = OdometryService("v", BURGER, START, OdometryParams())
    assert_finite(drive(service, 5, correction=FrameTransform(timestamp=stamp(0.1), **broken)))


def test_a_correction_without_orientation_is_none_of_the_heading():
    out = drive(OdometryService("v", BURGER, START, OdometryParams()), 5, correction=FrameTransform())
    assert math.isfinite(out["pose"].pose.position.x)


@pytest.mark.parametrize(
    "left", [{}, {"wheel_ticks": "x"}, {"wheel_ticks": "1 2", "gyro_bias": "nan"}, {"wheel_ticks": "1 2 3", "gyro_bias": "0"}]
)
def test_an_odometry_left_by_somebody_else_is_not_taken_up_blindly(left):
    service = OdometryService("v", BURGER, START, OdometryParams())
    recall(service, odometry=Odometry(pose=planar_pose(1.0, 2.0, 0.0), metadata=[KeyValuePair(key=k, value=v) for k, v in left.items()]))
    assert math.isfinite(drive(service, 5)["odometry"].pose.position.x)


def test_a_map_that_is_too_large_is_told_of_once_and_the_pose_goes_on(monkeypatch):
    monkeypatch.setattr("uvf.slam.maps.tiles.MOST_CELLS", 100)
    service, said = mapping(map_period=0.1), []
    for k in range(1, 30):
        here = (0.06 * k, 0.0, 0.0)
        frames = frames_with(dict.fromkeys((0.2 * k - 0.05, 0.2 * k), here))
        said.append(stepped(service, 0.2 * k + 0.01, scan=scan_at(0.2 * k, here), frames=frames))
    told = [event for out in said for event in out["events"]]
    assert [event.text for event in told] == ["the map cannot be drawn"]
    assert "look for a jump in the odometry" in told[0].cause
    assert all("fix" in out and "correction" in out for out in said)
    assert not any("map" in out for out in said)
