"""The attitude to begin with: gravity as the accelerometers feel it, then the magnetic field, levelled."""

import math

import numpy as np

from uvf.estimation.ekf.states import Floats, NominalAttitude


def levelled(force: Floats) -> tuple[float, float]:
    """(roll, pitch) [rad] of a body without acceleration from its specific force (3,) [m/s^2], FRD."""
    fx, fy, fz = force.tolist()
    return math.atan2(-fy, -fz), math.atan2(fx, math.hypot(fy, fz))


def heading(field: Floats, earth: Floats, roll: float, pitch: float) -> float:
    """Yaw [rad, NED] at which the magnetic field (3,), FRD, lies in the vertical plane of the Earth's field (3,), NED.

    roll, pitch: [rad]; both fields in one unit, whichever it is.
    """
    x, y, z = field.tolist()
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    return math.atan2(z * sr - y * cr, x * cp + (y * sr + z * cr) * sp) + math.atan2(earth[1], earth[0])


def attitude(roll: float, pitch: float, yaw: float) -> NominalAttitude:
    """Attitude ned_from_frd from Euler angles [rad]: yaw about down, then pitch, then roll."""
    about_z = NominalAttitude(math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))
    about_y = NominalAttitude(math.cos(pitch / 2), 0.0, math.sin(pitch / 2), 0.0)
    return about_z.times(about_y).times(NominalAttitude(math.cos(roll / 2), math.sin(roll / 2), 0.0, 0.0))


def points(earth: Floats) -> bool:
    """Whether a magnetic field (3,), NED, has a horizontal part for a compass to point along."""
    return bool(np.hypot(earth[0], earth[1]) > 0.0)
