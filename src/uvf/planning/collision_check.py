"""Looks ahead along the arc of a velocity: how near does the vehicle come to what the lidar sees?"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]

STEP = 0.04  # s between the places looked at


@compiled
def clearance_along(points: Floats, linear: float, angular: float, horizon: float) -> tuple[float, float]:
    """Smallest distance [m] from the vehicle's centre to the points: (now, while it drives an arc for ``horizon`` [s]).

    points: (n, 2) [m], base frame; linear: [m/s]; angular: [rad/s]. Without points both are inf.
    """
    now = least = np.inf
    for i in range(points.shape[0]):
        now = min(now, points[i, 0] ** 2 + points[i, 1] ** 2)
    least = now
    n = int(np.ceil(horizon / STEP))
    for k in range(1, n + 1):
        turn = angular * k * STEP
        chord = linear * k * STEP
        if abs(turn) > 1e-9:
            chord *= np.sin(turn / 2.0) / (turn / 2.0)
        x, y = chord * np.cos(turn / 2.0), chord * np.sin(turn / 2.0)
        for i in range(points.shape[0]):
            least = min(least, (points[i, 0] - x) ** 2 + (points[i, 1] - y) ** 2)
    return np.sqrt(now), np.sqrt(least)


SHARES = (1.0, 0.7, 0.45, 0.25, 0.12)
"""Parts of the wanted speed that are tried, fastest first."""


def safe_share(points: Floats, velocity: tuple[float, float], keep: float, brake: tuple[float, float]) -> float:
    """The largest fraction [-] of ``velocity`` ([m/s], [rad/s]) at which the vehicle can still stop ``keep`` [m] from all points.

    points: (n, 2) [m], base frame; keep: from the vehicle's centre; brake: (reaction [s], deceleration [m/s^2]). A vehicle that is
    already nearer may move as long as it does not come nearer still. 0 when nothing is safe.
    """
    linear, angular = velocity
    for share in SHARES:
        speed = share * linear
        horizon = brake[0] + abs(speed) / brake[1]
        now, least = clearance_along(points, speed, share * angular, horizon)
        if least >= min(keep, now - 1e-3):
            return share
    return 0.0
