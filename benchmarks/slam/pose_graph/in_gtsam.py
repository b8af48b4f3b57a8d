"""The same pose graph in gtsam, where that is installed (an extra of the developers).

gtsam's residual is the logarithm of the error, ours and g2o's its x, y and yaw: the costs of the same poses differ a little, by more where
an information is extremely unequal along its axes; at the minimum both are half the sum of chi square.
"""

import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.g2o import turned

try:
    import gtsam
except ImportError:
    gtsam = None

Floats = NDArray[np.float64]

INSTALLED = gtsam is not None
HELD = 1e6  # information of the prior on pose 0
SOLVERS = {"gtsam": "MULTIFRONTAL_CHOLESKY", "gtsam QR": "MULTIFRONTAL_QR"}


def factors(edges: Sequence[Edge], first: Floats) -> Any:
    """The edges as gtsam's factors; the first pose is held."""
    graph = gtsam.NonlinearFactorGraph()
    graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(*first), gtsam.noiseModel.Diagonal.Precisions(np.full(3, HELD))))
    for e in edges:
        noise = gtsam.noiseModel.Gaussian.Information(turned(e.information, -e.i_from_j.yaw))
        graph.add(gtsam.BetweenFactorPose2(e.i, e.j, gtsam.Pose2(*e.i_from_j), noise))
    return graph


def levenberg(graph: Any, poses: Floats, solver: str) -> tuple[float, float]:
    """(cost, CPU seconds) of Levenberg-Marquardt with gtsam's own settings."""
    start = gtsam.Values()
    for k, pose in enumerate(poses):
        start.insert(k, gtsam.Pose2(*pose))
    params = gtsam.LevenbergMarquardtParams()
    params.setLinearSolverType(SOLVERS[solver])
    begun = time.process_time()
    optimizer = gtsam.LevenbergMarquardtOptimizer(graph, start, params)
    optimizer.optimize()
    return optimizer.error(), time.process_time() - begun
