"""A room of plain shapes and what a lidar in it measures."""

import numpy as np

from tests.planar_rays import cast, rectangles
from uvf.maths.se2 import compose, transform

WALLS = ((0.0, -2.0, 3.0, 0.05, 0.0), (0.0, 2.0, 3.0, 0.05, 0.0), (-3.0, 0.0, 0.05, 2.0, 0.0), (3.0, 0.0, 0.05, 2.0, 0.0))
FURNITURE = ((1.5, 1.2, 0.4, 0.3, 0.4), (-1.8, -1.0, 0.5, 0.25, 0.0))
BOXES = rectangles(np.array(WALLS + FURNITURE))
CIRCLES = np.array(((0.6, -1.1, 0.2),))
ANGLES = np.radians(np.arange(360.0))
RANGE_MAX = 3.5


def measured(world_from_base, rng=None, base_from_lidar=(0.0, 0.0, 0.0), boxes=BOXES, circles=CIRCLES):
    """(360,) m as the lidar sends them: 0 = no return."""
    x, y, heading = compose(world_from_base, base_from_lidar)
    ranges = cast(np.array((x, y)), heading + ANGLES, boxes, circles)
    if rng is not None:
        ranges = ranges + rng.normal(0.0, 0.01, ranges.shape)
    return np.where(ranges <= RANGE_MAX, ranges, 0.0)


def points(ranges, base_from_lidar=(0.0, 0.0, 0.0)):
    """(n, 2) m, base frame: where the beams that came back ended."""
    hit = ranges > 0
    rays = np.column_stack((np.cos(ANGLES[hit]), np.sin(ANGLES[hit])))
    return transform(base_from_lidar, rays * ranges[hit, None])
