"""Graphs for the tests: a drive with its true poses, noisy odometry and loops."""

import numpy as np

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph

INFORMATION = np.diag((2500.0, 2500.0, 10000.0))  # 0.02 m, 0.01 rad


def truth(n, turns=2.0):
    """(n, 3) along a circle of 10 m driven ``turns`` times, headings not wrapped."""
    s = np.linspace(0.0, 2.0 * np.pi * turns, n)
    return np.column_stack((10.0 * np.sin(s), 10.0 * (1.0 - np.cos(s)), s))


def between(poses, i, j):
    return compose(inverse(Pose2(*poses[i])), Pose2(*poses[j]))


def noisy(pose, rng, scale=1.0):
    return compose(pose, Pose2(*(scale * rng.normal(0.0, (0.02, 0.02, 0.01)))))


def driven(true, loops, rng, bend=0.0, fixed=0):
    """A graph that begins at its own odometry, bent by ``bend`` [rad] a step, with a true loop edge for each pair of ``loops``."""
    graph = PoseGraph(fixed=fixed)
    at = IDENTITY
    graph.add_pose(at)
    for k in range(1, len(true)):
        step = compose(noisy(between(true, k - 1, k), rng), Pose2(0.0, 0.0, bend))
        at = compose(at, step)
        graph.add_edge(Edge(graph.add_pose(at) - 1, k, step, INFORMATION))
    for i, j in loops:
        graph.add_edge(Edge(i, j, noisy(between(true, i, j), rng), INFORMATION, robust=True))
    return graph
