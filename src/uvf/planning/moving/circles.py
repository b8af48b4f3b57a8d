"""Circles through what a scan sees of round things: their middles are known well even where only a part of them is in view.

Least squares of the distances from the circle by Gauss and Newton (Gander, Golub, Strebel 1994).
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Circle = tuple[float, float, float]
"""x, y, radius [m]."""
Fit = tuple[float, float, float, float, float, int]
"""x, y, radius [m]; root mean square of the points' distances from it [m]; 1 sigma of its middle [m]; number of points."""

ROUNDS = 6
EXACT = 0.003  # m, 1 sigma that points have at the least
FIRST, SECOND, THIRD = 0.2, 0.08, 0.04
"""m from the circle within which points are taken for its own, the closer the better it is known."""
NO_FIT = (0.0, 0.0, 0.0, np.inf, np.inf, 0)


@compiled
def fit_circle(points: Floats, chosen: Mask, guess: Circle, free: bool) -> Fit:
    """The circle through the chosen (n,) of the points (n, 2) [m], begun from a guess, of its radius or, if free, of any.

    ``NO_FIT`` where the points do not determine one.
    """
    x, y, radius = guess
    least = 4 if free else 3
    for k in range(ROUNDS + 1):
        n, squares = 0, 0.0
        xx = xy = yy = xr = yr = bx = by = br = 0.0
        for i in range(points.shape[0]):
            if not chosen[i]:
                continue
            dx, dy = points[i, 0] - x, points[i, 1] - y
            away = max(np.sqrt(dx * dx + dy * dy), 1e-9)
            u, v, off = dx / away, dy / away, away - radius
            n, squares = n + 1, squares + off * off
            xx, xy, yy, xr, yr = xx + u * u, xy + u * v, yy + v * v, xr + u, yr + v
            bx, by, br = bx + u * off, by + v * off, br + off
        if n < least:
            return NO_FIT
        if free:  # the radius' row is eliminated: its normal equation is n dr = br - xr dx - yr dy
            xx, xy, yy = xx - xr * xr / n, xy - xr * yr / n, yy - yr * yr / n
            bx, by = bx - xr * br / n, by - yr * br / n
        determinant = xx * yy - xy * xy
        if not determinant > 1e-9 * n * n:
            return NO_FIT
        if k == ROUNDS:
            break
        step_x, step_y = (yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant
        x, y = x + step_x, y + step_y
        if free:
            radius += (br - xr * step_x - yr * step_y) / n
            if not 0.0 < radius < 1e3:
                return NO_FIT
    sigma = max(np.sqrt(squares / (n - least + 1)), EXACT)
    return x, y, radius, np.sqrt(squares / n), sigma * np.sqrt((xx + yy) / determinant), n


@compiled
def find_circle(points: Floats, ranges: Floats, eye: tuple[float, float], guess: Circle, chosen: Mask) -> Fit:
    """The circle of the guess's radius through the points (n, 2) [m] near it on the side of the eye; ``chosen`` (n,) becomes its points.

    Nothing need part it from what it touches or covers in part. ranges: (n,) [m], 0 = none.
    """
    x, y, radius = guess
    fit = NO_FIT
    for reach in (FIRST, SECOND, THIRD):
        for i in range(points.shape[0]):
            dx, dy = points[i, 0] - x, points[i, 1] - y
            off = np.sqrt(dx * dx + dy * dy) - radius
            faces = dx * (eye[0] - x) + dy * (eye[1] - y) > 0.0
            chosen[i] = ranges[i] > 0.0 and faces and abs(off) < reach
        fit = fit_circle(points, chosen, (x, y, radius), False)
        if fit[5] == 0:
            return NO_FIT
        x, y = fit[0], fit[1]
    return fit
