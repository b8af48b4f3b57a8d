"""Lidar messages as beams of the base: any field of view, direction of turning, time of a sweep, place and attitude of the lidar."""

from math import inf, isfinite

import numpy as np

from schemas.messages import LaserScan
from uvf.maths.se3 import Transform, from_above
from uvf.sensors.sweeping import AT_ONCE, Sweeping
from uvf.slam.reading import Beams

Shape = tuple[str, float, float, int]


def is_usable(scan: LaserScan) -> bool:
    """Whether a scan has beams whose directions are numbers; what their ranges are does not matter."""
    return len(scan.ranges) > 0 and isfinite(scan.start_angle) and isfinite(scan.end_angle)


def sees_nothing(scan: LaserScan) -> bool:
    """Whether nothing came back: in open space each scan is like the last, to the last bit."""
    return not any(0.0 < r < inf for r in scan.ranges)


def shape_of(scan: LaserScan) -> Shape:
    """Key that scans of the same beams have in common."""
    return scan.frame_id, scan.start_angle, scan.end_angle, len(scan.ranges)


def beams_of(scan: LaserScan, base_from_lidar: Transform, limits: tuple[float, float], sweeping: Sweeping = AT_ONCE) -> Beams:
    """Beams of a scan in the order in which they are measured, base frame; limits: least and largest range that are a return [m].

    Seen from above, so that a lidar that hangs upside down turns clockwise.
    """
    angles = np.linspace(scan.start_angle, scan.end_angle, len(scan.ranges))
    if sweeping.clockwise:
        angles = angles[::-1]
    places = from_above(base_from_lidar, np.vstack((np.zeros((1, 2)), np.column_stack((np.cos(angles), np.sin(angles))))))
    directions = places[1:] - places[0]
    x, y = places[0].tolist()
    return Beams((x, y), np.unwrap(np.arctan2(directions[:, 1], directions[:, 0])), *limits, sweeping.duration)
