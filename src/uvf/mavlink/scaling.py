"""Floats into the integers of MAVLink fields: rounded, kept inside the field, and something said for "unknown"."""

import math

import numpy as np

from uvf.maths.geodesy import Floats

I16 = (-(2**15), 2**15 - 1)
U16 = (0, 2**16 - 1)
I32 = (-(2**31), 2**31 - 1)


def whole(value: float, limits: tuple[int, int], unknown: int = 0) -> int:
    """The integer nearest to ``value`` (in the field's own unit, e.g. [cm/s]) within ``limits``; ``unknown`` for inf and nan."""
    return round(min(max(value, limits[0]), limits[1])) if math.isfinite(value) else unknown


def heading_degrees(yaw: float) -> float:
    """Compass heading [deg], from 0 to below 360, of a yaw [rad] about the up axis, counter-clockwise from east; nan for inf and nan."""
    return float((90.0 - math.degrees(yaw)) % 360.0) if math.isfinite(yaw) else math.nan


def compass(enu: Floats) -> float:
    """Compass bearing [deg], from 0 to below 360, of the horizontal part of a vector (2,) or (3,), ENU."""
    return heading_degrees(float(np.arctan2(enu[1], enu[0])))
