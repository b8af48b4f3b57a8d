"""Gaussians of poses (x, y, yaw), in machine code: for matrices this small, a call of numpy costs more than what it computes."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]


@compiled
def inverse(m: Floats) -> Floats:
    """Inverse (3, 3) of a symmetric, positive definite matrix (3, 3), by its Cholesky factor."""
    f = factor(m)
    a, b, c = 1.0 / f[0, 0], 1.0 / f[1, 1], 1.0 / f[2, 2]
    ba = -f[1, 0] * a * b
    cb = -f[2, 1] * b * c
    ca = -(f[2, 0] * a + f[2, 1] * ba) * c
    out = np.empty((3, 3))
    out[0, 0], out[1, 1], out[2, 2] = a * a + ba * ba + ca * ca, b * b + cb * cb, c * c
    out[0, 1] = out[1, 0] = ba * b + ca * cb
    out[0, 2] = out[2, 0] = ca * c
    out[1, 2] = out[2, 1] = cb * c
    return out


@compiled
def factor(m: Floats) -> Floats:
    """Lower triangle F (3, 3) of a symmetric, positive definite matrix m (3, 3) with F F^T = m."""
    f = np.zeros((3, 3))
    f[0, 0] = np.sqrt(m[0, 0])
    f[1, 0], f[2, 0] = m[1, 0] / f[0, 0], m[2, 0] / f[0, 0]
    f[1, 1] = np.sqrt(m[1, 1] - f[1, 0] ** 2)
    f[2, 1] = (m[2, 1] - f[2, 0] * f[1, 0]) / f[1, 1]
    f[2, 2] = np.sqrt(m[2, 2] - f[2, 0] ** 2 - f[2, 1] ** 2)
    return f


@compiled
def drawn(mean: Floats, covariance: Floats, normals: Floats) -> Floats:
    """Samples (n, 3) of a Gaussian with mean (3,) and covariance (3, 3), from standard normal numbers (n, 3)."""
    f = factor(covariance)
    out = np.empty_like(normals)
    for k in range(normals.shape[0]):
        z = normals[k]
        out[k, 0] = mean[0] + f[0, 0] * z[0]
        out[k, 1] = mean[1] + f[1, 0] * z[0] + f[1, 1] * z[1]
        out[k, 2] = mean[2] + f[2, 0] * z[0] + f[2, 1] * z[1] + f[2, 2] * z[2]
    return out


@compiled
def log_density(poses: Floats, mean: Floats, covariance: Floats) -> Floats:
    """Log density (n,) of a Gaussian with mean (3,) and covariance (3, 3) at poses (n, 3), but for a constant that all Gaussians share."""
    f = factor(covariance)
    size = np.log(f[0, 0]) + np.log(f[1, 1]) + np.log(f[2, 2])
    out = np.empty(poses.shape[0])
    for k in range(poses.shape[0]):
        turn = (poses[k, 2] - mean[2] + np.pi) % (2.0 * np.pi) - np.pi
        a = (poses[k, 0] - mean[0]) / f[0, 0]
        b = (poses[k, 1] - mean[1] - f[1, 0] * a) / f[1, 1]
        c = (turn - f[2, 0] * a - f[2, 1] * b) / f[2, 2]
        out[k] = -0.5 * (a * a + b * b + c * c) - size
    return out
