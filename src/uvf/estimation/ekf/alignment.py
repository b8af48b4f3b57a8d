"""The attitude to begin with: gravity as the accelerometers feel it, then the magnetic field, levelled."""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats, NominalAttitude


def levelled(force: Floats) -> tuple[float, float]:
    """(roll, pitch) [rad] of a body without acceleration; specific force (3,), FRD."""
    fx, fy, fz = force.tolist()
    return math.atan2(-fy, -fz), math.atan2(fx, math.hypot(fy, fz))


def heading(field: Floats, earth: Floats, roll: float, pitch: float) -> float:
    """Yaw [rad] at which the magnetic field (3,), FRD, lies in the vertical plane of the Earth's (3,), NED."""
    x, y, z = field.tolist()
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    return math.atan2(z * sr - y * cr, x * cp + (y * sr + z * cr) * sp) + math.atan2(earth[1], earth[0])


def attitude(roll: float, pitch: float, yaw: float) -> NominalAttitude:
    """Yaw about down, then pitch, then roll."""
    about_z = NominalAttitude(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
    about_y = NominalAttitude(math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0)
    return about_z.times(about_y).times(NominalAttitude(math.cos(roll / 2), math.sin(roll / 2), 0.0, 0.0))


def points(earth: Floats) -> bool:
    """Whether a field (3,) has a level part to point with."""
    return bool(np.hypot(earth[0], earth[1]) > 0.0)
