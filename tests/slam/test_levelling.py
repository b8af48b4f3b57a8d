"""Sweeps taken on a slope."""

import numpy as np
import pytest

from tests.slam.matching.walls import ROOM, seen
from tests.slam.test_deskew import BEARINGS, off_the_walls
from uvf.maths.rotations import from_euler, matrix
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.levelling import levelled
from uvf.slam.reading import Beams, Reading

HEIGHT = 0.4


def on_a_slope(tilt, beams):
    """The room's upright walls as a lidar sees them that stands askew in its middle."""
    x, y, _ = tilt @ (*beams.origin, HEIGHT)
    seen_above = beams.directions @ tilt[:2, :2].T
    bearings = np.arctan2(seen_above[:, 1], seen_above[:, 0])
    from_above = seen(ROOM, beams=Beams((x, y), bearings, 0.1, 30.0)).ranges
    return Reading(0.0, from_above / np.hypot(*seen_above.T), beams, IDENTITY)


@pytest.mark.parametrize("angles", [(0.0, -0.25), (0.2, 0.0), (-0.15, 0.2)])
@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.2, -0.1)], ids=["in the middle", "ahead"])
def test_upright_walls_seen_askew_stand_where_they_are(angles, origin):
    tilt = matrix(from_euler(*angles, 0.0))
    reading = on_a_slope(tilt, Beams(origin, BEARINGS, 0.1, 30.0))
    assert np.quantile(off_the_walls(reading, Pose2(0.0, 0.0, 0.0)), 0.9) > 0.05
    assert off_the_walls(levelled(reading, tilt, HEIGHT), Pose2(0.0, 0.0, 0.0)).max() < 1e-9


def test_what_is_no_return_stays_none():
    tilt = matrix(from_euler(0.0, 0.3, 0.0))
    beams = Beams((0.0, 0.0), np.zeros(6), 0.2, 10.0)
    reading = levelled(Reading(0.0, np.array((10.0, np.inf, 0.0, np.nan, 0.21, 9.99)), beams, IDENTITY), tilt, HEIGHT)
    assert reading.returned.tolist() == [False, False, False, False, True, True]
    assert np.isinf(reading.ranges[:3]).all() and np.isnan(reading.ranges[3])
