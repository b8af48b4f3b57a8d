"""Straight walls and what a lidar among them measures."""

import numpy as np

from benchmarks.slam.evaluation.building import cast
from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.slam.reading import Beams, Reading

ROOM = np.array(
    (
        (-3.0, -2.0, 4.0, -2.0),
        (4.0, -2.0, 4.0, 3.0),
        (4.0, 3.0, 1.0, 3.0),
        (1.0, 3.0, 1.0, 2.2),
        (1.0, 2.2, -3.0, 2.2),
        (-3.0, 2.2, -3.0, -2.0),
        (2.5, -2.0, 2.5, -1.2),
    )
)
CORRIDOR = np.array(((-40.0, 1.2, 40.0, 1.2), (-40.0, -1.2, 40.0, -1.2)))
ALL_ROUND = Beams((0.0, 0.0), np.radians(np.arange(360.0)), 0.1, 30.0)
HALF_ROUND = Beams((0.0, 0.0), np.radians(np.linspace(-90.0, 90.0, 181)), 0.1, 30.0)


def seen(walls, map_from_base=IDENTITY, beams=ALL_ROUND, rng=None):
    """A reading taken there; rng: 1 cm of noise."""
    lidar = compose(Pose2(*map_from_base), Pose2(*beams.origin, 0.0))
    ranges = cast(np.array(lidar), beams.directions, walls, 1e3)
    if rng is not None:
        ranges = ranges + 0.01 * rng.standard_normal(len(ranges))
    return Reading(0.0, ranges, beams, Pose2(*map_from_base))


def off(found, true):
    """(m, rad) between two poses."""
    turn = (found[2] - true[2] + np.pi) % (2 * np.pi) - np.pi
    return float(np.hypot(found[0] - true[0], found[1] - true[1])), abs(turn)
