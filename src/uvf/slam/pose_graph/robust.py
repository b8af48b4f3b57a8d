"""Edges that may be wrong: graduated non-convexity on truncated least squares.

What is sought are the poses with the least sum of chi square over the trusted edges and min(chi square, limit) over those that may be
wrong. Yang, Antonante, Tzoumas, Carlone, "Graduated Non-Convexity for Robust Spatial Perception" (2020): a convex cost is turned into
that one by a growing ``mu``.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.pose_graph.covariance import Marginals
from uvf.slam.pose_graph.descent import Descent, descend
from uvf.slam.pose_graph.edges import Bools, EdgeRows
from uvf.slam.pose_graph.linear import LinearSystem
from uvf.slam.pose_graph.linearise import chi_squares

Floats = NDArray[np.float64]

LIMIT = 16.3
"""chi square at which an edge is believed wrong; a true one of 3 degrees of freedom passes with 99.9 %."""
GENTLE = 0.1
"""Start of mu, relative to the largest that makes the cost convex."""
FASTER = 2.0
"""Growth of mu from one step to the next. Slower finds a little more, 4 loses single true loops after a large drift."""
SHARP = 1e3
"""mu at which the cost is truncated least squares for good."""
ROUNDS = 10
STEPS = 30


@dataclass(frozen=True)
class Settled:
    """Outcome: poses (n, 3) [m, m, rad], weights (m,), half the truncated chi square, and number of linear systems solved."""

    poses: Floats
    weights: Floats
    cost: float
    steps: int
    converged: bool


def truncated(chi2: Floats, mu: float, limit: float) -> Floats:
    """Weights (m,), 0 to 1, of edges with chi squares (m,), by the surrogate of truncated least squares at ``limit`` for ``mu`` [-]."""
    with np.errstate(divide="ignore"):
        middle = np.sqrt(limit * mu * (mu + 1.0) / chi2) - mu
    out: Floats = np.clip(middle, 0.0, 1.0)
    return out


class RobustSolver:
    """Optimises one state of a graph with robust edges."""

    def __init__(self, rows: EdgeRows, limit: float, fixed: int) -> None:
        self._rows, self._limit, self._fixed = rows, limit, fixed
        self._system: LinearSystem | None = None

    def settle(self, poses: Floats, tolerance: float, believed: Bools | None = None) -> Settled:
        """Descends from poses (n, 3) [m, m, rad], with the weights that the edges have there. tolerance: as of ``descend`` [sigmas].

        believed: (m,) edges that count fully until the first rest, however far off they are.
        """
        weights, steps = self._weights(poses, SHARP), 0
        if believed is not None:
            weights = np.where(believed, 1.0, weights)
        for _ in range(ROUNDS):
            down = self._descend(poses, weights, (STEPS, tolerance))
            poses, steps, before = down.poses, steps + down.steps, weights
            weights = self._weights(poses, SHARP)
            if np.abs(weights - before).max(initial=0.0) < 1e-3:
                break
        return Settled(poses, before, self._cost(poses), steps, down.converged)

    def anneal(self, poses: Floats, tolerance: float) -> Settled:
        """Descends from poses (n, 3) [m, m, rad] by way of a cost without local minima. tolerance: as for ``settle``.

        Far-off edges begin with little weight, and may win the others over.
        """
        doubtful = self._rows.robust & self._rows.enabled
        largest = max(float(self._chi2(poses)[doubtful].max(initial=0.0)), self._limit)
        mu, steps = GENTLE * self._limit / (2.0 * largest - self._limit), 0
        while mu < SHARP:
            weights = self._weights(poses, mu)
            if not ((weights > 0.0) & (weights < 1.0)).any():
                break
            poses = self._descend(poses, weights, (1, tolerance)).poses
            steps += 1
            mu *= FASTER
        found = self.settle(poses, tolerance)
        return replace(found, steps=steps + found.steps)

    def plausible(self, settled: Settled, asked: Bools) -> Bools:
        """Mask (m,) of the edges asked for, switched off there, that would raise the chi square of the others by less than the limit.

        By how far they are off in terms of what the graph leaves open there: exact as far as the graph is linear.
        """
        rows, out = self._rows, np.zeros(len(asked), np.bool_)
        system = self.system(len(settled.poses), settled.weights)
        system.linearise(settled.poses, settled.weights)
        marginals = Marginals(system, settled.poses)
        for k in np.flatnonzero(asked):
            i, j = rows.ends[k].tolist()
            off = np.array(compose(inverse(Pose2(*settled.poses[i].tolist())), Pose2(*settled.poses[j].tolist()))) - rows.measured[k]
            off[2] = wrap(off[2])
            open_ = np.eye(3) + marginals.relative(i, j) @ rows.information[k]
            out[k] = off @ rows.information[k] @ np.linalg.solve(open_, off) < self._limit
        return out

    def system(self, poses: int, weights: Floats) -> LinearSystem:
        """Linear system for weights (m,); the one in use if it fits: it has each edge that has a weight, and few others."""
        used, now = weights > 0.0, self._system
        if now is None or (used & ~now.used).any() or np.count_nonzero(now.used & ~used) > 0.02 * len(used):
            self._system = now = LinearSystem(poses, self._rows, used, self._fixed)
        return now

    def _descend(self, poses: Floats, weights: Floats, limits: tuple[int, float]) -> Descent:
        return descend(self.system(len(poses), weights), poses, weights, limits)

    def _chi2(self, poses: Floats) -> Floats:
        rows = self._rows
        return chi_squares(poses, rows.ends, rows.measured, rows.information)

    def _weights(self, poses: Floats, mu: float) -> Floats:
        robust = truncated(self._chi2(poses), mu, self._limit)
        return np.where(self._rows.enabled, np.where(self._rows.robust, robust, 1.0), 0.0)

    def _cost(self, poses: Floats) -> float:
        chi2, rows = self._chi2(poses), self._rows
        return 0.5 * float(np.where(rows.robust, np.minimum(chi2, self._limit), chi2)[rows.enabled].sum())
