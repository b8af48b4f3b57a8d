"""Rigid motion in the plane for many poses at once: arrays (..., 3) of x [m], y [m], yaw [rad]; names cancel as in planar."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def wrapped(angles: Floats) -> Floats:
    """The same angles in (-pi, pi]."""
    within: Floats = -((np.pi - angles) % (2 * np.pi) - np.pi)
    return within


def composed(a_from_b: Floats, b_from_c: Floats) -> Floats:
    """``a_from_c``; the shapes (..., 3) broadcast."""
    c, s = np.cos(a_from_b[..., 2]), np.sin(a_from_b[..., 2])
    x = a_from_b[..., 0] + c * b_from_c[..., 0] - s * b_from_c[..., 1]
    y = a_from_b[..., 1] + s * b_from_c[..., 0] + c * b_from_c[..., 1]
    return np.stack((x, y, wrapped(a_from_b[..., 2] + b_from_c[..., 2])), axis=-1)


def inverted(a_from_b: Floats) -> Floats:
    """``b_from_a``."""
    c, s = np.cos(a_from_b[..., 2]), np.sin(a_from_b[..., 2])
    x, y = a_from_b[..., 0], a_from_b[..., 1]
    return np.stack((-c * x - s * y, s * x - c * y, wrapped(-a_from_b[..., 2])), axis=-1)


def steps(world_from_base: Floats) -> Floats:
    """(n - 1, 3): each pose (n, 3) seen from the one before it."""
    return composed(inverted(world_from_base[:-1]), world_from_base[1:])


def interpolated(track: Floats, times: Floats) -> Floats:
    """(m, 3) poses at ``times`` (m,), between those of a track (n, 4) of rows t, x, y, yaw, whose yaws lie near each other;
    outside of it the first one or the last.
    """
    return np.column_stack([np.interp(times, track[:, 0], column) for column in track[:, 1:].T])
