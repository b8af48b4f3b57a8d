"""A body on the floor and things about it, for the sensors that cast rays."""

import numpy as np

from services.sim_ground.body import BodyState
from uvf.maths.bvh import build
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.raycast import MovingBody, Scene
from uvf.maths.rotations import from_euler
from uvf.maths.solids import box, cylinder, joined


def body_at(x=0.0, y=0.0, yaw=0.0, roll=0.0, pitch=0.0):
    still = np.zeros(3)
    return BodyState(np.array((x, y, 0.0)), from_euler(roll, pitch, yaw), still, still, (0.0, 0.0), WheelSpeeds(0.0, 0.0))


def scene_of(*boxes):
    """boxes: ((x, y, z) of the middle, (x, y, z) sizes); the floor is z = 0."""
    return Scene(build(joined([box(size, centre) for centre, size in boxes])), 0.0)


WALL_AHEAD = scene_of(((2.5, 0.0, 1.0), (1.0, 20.0, 2.0)))


def post(x, y, radius):
    return MovingBody(build(cylinder(radius, 2.0, (0.0, 0.0, 0.0))), np.array((x, y, 1.0)))
