"""A small log of made-up readings along a curved way, with relations between its neighbours and its ends."""

import numpy as np

from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.evaluation.relations import Relations
from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.reading import Beams, Reading

PERIOD = 0.2
BEAMS = Beams((0.1, 0.05), np.radians(np.arange(-90.0, 90.0, 10.0)), 0.1, 30.0)


def way(n):
    """(n, 3): an S of arcs, from zero."""
    step = np.column_stack((np.full(n - 1, 0.1), np.zeros(n - 1), 0.08 * np.sin(np.arange(n - 1) / 15.0)))
    poses = [np.zeros(3)]
    for s in step:
        poses.append(composed(poses[-1], s))
    return np.array(poses)


def made_log(n=300, odometry=None):
    """odometry: (n, 3), by default the way itself."""
    poses = way(n) if odometry is None else odometry
    stamps = 1000.0 + PERIOD * np.arange(n)
    readings = [
        Reading(t, np.full(len(BEAMS.bearings), 2.0), BEAMS, Pose2(*p)) for t, p in zip(stamps.tolist(), poses.tolist(), strict=True)
    ]
    return LaserLog("made", readings, stamps, OdometryTrack(stamps - 0.05, poses))


def made_relations(n=300, apart=1):
    """Between every pose of the way and the one ``apart`` readings later."""
    poses, stamps = way(n), 1000.0 + PERIOD * np.arange(n)
    pairs = np.column_stack((stamps[:-apart], stamps[apart:]))
    return Relations(pairs, composed(inverted(poses[:-apart]), poses[apart:]))
