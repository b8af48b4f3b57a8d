"""Places points that a lidar sees on the map and on the Earth: a pose in the plane, then the local tangent plane."""

import math

import numpy as np

from uvf.maths.geodesy import LocalTangent
from uvf.maths.se2 import Pose2, compose, transform

map_from_base = Pose2(3.0, 1.0, math.pi / 2)  # m, m, rad
base_from_laser = Pose2(0.1, 0.0, 0.0)
points = transform(compose(map_from_base, base_from_laser), np.array([[2.0, 0.0], [0.0, 1.0]]))  # (n, 2) m
earth = LocalTangent.from_degrees(47.0, 8.0, 400.0)  # of the map's origin: deg, deg, m
for x, y in points:
    latitude, longitude, _ = earth.geodetic(np.array((x, y, 0.0)))
    print(f"({x:.1f}, {y:.1f}) m: {math.degrees(latitude):.7f}, {math.degrees(longitude):.7f} deg")
