"""A vehicle's folder on a flat floor in the ground simulator's physics."""

from typing import NamedTuple

import numpy as np

from services.sim_ground.world import BodyPlacement, BulletWorld
from uvf.control.steered_ramp import velocity_ramp
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import to_euler
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import load_vehicle

STEP = 0.02  # s


class Driven(NamedTuple):
    """x, y [m] and the angle turned [rad], simulated and by the wheels' closed-form kinematics; the largest tilt [rad]."""

    pose: np.ndarray
    expected: np.ndarray
    tilt: float


def drive(folder, twist, duration):
    """From a stand, at the accelerations the file allows, and to a stand again."""
    ground = load_vehicle(folder.parent, folder.name).ground
    kinematics = ground.drive.kinematics
    world = BulletWorld([], {"it": BodyPlacement(ground, engine_urdf(folder / ground.urdf), (0.0, 0.0, 0.0))})
    ramp, expected, turned, last, tilt = velocity_ramp(ground), np.zeros(3), 0.0, 0.0, 0.0
    try:
        for i in range(round((duration + 2.0) / STEP)):
            command = ramp.lead(Twist(*twist) if i * STEP < duration else Twist(0.0, 0.0), STEP)
            expected = rolled(expected, command)
            world.advance({"it": kinematics.wheels(command)}, STEP, steering={"it": ramp.steering})
            state = world.state("it")
            roll, pitch, yaw = to_euler(state.world_from_body)
            turned, last, tilt = turned + (yaw - last + np.pi) % (2 * np.pi) - np.pi, yaw, max(tilt, abs(roll), abs(pitch))
        return Driven(np.array((*state.position[:2], turned)), expected, tilt)
    finally:
        world.close()


def rolled(pose, command):
    """x, y, yaw after a step along the arc about the ICC."""
    (x, y, yaw), (v, w, aside) = pose, command
    if abs(w) < 1e-9:
        c, s = np.cos(yaw) * STEP, np.sin(yaw) * STEP
        return np.array((x + v * c - aside * s, y + v * s + aside * c, yaw))
    new = yaw + w * STEP
    sines, cosines = (np.sin(new) - np.sin(yaw)) / w, (np.cos(new) - np.cos(yaw)) / w
    return np.array((x + v * sines + aside * cosines, y - v * cosines + aside * sines, new))
