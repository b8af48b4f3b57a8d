"""Rigid motion in the plane for many poses at once: arrays (..., 3) of x [m], y [m], yaw [rad]; names cancel as in se2."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def wrapped(angles: Floats) -> Floats:
    """Angles [rad] of any shape (...,) wrapped into (-pi, pi]."""
    within: Floats = -((np.pi - angles) % (2 * np.pi) - np.pi)
    return within


def composed(a_from_b: Floats, b_from_c: Floats) -> Floats:
    """Poses ``a_from_c`` of ``a_from_b`` and ``b_from_c``; the shapes (..., 3) broadcast."""
    c, s = np.cos(a_from_b[..., 2]), np.sin(a_from_b[..., 2])
    x = a_from_b[..., 0] + c * b_from_c[..., 0] - s * b_from_c[..., 1]
    y = a_from_b[..., 1] + s * b_from_c[..., 0] + c * b_from_c[..., 1]
    return np.stack((x, y, wrapped(a_from_b[..., 2] + b_from_c[..., 2])), axis=-1)


def inverted(a_from_b: Floats) -> Floats:
    """Poses ``b_from_a`` (..., 3) of poses ``a_from_b`` (..., 3)."""
    c, s = np.cos(a_from_b[..., 2]), np.sin(a_from_b[..., 2])
    x, y = a_from_b[..., 0], a_from_b[..., 1]
    return np.stack((-c * x - s * y, s * x - c * y, wrapped(-a_from_b[..., 2])), axis=-1)


def steps(world_from_base: Floats) -> Floats:
    """Motions (n - 1, 3) [m, m, rad] along a trajectory (n, 3): each pose as seen from the one before it."""
    return composed(inverted(world_from_base[:-1]), world_from_base[1:])


def interpolated(track: Floats, times: Floats) -> Floats:
    """Poses (m, 3) at ``times`` (m,) [s] between those of a track (n, 4) of rows t [s], x, y [m], yaw [rad].

    The track's yaws must not be wrapped; before its first time the first pose counts, after its last the last.
    """
    return np.column_stack([np.interp(times, track[:, 0], column) for column in track[:, 1:].T])
