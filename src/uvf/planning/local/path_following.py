"""What followers of a path share: the carrot ahead on it, the room beside the vehicle, turning on the spot, and a look along an arc."""

from math import copysign, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.local import rollout
from uvf.planning.local.planner import Limits, LocalSituation
from uvf.planning.local.rollout import FEATURES, Others, roll_out
from uvf.planning.local.window import Grids

Floats = NDArray[np.float64]
Carrot = tuple[float, float, float]

LOOK_STEP = 0.05  # s between the poses that are looked at along an arc
PASSED = 0.15  # m from a cusp, within which it counts as passed
TURN_GAIN = 4.0  # 1/s, of the turn rate over the last bit of a turn on the spot


@compiled
def carrot(path: Floats, x: float, y: float, reach: float) -> Carrot:
    """Where the path (n, 2) [m], n >= 1, leaves the circle of ``reach`` [m] round (x, y), and its length [m] from here to its end.

    It is sought from the path's nearest place on, between its points too; a cusp that lies before comes first. Beside the path,
    farther than ``reach``, it is the nearest place itself, and beyond its last point that one. (Macenski et al. 2023, 3.1.)
    """
    n = path.shape[0]
    nearest, segment, px, py = np.inf, 0, path[0, 0], path[0, 1]
    for i in range(n - 1):
        ax, ay = path[i, 0], path[i, 1]
        dx, dy = path[i + 1, 0] - ax, path[i + 1, 1] - ay
        squared = dx * dx + dy * dy
        share = 0.0 if squared <= 0.0 else min(max(((x - ax) * dx + (y - ay) * dy) / squared, 0.0), 1.0)
        qx, qy = ax + share * dx, ay + share * dy
        apart = (qx - x) ** 2 + (qy - y) ** 2
        if apart < nearest:
            nearest, segment, px, py = apart, i, qx, qy
    left, found, cx, cy = 0.0, False, px, py
    if np.hypot(px - x, py - y) >= reach:
        found = True
    for i in range(segment, n - 1):
        ex, ey = path[i + 1, 0], path[i + 1, 1]
        left += np.hypot(ex - px, ey - py)
        if not found:
            away = np.hypot(ex - x, ey - y)
            if away >= reach:
                share = _leaves(px - x, py - y, ex - px, ey - py, reach)
                cx, cy, found = px + share * (ex - px), py + share * (ey - py), True
            else:
                cx, cy = ex, ey
                if i + 2 < n and away > PASSED:
                    found = (ex - px) * (path[i + 2, 0] - ex) + (ey - py) * (path[i + 2, 1] - ey) < 0.0
        px, py = ex, ey
    return cx, cy, left


@compiled
def _leaves(px: float, py: float, dx: float, dy: float, reach: float) -> float:
    """Share of the segment from (px, py) along (dx, dy) [m] at which it leaves the circle of ``reach`` [m] round the origin."""
    a, b, c = dx * dx + dy * dy, px * dx + py * dy, px * px + py * py - reach * reach
    return 0.0 if a <= 0.0 else min(max((-b + np.sqrt(max(b * b - a * c, 0.0))) / a, 0.0), 1.0)


@compiled
def distance_to_obstacle(grids: Grids, x: float, y: float, most: float) -> float:
    """Distance [m] from (x, y) to the centre of the nearest occupied cell of the window; ``most`` [m] where none is nearer."""
    x0, y0, resolution = grids.frame
    rows, columns = grids.values.shape
    nearest = most * most
    low_r, low_c = max(int((y - most - y0) / resolution), 0), max(int((x - most - x0) / resolution), 0)
    for r in range(low_r, min(int((y + most - y0) / resolution) + 1, rows)):
        for c in range(low_c, min(int((x + most - x0) / resolution) + 1, columns)):
            if grids.values[r, c] == LETHAL:
                dx, dy = x0 + (c + 0.5) * resolution - x, y0 + (r + 0.5) * resolution - y
                nearest = min(nearest, dx * dx + dy * dy)
    found: float = np.sqrt(nearest)
    return found


def turn_rate_over(error: float, limits: Limits) -> float:
    """Turn rate [rad/s] that takes away a heading error [rad] on the spot, no faster than can be braked within it."""
    fastest = min(limits.max_turn_rate, sqrt(2.0 * limits.angular_acceleration * abs(error)), TURN_GAIN * abs(error))
    return copysign(fastest, error)


class LookAhead:
    """Drives a steady command ahead on paper: does the footprint touch anything, standing or moving?"""

    def __init__(self, limits: Limits, footprint: RobotFootprint) -> None:
        self._limits, self._outline = limits, (footprint.sides(), footprint.circumscribed_radius)
        self._found = np.empty((1, FEATURES), dtype=np.float32)

    def collides(self, now: LocalSituation, command: Twist, seconds: float) -> bool:
        """Whether the vehicle touches something within ``seconds`` if it follows ``command`` as fast as it can.

        A vehicle that touches something from the start may get out of it.
        """
        steps = max(int(np.ceil(seconds / LOOK_STEP)), 1)
        commands = np.full((1, steps, 3), command, dtype=np.float32)
        others = Others(now.obstacles, *self._outline)
        roll_out(now.grids, now.state, commands, (LOOK_STEP, self._limits), others, self._found)
        return bool(self._found[0, rollout.COLLIDED] > 0.0)
