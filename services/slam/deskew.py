"""A sweep that took its time, as it would have been seen at once."""

import numpy as np

from services.slam.reading import Beams, Reading
from uvf.maths.planar import Pose2
from uvf.maths.planar_arrays import composed


def deskewed(reading: Reading, base_from_earlier: Pose2) -> Reading:
    """The same points seen from the lidar's place at the last beam.

    base_from_earlier: where the base was at the first beam, seen from where it is at the last one; it has moved evenly between.
    """
    beams, n = reading.beams, len(reading.ranges)
    if beams.duration == 0.0 or n < 2:
        return reading
    ahead = np.linspace(1.0, 0.0, n)[:, None] * np.array(base_from_earlier)
    returned = reading.returned
    lengths = np.where(returned, reading.ranges, beams.range_max)
    seen = np.column_stack((beams.directions * lengths[:, None] + np.array(beams.origin), np.zeros(n)))
    from_lidar = composed(ahead, seen)[:, :2] - np.array(beams.origin)
    ranges = np.where(returned, np.hypot(from_lidar[:, 0], from_lidar[:, 1]), np.inf)
    bearings = np.unwrap(np.arctan2(from_lidar[:, 1], from_lidar[:, 0]))
    at_once = Beams(beams.origin, bearings, beams.range_min, beams.range_max)
    return Reading(reading.t, ranges, at_once, reading.odom_from_base)
