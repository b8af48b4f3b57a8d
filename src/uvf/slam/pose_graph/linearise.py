"""Residuals of the edges and the normal equations of Gauss-Newton on SE(2), as compiled kernels.

The residual of an edge is (x, y, yaw) of ``inverse(map_from_i) o map_from_j`` less what was measured, the heading wrapped
(Grisetti et al., "A Tutorial on Graph-Based SLAM", 2010). Increments are added to x, y [m, map frame] and yaw.

With d = t_j - t_i and R_i the rotation of pose i the Jacobians are B = diag(R_i^T, 1) for pose j and A = -B T for pose i,
T = [[1, 0, -d_y], [0, 1, d_x], [0, 0, 1]]. So with M = B^T W B, the information W turned into the map frame, the blocks of
the normal matrix are M at (j, j), -T^T M at (i, j) and T^T M T at (i, i).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


class Normal(NamedTuple):
    """Normal equations of half the weighted chi square.

    diagonal: (n, 3, 3), lower triangles; between: (pairs, 3, 3); gradient: (n, 3).
    """

    diagonal: Floats
    between: Floats
    gradient: Floats


@compiled
def residual(poses: Floats, i: int, j: int, measured: Floats) -> tuple[float, float, float]:
    """Residual (x, y, yaw) [m, m, rad] of the edge from pose i to j of ``poses`` (n, 3) with the measurement (3,)."""
    c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
    dx, dy = poses[j, 0] - poses[i, 0], poses[j, 1] - poses[i, 1]
    turn = poses[j, 2] - poses[i, 2] - measured[2]
    turn -= 2.0 * np.pi * np.round(turn / (2.0 * np.pi))
    return c * dx + s * dy - measured[0], c * dy - s * dx - measured[1], turn


@compiled
def chi_squares(poses: Floats, ends: Ints, measured: Floats, information: Floats) -> Floats:
    """Squared Mahalanobis length (m,) of the residual of each edge: ends (m, 2), measured (m, 3), information (m, 3, 3); poses (n, 3)."""
    out = np.empty(ends.shape[0])
    for k in range(ends.shape[0]):
        x, y, a = residual(poses, ends[k, 0], ends[k, 1], measured[k])
        w = information[k]
        out[k] = w[0, 0] * x * x + w[1, 1] * y * y + w[2, 2] * a * a + 2.0 * (w[0, 1] * x * y + w[0, 2] * x * a + w[1, 2] * y * a)
    return out


@compiled
def _in_map(information: Floats, weight: float, heading: float) -> tuple[float, float, float, float, float, float]:
    """xx, xy, yy, xa, ya, aa of an edge's weighted information along the axes of the map."""
    w, c, s = information, np.cos(heading), np.sin(heading)
    xx = c * c * w[0, 0] - 2.0 * c * s * w[0, 1] + s * s * w[1, 1]
    yy = s * s * w[0, 0] + 2.0 * c * s * w[0, 1] + c * c * w[1, 1]
    xy = c * s * (w[0, 0] - w[1, 1]) + (c * c - s * s) * w[0, 1]
    xa, ya = c * w[0, 2] - s * w[1, 2], s * w[0, 2] + c * w[1, 2]
    return weight * xx, weight * xy, weight * yy, weight * xa, weight * ya, weight * w[2, 2]


@compiled
def _add(h: Floats, xx: float, xy: float, yy: float, xa: float, ya: float, aa: float) -> None:
    h[0, 0] += xx
    h[1, 0] += xy
    h[1, 1] += yy
    h[2, 0] += xa
    h[2, 1] += ya
    h[2, 2] += aa


@compiled
def normal_equations(
    poses: Floats, ends: Ints, measured: Floats, information: Floats, weights: Floats, slots: tuple[Ints, Bools], out: Normal
) -> float:
    """Fills ``out``; returns half the weighted chi square [-].

    poses: (n, 3) [m, m, rad]; ends, measured, information as of ``chi_squares``; weights: (m,).
    slots: (m,) pair of each edge in ``out.between``, -1 for none, and whether its block is kept as (j, i) instead of (i, j).
    """
    out.diagonal[:] = 0.0
    out.between[:] = 0.0
    out.gradient[:] = 0.0
    cost = 0.0
    for k in range(ends.shape[0]):
        i, j = ends[k, 0], ends[k, 1]
        rx, ry, ra = residual(poses, i, j, measured[k])
        c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
        x, y = c * rx - s * ry, s * rx + c * ry
        dx, dy = poses[j, 0] - poses[i, 0], poses[j, 1] - poses[i, 1]
        xx, xy, yy, xa, ya, aa = _in_map(information[k], weights[k], poses[i, 2])
        gx, gy, ga = xx * x + xy * y + xa * ra, xy * x + yy * y + ya * ra, xa * x + ya * y + aa * ra
        cost += 0.5 * (gx * x + gy * y + ga * ra)
        g = out.gradient
        g[j, 0] += gx
        g[j, 1] += gy
        g[j, 2] += ga
        g[i, 0] -= gx
        g[i, 1] -= gy
        g[i, 2] -= ga - dy * gx + dx * gy
        ax, ay, at = xa - dy * xx + dx * xy, ya - dy * xy + dx * yy, aa - dy * xa + dx * ya
        _add(out.diagonal[j], xx, xy, yy, xa, ya, aa)
        _add(out.diagonal[i], xx, xy, yy, ax, ay, at - dy * ax + dx * ay)
        if slots[0][k] >= 0:
            h = out.between[slots[0][k]]
            _subtract(h.T if slots[1][k] else h, (xx, xy, yy, xa, ya), (ax, ay, at))
    return cost


@compiled
def _subtract(h: Floats, upper: tuple[float, float, float, float, float], last: tuple[float, float, float]) -> None:
    """T^T M from the block (i, j): its first two rows are those of M."""
    xx, xy, yy, xa, ya = upper
    h[0, 0] -= xx
    h[0, 1] -= xy
    h[0, 2] -= xa
    h[1, 0] -= xy
    h[1, 1] -= yy
    h[1, 2] -= ya
    h[2, 0] -= last[0]
    h[2, 1] -= last[1]
    h[2, 2] -= last[2]
