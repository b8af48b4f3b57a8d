"""The normal equations of a pose graph: linearised, factorised and solved as often as its edges stay the same."""

import numpy as np
from numpy.typing import NDArray

from uvf.slam.pose_graph.cholesky import factorise, solve
from uvf.slam.pose_graph.edges import Bools, EdgeRows
from uvf.slam.pose_graph.fronts import plan, structure
from uvf.slam.pose_graph.linearise import Normal, normal_equations
from uvf.slam.pose_graph.selected import diagonal_of_inverse

Floats = NDArray[np.float64]

REST = 1e-6
"""Least damping [1/m^2, 1/rad^2]: what no edge holds stays where it is. It slows the last steps, and biases nothing."""
STIFFEST = 1e12


class LinearSystem:
    """The system H x = -g of the edges in ``used`` (m,), without the fixed pose, whose step is zero."""

    def __init__(self, poses: int, rows: EdgeRows, used: Bools, fixed: int) -> None:
        self.used = used.copy()
        self._fixed = fixed
        self._which = np.flatnonzero(used)
        self._ends, self._measured = rows.ends[self._which], rows.measured[self._which]
        self._information = rows.information[self._which]
        found = structure(poses, self._ends, fixed)
        self._tree = plan(found)
        place = self._tree.place[self._ends]
        self._slots = found.slots, place[:, 0] > place[:, 1]
        self._normal = Normal(np.empty((poses, 3, 3)), np.empty((len(found.neighbours) // 2, 3, 3)), np.empty((poses, 3)))
        self._panels, self._updates = np.empty(self._tree.panels[-1]), np.empty(self._tree.updates[-1])

    def linearise(self, poses: Floats, weights: Floats) -> float:
        """Linearises at poses (n, 3) [m, m, rad] with weights (m,) of all edges; returns half the weighted chi square [-]."""
        w = weights[self._which]
        cost = normal_equations(poses, self._ends, self._measured, self._information, w, self._slots, self._normal)
        self._release()
        return cost

    def linearise_some(self, poses: Floats, weights: Floats, axes: Bools) -> None:
        """Linearises at poses (n, 3) with weights (m,) in those of x, y and yaw that ``axes`` (3,) has; the others are held."""
        information, normal = self._information * np.outer(axes, axes), self._normal
        normal_equations(poses, self._ends, self._measured, information, weights[self._which], self._slots, normal)
        held = np.flatnonzero(~axes)
        for blocks in (normal.diagonal, normal.between):
            blocks[:, held] = 0.0
            blocks[:, :, held] = 0.0
        normal.diagonal[:, held, held] = 1.0
        normal.gradient[:, held] = 0.0
        self._release()

    def _release(self) -> None:
        """The fixed pose from the others, whose blocks have nothing of it."""
        self._normal.diagonal[self._fixed] = np.eye(3)
        self._normal.gradient[self._fixed] = 0.0

    def step(self, damping: float = REST) -> tuple[Floats, float]:
        """Step x (n, 3) [m, m, rad], and its length in standard deviations of the whole graph [-].

        H gets ``damping`` [1/m^2, 1/rad^2] on its diagonal, and as much more as it takes to make it positive definite.
        Raises ValueError where no damping does.
        """
        while not factorise(self._tree, self._normal, damping, self._panels, self._updates):
            damping *= 100.0
            if damping > STIFFEST:
                raise ValueError("the normal matrix of the graph is not positive definite: a pose or a weight is not finite")
        return self.step_again()

    def step_again(self) -> tuple[Floats, float]:
        """Step (n, 3) [m, m, rad] and its length [-] by the factor of the last step, whatever has been linearised since."""
        x = -self.solve(self._normal.gradient[None])[0]
        return x, float(np.sqrt(max(-(self._normal.gradient * x).sum(), 0.0)))

    def solve(self, right: Floats) -> Floats:
        """Solutions (k, n, 3) for right sides (k, n, 3), by the factor of the last step."""
        x = solve(self._tree, self._panels, right)
        x[:, self._fixed] = 0.0
        return x

    def inverse_diagonal(self) -> Floats:
        """Covariance (n, 3, 3) of each pose in the map frame [m, rad], by the factor of the last step."""
        out = diagonal_of_inverse(self._tree, self._panels)
        out[self._fixed] = 0.0
        return out
