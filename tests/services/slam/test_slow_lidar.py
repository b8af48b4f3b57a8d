"""A lidar that takes its time, mapped: by the service step by step, and in the simulator with de-skewing and without."""

import msgspec
import numpy as np
import pytest

from benchmarks.slam.slow_lidar import errors
from schemas.messages import LaserScan
from services.slam.mapping_service import MappingParams, MappingService
from tests.planar_rays import cast
from tests.runtime.stepping import stepped
from tests.services.slam.test_services import BASE_FROM_LIDAR, LIDAR, START, frames_with
from tests.slam.room import ANGLES, BOXES, CIRCLES, RANGE_MAX, measured
from uvf.maths.se2 import compose, transform
from uvf.runtime.messages.convert import seconds, stamp
from uvf.slam.graph.method import GraphParams, GraphSlam

SWEEP, END = 0.2, 0.6  # s
SLOW = msgspec.structs.replace(LIDAR, sweep_time=SWEEP)
RIGHT_ABOUT = msgspec.structs.replace(SLOW, clockwise=True)


class Kept(GraphSlam):
    """Keeps what it is fed with."""

    def __init__(self):
        super().__init__(GraphParams())
        self.fed = []

    def add(self, reading):
        self.fed.append(reading)
        return super().add(reading)


def pose_at(t):
    """Turning ever faster, up to 1.5 rad/s at the end; in the room."""
    return (-1.0 + 0.4 * t, 0.2, 1.25 * t * t)


def scan_of(lidar):
    """Ends at ``END``; each beam from where the lidar was at its moment."""
    moments = np.linspace(END - SWEEP, END, len(ANGLES))
    ranges = []
    for t, angle in zip(moments[::-1] if lidar.clockwise else moments, ANGLES, strict=True):
        x, y, yaw = compose(pose_at(t), BASE_FROM_LIDAR)
        ranges.append(cast(np.array((x, y)), np.array((yaw + angle,)), BOXES, CIRCLES)[0])
    seen = np.where(np.array(ranges) <= RANGE_MAX, ranges, 0.0).tolist()
    return LaserScan(timestamp=stamp(END - SWEEP), frame_id="v/lidar", start_angle=ANGLES[0], end_angle=ANGLES[-1], ranges=seen)


def frames_until(end):
    return frames_with({t: pose_at(t) for t in np.arange(0.0, end + 1e-9, 0.02)})


def service(lidar):
    method = Kept()
    return MappingService("v", [lidar], START, MappingParams(), lambda name: method), method


def off_the_surfaces(reading):
    """Share of the points, seen from the true pose, that are more than 1 cm off; the last beam's moment is the reading's."""
    assert reading.odom_from_base == pytest.approx(pose_at(reading.t))
    hit = reading.returned
    points = reading.beams.directions[hit] * reading.ranges[hit, None] + np.array(reading.beams.origin)
    place = np.array(compose(pose_at(reading.t), BASE_FROM_LIDAR)[:2])
    ways = transform(pose_at(reading.t), points) - place
    lengths = np.hypot(*ways.T)
    true = cast(place, np.arctan2(ways[:, 1], ways[:, 0]), BOXES, CIRCLES)
    return np.mean(np.abs(true - lengths) > 0.01)


@pytest.mark.parametrize("lidar", [SLOW, RIGHT_ABOUT], ids=["left about", "right about"])
def test_a_sweep_is_set_straight_by_the_frames_at_its_beams_moments(lidar):
    mapping, method = service(lidar)
    out = stepped(mapping, END + 0.1, scan=scan_of(lidar), frames=frames_until(END))
    (reading,) = method.fed
    assert reading.t == pytest.approx(END) and seconds(out["fix"].timestamp) == pytest.approx(END)
    assert off_the_surfaces(reading) < 0.05  # edges, which hide something else from there

    plain, kept = service(msgspec.structs.replace(lidar, sweep_time=0.0))
    stepped(plain, END + 0.1, scan=scan_of(lidar), frames=frames_until(END))
    assert off_the_surfaces(kept.fed[0]) > 0.3


def test_a_sweep_waits_for_the_frames_of_its_last_beam():
    mapping, method = service(SLOW)
    scan = scan_of(SLOW)
    assert stepped(mapping, END, scan=scan, frames=frames_until(END - 0.02)) == {}
    assert method.fed == []
    assert "map" in stepped(mapping, END + 0.1, scan=scan, frames=frames_until(END + 0.02))
    stepped(mapping, END + 0.2, scan=scan, frames=frames_until(END + 0.1))
    assert len(method.fed) == 1


def test_a_sweep_that_began_before_the_first_frames_is_left_out_and_the_next_one_counts():
    mapping, method = service(SLOW)
    frames = frames_with({t: pose_at(t) for t in (0.5, 0.56, END, 0.7, 0.8)})
    assert stepped(mapping, END + 0.1, scan=scan_of(SLOW), frames=frames) == {}
    standing = measured(pose_at(END), base_from_lidar=BASE_FROM_LIDAR).tolist()
    following = LaserScan(timestamp=stamp(END), frame_id="v/lidar", start_angle=ANGLES[0], end_angle=ANGLES[-1], ranges=standing)
    assert "map" in stepped(mapping, END + 0.3, scan=following, frames=frames)
    assert [r.t for r in method.fed] == pytest.approx([END + SWEEP])


def test_de_skewing_makes_the_map_and_the_pose_better():
    """Figures of docs/explanation/slam.md are of a longer run."""
    found = {way.removeprefix("fast, "): figures for way, figures in errors("fast", duration=10.0).items()}
    straight, live = found["de-skewed"], found["live"]
    for name in ("at the middle", "at the stamp"):
        skewed = found[name]
        assert straight["points off m"] < 0.3 * skewed["points off m"]
        assert straight["map off m"] < 0.3 * skewed["map off m"]
        for figures in (straight, live):
            assert figures["RMSE m"] < 0.3 * skewed["RMSE m"]
            assert figures["RMSE deg"] < 0.3 * skewed["RMSE deg"]
    assert straight["points off m"] < 0.01  # 1 sigma of the lidar's noise
