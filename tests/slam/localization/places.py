"""Made-up places, what a lidar sees there, and maps of them."""

import numpy as np

from tests.planar_rays import cast, rectangles
from tests.slam.room import ANGLES, BOXES, CIRCLES, RANGE_MAX
from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted, steps
from uvf.slam.localization import known_map
from uvf.slam.method import Keyframe
from uvf.slam.reading import Beams, Reading

ROOM = (BOXES, CIRCLES)
WALLS = ((0.0, -2.0, 3.0, 0.05, 0.0), (0.0, 2.0, 3.0, 0.05, 0.0), (-3.0, 0.0, 0.05, 2.0, 0.0), (3.0, 0.0, 0.05, 2.0, 0.0))
TWINS = ((1.5, 1.2, 0.4, 0.3, 0.4), (-1.5, -1.2, 0.4, 0.3, 0.4))
"""Looks the same from opposite ends."""
SYMMETRIC = (rectangles(np.array(WALLS + TWINS)), np.zeros((0, 3)))
LIDAR = Beams((0.0, 0.0), ANGLES, 0.05, RANGE_MAX)


def seen(place, pose, rng):
    """(360,) m; 0 = no return."""
    ranges = cast(np.array(pose[:2]), pose[2] + ANGLES, *place) + rng.normal(0.0, 0.01, len(ANGLES))
    return np.where(ranges <= RANGE_MAX, ranges, 0.0)


def ellipse(n, begin=0.0, end=1.9 * np.pi, size=(1.1, 0.6)):
    """(n, 3) poses along an ellipse about the middle."""
    angle = np.linspace(begin, end, n)
    x, y = size[0] * np.cos(angle) - 0.3, size[1] * np.sin(angle) + 0.1
    return np.column_stack((x, y, np.unwrap(np.arctan2(size[1] * np.cos(angle), -size[0] * np.sin(angle)))))


def readings(place, way, seed=1, worse=1.02, corrupted=0.0):
    """A drive; the odometry begins at zero and turns too far by the factor ``worse``. corrupted: share of beams that say anything."""
    rng = np.random.default_rng(seed)
    odometry = [np.zeros(3)]
    for step in steps(way):
        odometry.append(composed(odometry[-1], step * (1.0, 1.0, worse)))
    found = []
    for k, (pose, odom) in enumerate(zip(way, odometry, strict=True)):
        ranges = seen(place, pose, rng)
        wrong = rng.random(len(ranges)) < corrupted
        ranges[wrong] = rng.uniform(0.1, RANGE_MAX, int(wrong.sum()))
        found.append(Reading(0.2 * k, ranges, LIDAR, Pose2(*odom.tolist())))
    return found


def map_of(place):
    """Of a drive round it with true poses."""
    way = ellipse(40, size=(1.6, 0.7))
    return known_map.of_keyframes([Keyframe(Pose2(*p.tolist()), r) for p, r in zip(way, readings(place, way, seed=9), strict=True)])


def errors(poses, way):
    """(n,) m and (n,) rad between estimates and true poses."""
    off = composed(inverted(way), np.array(poses))
    return np.hypot(off[:, 0], off[:, 1]), np.abs(off[:, 2])
