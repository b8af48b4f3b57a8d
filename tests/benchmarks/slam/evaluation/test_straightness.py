"""Bends and scales of maps whose walls are known because they were made by hand."""

import numpy as np
import pytest

from benchmarks.slam.evaluation.straightness import hit_points, straight_walls, straightness
from tests.slam.maps.floor_plans import plan
from uvf.maths.se2 import Pose2, compose, inverse, transform
from uvf.slam.maps.walls import WallPoints
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading

CORRIDOR = plan((), size=(62.0, 14.0), corner=(-1.0, -1.0), rooms=((0.0, 0.0, 60.0, 2.0), (0.0, 2.1, 60.0, 12.1), (20.0, 2.0, 21.0, 2.1)))
OUTLINES = np.array(
    [
        ((0.0, 0.0), (60.0, 0.0)),
        ((20.0, 2.0), (0.0, 2.0)),
        ((21.0, 2.0), (60.0, 2.0)),
        ((0.0, 2.1), (20.0, 2.1)),
        ((60.0, 2.1), (21.0, 2.1)),
        ((60.0, 12.1), (0.0, 12.1)),
        ((0.0, 0.0), (0.0, 2.0)),
    ]
)


def corridor(warp=lambda points: points):
    """What keyframes every metre along the corridor have hit of its walls, where a warped map has it."""
    rng = np.random.default_rng(5)
    angles = np.radians(np.arange(0.0, 360.0, 2.0))
    lidar = Beams((0.1, 0.0), angles, 0.1, 20.0)
    outlines = OUTLINES.reshape(-1, 4)
    keyframes = []
    for x in np.arange(1.0, 59.0, 1.0):
        pose = Pose2(x, 1.0 if x % 2 else 7.0, rng.uniform(-3.0, 3.0))
        sensor = transform(pose, np.array([lidar.origin]))[0]
        ranges = np.min([_to(sensor, pose.yaw + angles, line) for line in outlines], axis=0) + rng.normal(0.0, 0.01, len(angles))
        keyframes.append(Keyframe(pose, Reading(x, np.where(ranges < 20.0, ranges, 0.0), lidar, pose)))
    seen = hit_points([Keyframe(compose(inverse(PLACED), k.map_from_base), k.reading) for k in keyframes], PLACED)
    return WallPoints(warp(seen.points), seen.towards_free)


def _to(sensor, angles, line):
    """(n,) m along the rays to a segment, inf past it."""
    dx, dy = np.cos(angles), np.sin(angles)
    ex, ey = line[2] - line[0], line[3] - line[1]
    cross = dx * ey - dy * ex
    with np.errstate(divide="ignore", invalid="ignore"):
        t = ((line[0] - sensor[0]) * ey - (line[1] - sensor[1]) * ex) / cross
        u = ((line[0] - sensor[0]) * dy - (line[1] - sensor[1]) * dx) / cross
        return np.where((t > 0) & (u >= 0) & (u <= 1), t, np.inf)


PLACED = Pose2(4.0, -2.0, 1.0)


def test_walls_are_joined_over_doors_and_both_faces_of_a_thin_one_stay_apart():
    walls = straight_walls(OUTLINES, CORRIDOR)
    assert [round(w.length, 6) for w in walls] == [60.0] * 4
    assert sorted(round(float(w.start @ w.towards_free), 6) for w in walls) == [-12.1, -2.0, 0.0, 2.1]


def test_a_thin_wall_is_judged_from_each_side_it_was_seen_from():
    seen = corridor()
    thin = straight_walls(OUTLINES[:1])
    assert [w.towards_free.tolist() for w in thin] == [[0.0, 1.0], [0.0, -1.0]]
    found = straightness(seen, thin)
    assert found.walls == 1 and np.degrees(found.bend) < 0.03


def test_what_runs_across_a_wall_that_nobody_saw_is_not_taken_for_it():
    unseen = straight_walls(np.array([[(5.0, 6.0), (45.0, 6.0)]]))
    y = np.linspace(5.6, 6.4, 200)
    across = np.concatenate([np.column_stack((np.full(200, x), y)) for x in (6.0, 30.0, 40.0)])
    found = straightness(WallPoints(across, np.tile((0.8, 0.6), (600, 1))), unseen)
    assert found.walls == 0


def test_a_straight_map_has_no_bend_and_the_right_scale():
    found = straightness(corridor(), straight_walls(OUTLINES, CORRIDOR))
    assert found.walls == 4 and found.spans == 3
    assert np.degrees(found.bend) < 0.03
    assert abs(found.scale) < 0.0005


@pytest.mark.parametrize("degrees", [0.1, 0.3, 1.0, -0.6])
def test_a_known_bend_is_measured(degrees):
    curvature = np.radians(degrees) / 50.0

    def bent(points):
        return np.column_stack((points[:, 0], points[:, 1] + curvature / 2 * (points[:, 0] - 30.0) ** 2))

    found = straightness(corridor(bent), straight_walls(OUTLINES, CORRIDOR))
    assert np.degrees(found.bend) == pytest.approx(abs(degrees), abs=0.03)


def test_a_known_scale_is_measured():
    def stretched(points):
        return points * (1.0, 1.02)

    found = straightness(corridor(stretched), straight_walls(OUTLINES, CORRIDOR))
    assert found.scale == pytest.approx(0.02, abs=0.0005)
    assert found.worst_scale == pytest.approx(0.02, abs=0.0005)


def test_a_wall_of_ten_metres_gives_spans_but_no_bend():
    seen = corridor()
    here = (seen.points[:, 0] > 20.0) & (seen.points[:, 0] < 35.0)
    found = straightness(WallPoints(seen.points[here], seen.towards_free[here]), straight_walls(OUTLINES, CORRIDOR))
    assert (found.walls, found.spans) == (4, 3) and np.isnan(found.bend) and abs(found.scale) < 0.001


def test_without_long_walls_there_is_nothing_to_say():
    found = straightness(corridor(), straight_walls(OUTLINES[-1:], CORRIDOR))
    assert (found.walls, found.spans) == (0, 0)
    assert np.isnan([found.bend, found.scale, found.worst_scale]).all()
