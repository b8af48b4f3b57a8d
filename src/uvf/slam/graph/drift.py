"""How far each keyframe may be from where it is believed to be, seen from one of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Drift:
    """Bounds on what odometry and matching lose: m per m of way, m at once; rad per m, rad at once."""

    position: float = 0.04
    position_start: float = 0.3
    heading: float = 0.01
    heading_start: float = 0.1
    heading_most: float = 0.5

    def radius(self, way: Floats) -> Floats:
        """m, of the disc in which a keyframe lies that is ``way`` [m] of driving away."""
        return self.position_start + self.position * way

    def turn(self, way: Floats) -> Floats:
        """rad, the same for its heading."""
        return np.minimum(self.heading_start + self.heading * way, self.heading_most)


class PathLengths:
    """Shortest ways between keyframes along the edges of the graph [m]."""

    def __init__(self) -> None:
        self._i: list[int] = []
        self._j: list[int] = []
        self._length: list[float] = []

    def add(self, i: int, j: int, length: float) -> None:
        self._i.append(i)
        self._j.append(j)
        self._length.append(max(length, 1e-3))

    def since(self, k: int, n: int) -> Floats:
        """(n,) m from keyframe k to every one."""
        graph = csr_matrix((self._length, (self._i, self._j)), shape=(n, n))
        ways: Floats = dijkstra(graph, directed=False, indices=k)
        return ways
