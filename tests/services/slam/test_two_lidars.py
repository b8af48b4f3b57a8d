"""Mapping with a second lidar: the first places the vehicle, both draw the map, and the session keeps what both saw."""

import numpy as np
import pytest

from schemas.messages import LaserScan
from services.slam.mapping_service import MappingParams, MappingService
from tests.runtime.stepping import stepped
from tests.services.slam.test_services import START, frame_at, frames_with
from uvf.models.vehicle.sensors import Lidar, Mount
from uvf.runtime.messages.convert import occupancy_cells, stamp
from uvf.slam.maps.session import MappingSession
from uvf.slam.methods import make_method, method_params

HALF = np.linspace(-np.pi / 2, np.pi / 2, 181)
FRONT, REAR = (
    Lidar(mount=Mount(), hz=5.0, beams=181, angle_min=HALF[0], angle_increment=np.pi / 180, range_min=0.1, range_max=5.0, frame=frame)
    for frame in ("lidar", "rear")
)


def half_scan(t, frame, wall):
    ranges = wall / np.maximum(np.cos(HALF), 0.05)
    return LaserScan(timestamp=stamp(t), frame_id=frame, start_angle=HALF[0], end_angle=HALF[-1], ranges=ranges.tolist())


def after_a_second(lidars, rear_until=9.0):
    service = MappingService("v", lidars, START, MappingParams(), lambda name: make_method(name, method_params(name, {}, "test")))
    out = {}
    for k in range(1, 12):
        t = 0.2 * k
        frames = frames_with(dict.fromkeys((t - 0.1, t), (0.0, 0.0, 0.0)))
        frames.add(frame_at(0.0, "base_footprint", "rear", (-0.2, 0.0, np.pi)), is_static=True)
        rear = [half_scan(t, "v/rear", 1.8)] if t <= rear_until else []
        out |= stepped(service, t + 0.01, scan=half_scan(t, "v/lidar", 3.0), other_scans=rear, frames=frames)
    return out


def occupied_behind(grid):
    """Cells of the wall that only the rear lidar sees, 2 m behind the vehicle's middle."""
    cells = occupancy_cells(grid)
    x = grid.pose.position.x + (np.arange(cells.shape[1]) + 0.5) * grid.cell_size.x
    return int((cells[:, np.abs(x + 2.0) < 0.1] > 50).sum())


def test_the_map_is_drawn_from_both():
    assert occupied_behind(after_a_second([FRONT, REAR])["map"]) > 15
    assert occupied_behind(after_a_second([FRONT])["map"]) == 0


def test_a_second_lidar_that_is_silent_ends_nothing():
    assert occupied_behind(after_a_second([FRONT, REAR], rear_until=0.0)["map"]) == 0


def test_the_session_keeps_what_both_saw():
    session = MappingSession.decoded(after_a_second([FRONT, REAR])["session"].data, "test")
    (other,) = session.keyframes[0].reading.others
    assert other.beams.origin == pytest.approx((-0.2, 0.0))
    assert np.cos(other.beams.bearings[90]) == pytest.approx(-1.0)
    assert other.ranges[90] == pytest.approx(1.8, abs=1e-6)


def test_of_a_quick_lidar_whose_newest_scan_is_always_ahead_of_the_odometry_the_one_before_is_taken():
    """100 scans a second, odometry 50 times: at each step the newest scan is 10 ms younger than the newest frame."""
    service = MappingService("v", [FRONT, REAR], START, MappingParams(), lambda name: make_method(name, method_params(name, {}, "test")))
    out = {}
    for k in range(1, 15):
        t = 0.1 * k
        frames = frames_with(dict.fromkeys((t - 0.3, t - 0.02), (0.0, 0.0, 0.0)))
        frames.add(frame_at(0.0, "base_footprint", "rear", (-0.2, 0.0, np.pi)), is_static=True)
        told = {"scan": half_scan(t - 0.01, "v/lidar", 3.0), "other_scans": [half_scan(t - 0.01, "v/rear", 1.8)]}
        out |= stepped(service, t, frames=frames, **told)
    assert occupied_behind(out["map"]) > 15
