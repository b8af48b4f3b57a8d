"""Particles that stand for the same place: the hypotheses of a filter."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.planar import Pose2
from uvf.maths.planar_arrays import wrapped
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

RADIUS, TURN = 0.6, 0.5  # m, rad from the heaviest particle of a group to its others
LEAST_WEIGHT = 1e-4  # of a group that is followed


@dataclass(frozen=True)
class Group:
    """members: indices of its particles; weight: their sum; mean (x, y, yaw) and covariance (3, 3) [m, rad]."""

    members: NDArray[np.int64]
    weight: float
    mean: Pose2
    covariance: Floats


def groups_of(poses: Floats, weights: Floats, most: int) -> tuple[list[Group], NDArray[np.int64]]:
    """(at most so many groups, the heaviest first; indices of the particles in none of them): leader clustering."""
    left = np.arange(len(poses))
    found: list[Group] = []
    while len(found) < most and len(left):
        leader = poses[left[np.argmax(weights[left])]]
        near = np.hypot(*(poses[left, :2] - leader[:2]).T) < RADIUS
        near &= np.abs(wrapped(poses[left, 2] - leader[2])) < TURN
        group = _group(poses, weights, left[near], leader[2])
        if group.weight >= LEAST_WEIGHT or not found:
            found.append(group)
        left = left[~near]
    return sorted(found, key=lambda g: -g.weight), left


def _group(poses: Floats, weights: Floats, members: NDArray[np.int64], yaw: float) -> Group:
    own = weights[members]
    total = float(own.sum())
    share = own / total if total > 0.0 else np.full(len(own), 1.0 / len(own))
    away = np.column_stack((poses[members, :2], wrapped(poses[members, 2] - yaw)))
    mean = share @ away
    off = away - mean
    return Group(members, total, Pose2(float(mean[0]), float(mean[1]), wrap(float(yaw + mean[2]))), (share[:, None] * off).T @ off)


def near(p: Pose2, q: Pose2, distance: float = RADIUS, turn: float = TURN) -> bool:
    """Whether two poses are the same place."""
    return bool(np.hypot(p.x - q.x, p.y - q.y) < distance and abs(wrap(p.yaw - q.yaw)) < turn)
