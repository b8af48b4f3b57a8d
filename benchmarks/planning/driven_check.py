"""Whether a vehicle can drive a path, by a check that knows no planner: the outline laid on the cells, the turns taken from the poses."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.inflation import LETHAL

Floats = NDArray[np.float64]

PARTS = 5
"""Places that are looked at on the way from one pose to the next."""


class DrivenCheck:
    """Checks paths on one costmap for its footprint."""

    def __init__(self, costs: Costmap) -> None:
        self._centres = costs.points(np.argwhere(costs.values == LETHAL))
        self._tree = cKDTree(self._centres) if len(self._centres) else None
        self._sides, self._reach = costs.footprint.sides(), costs.footprint.circumscribed_radius
        self._low = np.array(costs.origin)
        self._high = self._low + np.array(costs.values.shape[::-1]) * costs.resolution

    def holds(self, path: Floats, radius: float) -> bool:
        """Whether the outline covers no centre of an occupied cell on the way, the centre stays on the map and no turn is tighter.

        path: (n, 3) x, y [m], yaw [rad]; radius: [m].
        """
        step, turn = np.diff(path[:, :2], axis=0), np.remainder(np.diff(path[:, 2]) + np.pi, 2 * np.pi) - np.pi
        chord = np.hypot(step[:, 0], step[:, 1])
        if (np.abs(turn) > 2.0 * np.arcsin(np.minimum(chord / (2.0 * radius), 1.0)) * 1.001 + 1e-6).any():
            return False
        # The chord of an arc looks the way of the heading in its middle, forwards or backwards.
        aside = step[:, 1] * np.cos(path[:-1, 2] + 0.5 * turn) - step[:, 0] * np.sin(path[:-1, 2] + 0.5 * turn)
        if (np.abs(aside) > 1e-3 * np.maximum(chord, 1e-2 * radius)).any():
            return False
        poses = _between(path, step, turn)
        inside = (poses[:, :2] >= self._low).all() and (poses[:, :2] < self._high).all()
        return bool(inside) and not any(self._touches(pose) for pose in poses)

    def _touches(self, pose: Floats) -> bool:
        near = self._tree.query_ball_point(pose[:2], self._reach) if self._tree is not None else []
        if not near:
            return False
        away, (cosine, sine) = self._centres[near] - pose[:2], (np.cos(pose[2]), np.sin(pose[2]))
        in_base = np.stack((cosine * away[:, 0] + sine * away[:, 1], cosine * away[:, 1] - sine * away[:, 0]))
        return bool((self._sides[:, :2] @ in_base <= self._sides[:, 2:]).all(axis=0).any())


def _between(path: Floats, step: Floats, turn: Floats) -> Floats:
    """(m, 3) poses on the path and on the straight lines between them; what an arc bulges is a few micrometres."""
    share = (np.arange(PARTS) / PARTS)[:, None]
    poses = [path[k] + share * np.array((*step[k], turn[k])) for k in range(len(step))]
    return np.vstack((*poses, path[-1:]))
