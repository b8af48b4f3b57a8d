"""Particles that stand for the same place: the hypotheses of a filter."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]

RADIUS, TURN = 0.6, 0.5  # m, rad from the heaviest particle of a group to its others
LEAST_WEIGHT = 1e-4  # of a group that is followed
NONE, DROPPED = -1, -2


@dataclass(frozen=True)
class ParticleGroup:
    """Particles of one place: indices of its members (k,), sum of their weights, mean and covariance (3, 3) of (x, y, yaw) [m, rad]."""

    members: NDArray[np.int64]
    weight: float
    mean: Pose2
    covariance: Floats


def groups_of(poses: Floats, weights: Floats, most: int) -> tuple[list[ParticleGroup], NDArray[np.int64]]:
    """(at most ``most`` groups, heaviest first; indices (k,) of particles in none) of poses (n, 3), weights (n,): leader clustering."""
    labels, count = _led(poses, weights, most)
    found = [_group(poses, weights, np.flatnonzero(labels == k)) for k in range(count)]
    return sorted(found, key=lambda g: -g.weight), np.flatnonzero(labels == NONE)


@compiled
def _led(poses: Floats, weights: Floats, most: int) -> tuple[NDArray[np.int64], int]:
    """((n,) number of each particle's group, NONE or DROPPED; how many groups there are)."""
    labels = np.full(poses.shape[0], NONE)
    count, left = 0, poses.shape[0]
    while count < most and left > 0:
        leader = -1
        for i in range(poses.shape[0]):
            if labels[i] == NONE and (leader < 0 or weights[i] > weights[leader]):
                leader = i
        total = 0.0
        for i in range(poses.shape[0]):
            dx, dy = poses[i, 0] - poses[leader, 0], poses[i, 1] - poses[leader, 1]
            turn = (poses[i, 2] - poses[leader, 2] + np.pi) % (2.0 * np.pi) - np.pi
            if i == leader or (labels[i] == NONE and dx * dx + dy * dy < RADIUS * RADIUS and abs(turn) < TURN):
                labels[i] = count
                total += weights[i]
                left -= 1
        if total >= LEAST_WEIGHT or count == 0:
            count += 1
        else:
            labels[labels == count] = DROPPED
    return labels, count


def _group(poses: Floats, weights: Floats, members: NDArray[np.int64]) -> ParticleGroup:
    total, mean, covariance = _moments(poses[members], weights[members])
    return ParticleGroup(members, total, Pose2(float(mean[0]), float(mean[1]), wrap(float(mean[2]))), covariance)


@compiled
def _moments(poses: Floats, weights: Floats) -> tuple[float, Floats, Floats]:
    """(sum of the weights, mean, covariance) of poses whose headings are near each other."""
    total = weights.sum()
    shares = weights / total if total > 0.0 else np.full(weights.shape[0], 1.0 / weights.shape[0])
    off = poses - poses[0]
    off[:, 2] = (off[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    for i in range(off.shape[0]):
        mean += shares[i] * off[i]
    for i in range(off.shape[0]):
        for a in range(3):
            for b in range(3):
                covariance[a, b] += shares[i] * (off[i, a] - mean[a]) * (off[i, b] - mean[b])
    return total, poses[0] + mean, covariance


def near(p: Pose2, q: Pose2, distance: float = RADIUS, turn: float = TURN) -> bool:
    """Whether two poses are less than ``distance`` [m] and ``turn`` [rad] apart: the same place."""
    return bool(np.hypot(p.x - q.x, p.y - q.y) < distance and abs(wrap(p.yaw - q.yaw)) < turn)
