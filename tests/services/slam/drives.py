"""Readings of a drive through the made-up room, for methods."""

from math import pi

import numpy as np

from tests.slam.room import ANGLES, RANGE_MAX, measured
from tests.slam.room_log import READINGS, stamps, true_way
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.maths.se2_arrays import composed, inverted, steps, wrapped
from uvf.slam.reading import Beams, Reading

ALL_ROUND = Beams((0.0, 0.0), ANGLES, 0.0, RANGE_MAX)
OFFSET = Pose2(0.12, -0.05, 0.7)
CLOCKWISE_OFFSET = Beams((OFFSET.x, OFFSET.y), (OFFSET.yaw + ANGLES)[::-1], 0.0, RANGE_MAX)


def truth(n=READINGS):
    """(n, 3) map_from_base: the map begins at the first pose."""
    way = true_way()[:n]
    return composed(inverted(way[0]), way)


def drive(n=READINGS, turns=1.02, odometry=True, seed=3, offset=False):
    """Readings; the odometry turns too far by a factor, or stands still where there is none. offset: the lidar turns clockwise."""
    rng, way, odom, readings = np.random.default_rng(seed), true_way()[:n], Pose2(5.0, -2.0, 1.0), []
    moves = [np.zeros(3), *steps(way)]
    for t, pose, (x, y, yaw) in zip(stamps(n).tolist(), way.tolist(), np.array(moves).tolist(), strict=True):
        odom = compose(odom, Pose2(x, y, yaw * turns)) if odometry else odom
        ranges = measured(pose, rng, OFFSET if offset else (0.0, 0.0, 0.0))
        readings.append(Reading(t, ranges[::-1] if offset else ranges, CLOCKWISE_OFFSET if offset else ALL_ROUND, odom))
    return readings


def off_by(poses, n=READINGS):
    """(m, rad): the largest errors of poses (n, 3) in the map frame."""
    away = np.asarray(poses) - truth(n)
    return float(np.hypot(away[:, 0], away[:, 1]).max()), float(np.abs(wrapped(away[:, 2])).max())


def odometry_of(readings):
    """(n, 3) as if there were nothing else."""
    return np.array([compose(inverse(readings[0].odom_from_base), r.odom_from_base) for r in readings])


def broken(n=12):
    """Readings in which nothing is as it should be, one kind after the other."""
    whole, nothing = drive(n), float("nan")
    ruined = [
        np.full(360, nothing),
        np.full(360, np.inf),
        np.zeros(360),
        np.full(360, -1.0),
        np.full(360, 1e30),
        np.zeros(0),
        np.ones(7),
    ]
    readings = whole[:3]
    readings += [Reading(r.t, ranges, r.beams, r.odom_from_base) for r, ranges in zip(whole[3:], ruined, strict=False)]
    odoms = (Pose2(nothing, 0.0, 0.0), Pose2(1e9, 0.0, 0.0), Pose2(0.0, 0.0, np.inf), Pose2(0.0, 1e300, pi))
    readings += [Reading(99.0 + k, whole[0].ranges, ALL_ROUND, odom) for k, odom in enumerate(odoms)]
    few = Beams((0.0, 0.0), np.zeros(1), 0.0, RANGE_MAX)
    return [
        *readings,
        Reading(110.0, np.ones(1), few, whole[0].odom_from_base),
        Reading(111.0, np.zeros(0), Beams((0.0, 0.0), np.zeros(0), 0.0, 1.0), IDENTITY),
    ]
