"""The last word before the wheels: can the vehicle still stop before anything that its sensors see, with its whole outline?"""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint

Floats = NDArray[np.float64]
Gaps = tuple[float, float, float]

STEP = 0.04  # s between the places looked at
SHARES = (1.0, 0.7, 0.45, 0.25, 0.12)
"""Parts of the wanted speed that are tried, fastest first."""
AWAY = 2e-3  # m by which a vehicle that is too near already has to be farther away in the end


@compiled
def _least_gap(points: Floats, sides: Floats, radius: float, pose: tuple[float, float, float]) -> float:
    """Smallest distance [m] from the outline at a pose (x, y, yaw) to the points (n, 2), below 0 inside.

    At corners it is no more than the true one. Without sides the outline is a circle of ``radius`` [m].
    """
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    least = np.inf
    for i in range(points.shape[0]):
        dx, dy = points[i, 0] - pose[0], points[i, 1] - pose[1]
        if sides.shape[0] == 0:
            least = min(least, np.sqrt(dx * dx + dy * dy) - radius)
            continue
        ahead, left = cosine * dx + sine * dy, cosine * dy - sine * dx
        gap = -np.inf
        for k in range(sides.shape[0]):
            gap = max(gap, sides[k, 0] * ahead + sides[k, 1] * left - sides[k, 2])
        least = min(least, gap)
    return least


@compiled
def _gaps_along(points: Floats, sides: Floats, radius: float, velocity: tuple[float, float, float], horizon: float) -> Gaps:
    """The gap now, the smallest and the last one on the arc of ``velocity`` ([m/s], [rad/s], [m/s] left) driven for ``horizon`` [s]."""
    now = _least_gap(points, sides, radius, (0.0, 0.0, 0.0))
    least = last = now
    for k in range(1, int(np.ceil(horizon / STEP)) + 1):
        t = min(k * STEP, horizon)
        turn, chord, aside = velocity[1] * t, velocity[0] * t, velocity[2] * t
        if abs(turn) > 1e-9:
            shorter = np.sin(turn / 2.0) / (turn / 2.0)
            chord, aside = chord * shorter, aside * shorter
        cosine, sine = np.cos(turn / 2.0), np.sin(turn / 2.0)
        last = _least_gap(points, sides, radius, (chord * cosine - aside * sine, chord * sine + aside * cosine, turn))
        least = min(least, last)
    return now, least, last


def safe_share(points: Floats, velocity: Twist, footprint: RobotFootprint, margin: float, brake: tuple[float, float, float]) -> float:
    """The largest fraction [-] of ``velocity`` at which the vehicle can still stop ``margin`` [m] before all points.

    points: (n, 2) [m], base frame; brake: (reaction [s], deceleration [m/s^2], the same of the turn [rad/s^2]). The outline is swept
    along the arc, also when it turns on the spot. A vehicle that is already nearer may only move away, without coming nearer on the
    way. 0 when nothing is safe.
    """
    linear, angular, lateral = velocity
    fastest = hypot(linear, lateral)
    sides = np.zeros((0, 3)) if footprint.round else footprint.sides()
    reach = fastest * (brake[0] + fastest / brake[1]) + footprint.circumscribed_radius + margin
    near = np.ascontiguousarray(points[(np.abs(points) <= reach).all(axis=1)])
    if not len(near):
        return 1.0
    for share in SHARES:
        horizon = brake[0] + max(share * fastest / brake[1], share * abs(angular) / brake[2])
        driven = share * linear, share * angular, share * lateral
        now, least, last = _gaps_along(near, sides, footprint.inscribed_radius, driven, horizon)
        if least >= margin or (now < margin and least >= now - 1e-9 and last >= now + AWAY):
            return share
    return 0.0
