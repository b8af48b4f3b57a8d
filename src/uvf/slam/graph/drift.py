"""How far each keyframe may be from where it is believed to be, seen from one of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Drift:
    """Bounds on the drift of odometry and matching: position [m/m] and at once [m], heading [rad/m] and at once [rad]."""

    position: float = 0.04
    position_start: float = 0.3
    heading: float = 0.01
    heading_start: float = 0.1
    heading_most: float = 0.5

    def radius(self, way: Floats) -> Floats:
        """Radii (n,) [m] of the discs in which keyframes lie that are ``way`` (n,) [m] of driving away."""
        return self.position_start + self.position * way

    def turn(self, way: Floats) -> Floats:
        """Bounds (n,) [rad] on the error of the headings of keyframes that are ``way`` (n,) [m] of driving away."""
        return np.minimum(self.heading_start + self.heading * way, self.heading_most)


TIED = 0.3
"""m of way that an edge between two passes counts for: it ties them as well as driving that far."""


class PathLengths:
    """Shortest path lengths [m] between keyframes along the edges of the graph."""

    def __init__(self) -> None:
        self._lengths: dict[tuple[int, int], float] = {}

    def add(self, i: int, j: int, length: float) -> None:
        """Adds an edge of ``length`` [m] between keyframes i and j, of which the shortest counts; shorter ones than 1 mm count as that."""
        ends = (min(i, j), max(i, j))
        self._lengths[ends] = min(max(length, 1e-3), self._lengths.get(ends, np.inf))

    def tie(self, i: int, j: int, information: Floats) -> None:
        """Adds a loop with its information (3, 3) of (x, y, yaw); one along a fence, whose sigma is larger, ties nothing."""
        if np.linalg.eigvalsh(np.linalg.inv(information)[:2, :2])[-1] <= TIED**2:
            self.add(i, j, TIED)

    def since(self, k: int, n: int) -> Floats:
        """Shortest path lengths (n,) [m] from keyframe k to each of the n keyframes."""
        ends = np.array(list(self._lengths), dtype=np.intp).reshape(-1, 2)
        graph = csr_matrix((list(self._lengths.values()), (ends[:, 0], ends[:, 1])), shape=(n, n))
        ways: Floats = dijkstra(graph, directed=False, indices=k)
        return ways
