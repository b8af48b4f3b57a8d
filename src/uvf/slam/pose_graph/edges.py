"""The measurements of a pose graph: a table that grows, one row an edge."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ROUNDING = 1e-9
"""How far below zero, relative to the largest, an eigenvalue may lie that was meant to be zero."""


@dataclass(frozen=True)
class Edge:
    """A measurement of pose j from pose i.

    information: (3, 3) inverse covariance of (x, y, yaw) of ``i_from_j``, so along the axes of i [1/m^2, 1/rad^2]; may
    be singular. robust: may lose its weight when the other edges contradict it (loops); odometry does not.
    """

    i: int
    j: int
    i_from_j: Pose2
    information: Floats
    robust: bool = False


@dataclass(frozen=True)
class EdgeRows:
    """Edges as columns. ends: (m, 2) poses i and j; measured: (m, 3) [m, m, rad]; information: (m, 3, 3) [1/m^2, 1/rad^2].

    judged: whether an optimisation has weighed it since it was added or put back.
    """

    ends: Ints
    measured: Floats
    information: Floats
    robust: Bools
    enabled: Bools
    judged: Bools


class EdgeTable:
    """Edges by number; a number is never given twice, and an edge that is switched off keeps its own."""

    def __init__(self) -> None:
        self._count = 0
        self._rows = _empty(64)

    def __len__(self) -> int:
        return self._count

    @property
    def rows(self) -> EdgeRows:
        """Views of all edges as columns: writing into them writes the table."""
        n, r = self._count, self._rows
        return EdgeRows(r.ends[:n], r.measured[:n], r.information[:n], r.robust[:n], r.enabled[:n], r.judged[:n])

    def add(self, edge: Edge, poses: int) -> int:
        """Adds an edge and returns its number. Raises ValueError: an end that is none of ``poses``, numbers that make no measurement."""
        information = checked(edge, poses)
        if self._count == len(self._rows.ends):
            self._rows = _copied(self._rows, 2 * self._count)
        k, r = self._count, self._rows
        r.ends[k] = edge.i, edge.j
        r.measured[k] = edge.i_from_j
        r.information[k] = information
        r.robust[k] = edge.robust
        r.enabled[k] = True
        self._count += 1
        return k


def _empty(capacity: int) -> EdgeRows:
    return EdgeRows(
        np.zeros((capacity, 2), np.int64),
        np.zeros((capacity, 3)),
        np.zeros((capacity, 3, 3)),
        np.zeros(capacity, np.bool_),
        np.zeros(capacity, np.bool_),
        np.zeros(capacity, np.bool_),
    )


def _copied(rows: EdgeRows, capacity: int) -> EdgeRows:
    larger, n = _empty(capacity), len(rows.ends)
    for name in ("ends", "measured", "information", "robust", "enabled", "judged"):
        getattr(larger, name)[:n] = getattr(rows, name)
    return larger


def checked(edge: Edge, poses: int) -> Floats:
    """Information (3, 3) [1/m^2, 1/rad^2] of an edge, symmetric to the last bit.

    Raises ValueError: an end that is none of ``poses``, numbers that make no measurement.
    """
    where = f"edge {edge.i} -> {edge.j}"
    for end in (edge.i, edge.j):
        if not 0 <= end < poses:
            raise ValueError(f"{where}: no pose {end}; there are {poses}")
    if edge.i == edge.j:
        raise ValueError(f"{where}: a pose is not measured from itself")
    information = np.asarray(edge.information, dtype=np.float64)
    if information.shape != (3, 3):
        raise ValueError(f"{where}: information of shape {information.shape}, not (3, 3)")
    if not (np.isfinite(edge.i_from_j).all() and np.isfinite(information).all()):
        raise ValueError(f"{where}: a number that is not finite")
    scale = float(np.abs(information).max())
    if np.abs(information - information.T).max() > 1e-6 * scale:
        raise ValueError(f"{where}: information that is not symmetric")
    symmetric: Floats = (information + information.T) / 2.0
    smallest, _, largest = np.linalg.eigvalsh(symmetric).tolist()
    if largest <= 0.0 or smallest < -ROUNDING * largest:
        raise ValueError(f"{where}: information is no inverse covariance: eigenvalues {smallest:.3g} to {largest:.3g}")
    return symmetric
