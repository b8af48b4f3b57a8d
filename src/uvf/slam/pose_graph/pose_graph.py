"""A graph of poses in the plane that grows while a robot drives, and its optimisation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.pose_graph.covariance import Marginals, along_chain
from uvf.slam.pose_graph.edges import Edge, EdgeTable
from uvf.slam.pose_graph.linearise import chi_squares
from uvf.slam.pose_graph.robust import LIMIT, RobustSolver

Floats = NDArray[np.float64]

MANY = 10
"""Edges switched off at once on arrival, after which it may be one that was believed before that is wrong."""


@dataclass(frozen=True)
class Outcome:
    """Outcome of an optimisation. cost: half the weighted chi square; iterations: linear systems solved.

    annealed: whether a wide kernel was tried.
    """

    cost: float
    iterations: int
    converged: bool
    annealed: bool


class PoseGraph:
    """Nodes are poses (x, y, yaw) in the map frame, edges relative measurements.

    limit: chi square (3 degrees of freedom) above which a robust edge is believed wrong; fixed: the pose that does not move.
    """

    def __init__(self, limit: float = LIMIT, fixed: int = 0) -> None:
        self._limit, self._fixed = limit, fixed
        self._edges = EdgeTable()
        self._poses = np.zeros((64, 3))
        self._count = 0
        self._weights = np.zeros(0)
        self._put_off = 0
        self._solver: RobustSolver | None = None
        self._marginals: Marginals | None = None

    def __len__(self) -> int:
        return self._count

    @property
    def poses(self) -> Floats:
        """Poses map_from_node (n, 3) [m, m, rad], headings not wrapped; a view to read from. To move poses, assign all of them."""
        view = self._poses[: self._count]
        view.flags.writeable = False
        return view

    @poses.setter
    def poses(self, poses: Floats) -> None:
        """Moves all poses to (n, 3) [m, m, rad]. Raises ValueError for another shape or numbers that are not finite."""
        if np.shape(poses) != (self._count, 3) or not np.isfinite(poses).all():
            raise ValueError(f"poses of shape {np.shape(poses)}: wanted are ({self._count}, 3) finite numbers")
        self._poses[: self._count] = poses
        self._marginals = None

    @property
    def edges(self) -> EdgeTable:
        """The table of all edges."""
        return self._edges

    @property
    def weights(self) -> Floats:
        """Weight (m,) of each edge by the last optimisation: 1 counts fully, 0 switched off; edges added since have 1."""
        new = np.ones(len(self._edges) - len(self._weights))
        return np.where(self._edges.rows.enabled, np.concatenate((self._weights, new)), 0.0)

    @property
    def chi2(self) -> Floats:
        """Squared Mahalanobis length (m,) of each edge's residual at the present poses, unweighted."""
        rows = self._edges.rows
        return chi_squares(self._poses, rows.ends, rows.measured, rows.information)

    @property
    def cost(self) -> float:
        """Half the sum of weight times chi square [-], as gtsam and (twice that) g2o count."""
        return 0.5 * float((self.weights * self.chi2).sum())

    def add_pose(self, map_from_node: Pose2) -> int:
        """Adds a pose and returns its number: 0, 1, 2, ... Raises ValueError for numbers that are not finite."""
        if not np.isfinite(map_from_node).all():
            raise ValueError(f"pose {self._count}: a number that is not finite: {tuple(map_from_node)}")
        if self._count == len(self._poses):
            self._poses = np.concatenate((self._poses, np.zeros_like(self._poses)))
        self._poses[self._count] = map_from_node
        self._count += 1
        self._changed()
        return self._count - 1

    def add_edge(self, edge: Edge) -> int:
        """Adds an edge and returns its number: 0, 1, 2, ...

        Raises ValueError: a pose that is not there, numbers that make no measurement.
        """
        number = self._edges.add(edge, self._count)
        self._changed()
        return number

    def enable(self, edge: int, enabled: bool) -> None:
        """Takes an edge out of the graph, or puts it back. Raises ValueError: no such edge."""
        if not 0 <= edge < len(self._edges):
            raise ValueError(f"no edge {edge}; there are {len(self._edges)}")
        self._edges.rows.enabled[edge] = enabled
        self._edges.rows.judged[edge] = False
        self._changed()

    def optimise(self, anneal: bool | None = None, tolerance: float = 0.05) -> Outcome:
        """Moves the poses to where the edges want them: the least cost found from where they are.

        A robust edge that is new and would be switched off is given a trial when the graph leaves room for it.
        anneal: whether to look from a wide kernel, too, under which no edge is lost from the start; None: when the trial leaves it open, or
        many have been switched off since the last time. tolerance: length of the step that ends it [standard deviations].
        Raises ValueError: no pose to hold fixed.
        """
        solver, rows, start = self._solver_now(), self._edges.rows, self._poses[: self._count]
        found = [solver.settle(start, tolerance)]
        lost = rows.robust & rows.enabled & ~rows.judged & (found[0].weights < 0.5)
        self._put_off += int(lost.sum())
        if anneal is None:
            anneal = self._put_off >= MANY
        if lost.any() and not anneal:
            trial = solver.plausible(found[0], lost)
            if trial.any():
                found.append(solver.settle(start, tolerance, trial))
                anneal = bool((trial & (found[-1].weights < 0.5)).any())
        if anneal:
            found.append(solver.anneal(start, tolerance))
            self._put_off = 0
        best = min(found, key=lambda settled: settled.cost)
        self.poses = best.poses
        self._weights = best.weights
        rows.judged[:] = True
        return Outcome(self.cost, sum(settled.steps for settled in found), best.converged, anneal)

    def relative_covariance(self, i: int, j: int) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) of i_from_j [m, rad], by all edges with the weights of the last optimisation.

        Raises ValueError: no such pose.
        """
        self._check(i, j)
        return self._marginals_now().relative(i, j)

    def covariances_from(self, i: int) -> Floats:
        """Covariances (n, 3, 3) of (x, y, yaw) of i_from_j [m, rad] for every pose j at once, for about two iterations' cost.

        Raises ValueError: no such pose.
        """
        self._check(i)
        return self._marginals_now().all_from(i)

    def chain_covariance(self, i: int, j: int) -> Floats:
        """Covariance (3, 3) of i_from_j [m, rad] by the trusted edges from each pose to the next alone.

        It is never smaller, and needs no factorisation. Raises ValueError: no such pose, or no such edge on the way.
        """
        self._check(i, j)
        return along_chain(self._edges.rows, self._poses[: self._count], i, j)

    def _check(self, *poses: int) -> None:
        for pose in poses:
            if not 0 <= pose < self._count:
                raise ValueError(f"no pose {pose}; there are {self._count}")

    def _changed(self) -> None:
        self._solver = self._marginals = None

    def _solver_now(self) -> RobustSolver:
        if self._solver is None:
            self._check(self._fixed)
            self._solver = RobustSolver(self._edges.rows, self._limit, self._fixed)
        return self._solver

    def _marginals_now(self) -> Marginals:
        if self._marginals is None:
            poses = self._poses[: self._count]
            system = self._solver_now().system(self._count, self.weights)
            system.linearise(poses, self.weights)
            self._marginals = Marginals(system, poses)
        return self._marginals


def warm_up() -> None:
    """Loads or compiles what an optimisation needs, so that the first one does not wait for it."""
    graph = PoseGraph()
    for _ in range(3):
        graph.add_pose(IDENTITY)
    for i, j in ((0, 1), (1, 2), (0, 2)):
        graph.add_edge(Edge(i, j, Pose2(0.0, 0.0, float(i)), np.eye(3), robust=j - i > 1))
    graph.optimise(anneal=True)
    graph.covariances_from(1)
