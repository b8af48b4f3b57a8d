"""How well one pose of a graph is known as seen from another."""

import numpy as np
from numpy.typing import NDArray

from uvf.slam.pose_graph.edges import EdgeRows
from uvf.slam.pose_graph.linear import REST, LinearSystem

Floats = NDArray[np.float64]


def jacobians(poses: Floats, i: int) -> tuple[Floats, Floats]:
    """Jacobians (n, 3, 3) of (x, y, yaw) of i_from_j for every pose j of ``poses`` (n, 3): by pose i, and by pose j, in the map frame."""
    c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
    by_j = np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0)))
    lever = np.tile(np.eye(3), (len(poses), 1, 1))
    lever[:, 0, 2], lever[:, 1, 2] = poses[i, 1] - poses[:, 1], poses[:, 0] - poses[i, 0]
    return -by_j @ lever, np.broadcast_to(by_j, lever.shape)


class Marginals:
    """Covariances of the poses of a linearised system, valid for as long as that is left alone."""

    def __init__(self, system: LinearSystem, poses: Floats) -> None:
        system.step()
        self._system, self._poses = system, poses
        self._own: Floats | None = None

    def relative(self, i: int, j: int) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) of i_from_j [m, rad]."""
        if i == j:
            return np.zeros((3, 3))
        both = np.array((i, j))
        right = np.zeros((6, len(self._poses), 3))
        right[:3, i] = right[3:, j] = np.eye(3)
        joint = self._system.solve(right)[:, both].reshape(6, 6)
        by = np.hstack([jacobian[1] for jacobian in jacobians(self._poses[both], 0)])
        covariance: Floats = by @ joint @ by.T
        return (covariance + covariance.T) / 2.0

    def all_from(self, i: int) -> Floats:
        """Covariances (n, 3, 3) of (x, y, yaw) of i_from_j for every pose j [m, rad]."""
        if self._own is None:
            self._own = self._system.inverse_diagonal()
        right = np.zeros((3, len(self._poses), 3))
        right[:, i] = np.eye(3)
        with_i = self._system.solve(right).transpose(1, 2, 0)
        by_i, by_j = jacobians(self._poses, i)
        across = by_j @ with_i @ by_i.transpose(0, 2, 1)
        out: Floats = by_i @ with_i[i] @ by_i.transpose(0, 2, 1) + across + across.transpose(0, 2, 1)
        out += by_j @ self._own @ by_j.transpose(0, 2, 1)
        out[i] = 0.0
        return out


def along_chain(rows: EdgeRows, poses: Floats, i: int, j: int) -> Floats:
    """Covariance (3, 3) of (x, y, yaw) of i_from_j [m, rad] by the trusted edges between successive poses (n, 3) alone."""
    first, last = min(i, j), max(i, j)
    trusted = rows.enabled & ~rows.robust & (rows.ends[:, 1] - rows.ends[:, 0] == 1)
    of = np.full(len(poses), -1)
    which = np.flatnonzero(trusted)[::-1]
    of[rows.ends[which, 0]] = which
    links = of[first:last]
    if (links < 0).any():
        gap = first + int(np.argmin(links))
        raise ValueError(f"no trusted edge from pose {gap} to {gap + 1}")
    covariances = np.linalg.inv(rows.information[links] + REST * np.eye(3))
    spread = np.tile(np.eye(3), (len(links), 1, 1))
    turn = poses[first:last, 2] - poses[i, 2]
    spread[:, 0, 0] = spread[:, 1, 1] = np.cos(turn)
    spread[:, 1, 0] = np.sin(turn)
    spread[:, 0, 1] = -spread[:, 1, 0]
    c, s = np.cos(poses[i, 2]), np.sin(poses[i, 2])
    lever = (poses[j, :2] - poses[first + 1 : last + 1, :2]) @ np.array(((c, -s), (s, c)))
    spread[:, 0, 2], spread[:, 1, 2] = -lever[:, 1], lever[:, 0]
    total: Floats = np.einsum("kab,kbc,kdc->ad", spread, covariances, spread)
    return total
