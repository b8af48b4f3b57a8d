"""What becomes of the loops that are found: which are believed, and when the graph is settled."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.graph.drift import PathLengths
from uvf.slam.graph.loops import Closure, LoopSearch
from uvf.slam.graph.nodes import KeyframeNodes
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph

Floats = NDArray[np.float64]

EVERY = 3  # keyframes from one look for loops to the next
FAR_EVERY = 6
CONFIRMED_BY = 1
"""Further loops that must agree with one that is found far from where it was expected."""
CONSISTENT = 11.3
"""chi square (3 degrees of freedom, 99 %) of the way round two loops that agree (Mangelson 2018, pairwise consistency)."""
WAITING = 40  # loops that wait for another to agree with them
SETTLED_EVERY = 15.0  # m of way after which loops that change little are settled all the same
TELLING = 3.0
"""chi square of a new loop from which on the graph is settled at once."""


@dataclass
class Closing:
    """Adds the loop closures that it believes to the graph, and keeps the nodes' poses as the graph has them."""

    graph: PoseGraph
    nodes: KeyframeNodes
    ways: PathLengths
    search: LoopSearch
    waiting: list[Closure] = field(default_factory=list)
    settled_at: float = 0.0
    loops: int = 0

    def look(self, k: int) -> bool:
        """Looks for loop closures of keyframe k, the newest; returns whether the graph has been optimised."""
        if k % EVERY:
            return False
        ways = self.ways.since(k, len(self.nodes))
        believed = self.search.near(k, ways)
        if not believed and k % FAR_EVERY == 0:
            closure = self.search.far(k, ways)
            believed = self._confirmed(closure) if closure else []
        for closure in believed:
            self._add(closure)
        travelled = self.nodes.all[k].travelled
        if not believed or (travelled - self.settled_at < SETTLED_EVERY and not self._tells()):
            return False
        self.settle()
        self.settled_at = travelled
        return True

    def settle(self) -> None:
        """Optimises the graph and moves the keyframes to where it has them."""
        self.graph.optimise()
        self.nodes.poses[:] = [Pose2(float(x), float(y), wrap(float(yaw))) for x, y, yaw in self.graph.poses]

    def _tells(self) -> bool:
        rows = self.graph.edges.rows
        new = ~rows.judged & rows.robust
        return bool((self.graph.chi2[new] > TELLING).any())

    def _add(self, closure: Closure) -> None:
        self.graph.add_edge(Edge(closure.i, closure.j, closure.i_from_j, closure.information, robust=True))
        self.ways.tie(closure.i, closure.j, closure.information)
        self.loops += 1

    def _confirmed(self, closure: Closure) -> list[Closure]:
        """The closure and those before it that it agrees with, if these are enough."""
        agreeing = [c for c in self.waiting if c.j != closure.j and self._agree(c, closure)]
        if len(agreeing) < CONFIRMED_BY:
            self.waiting = [*self.waiting, closure][-WAITING:]
            return []
        self.waiting = [c for c in self.waiting if c not in agreeing]
        return [*agreeing, closure]

    def _agree(self, a: Closure, b: Closure) -> bool:
        """Whether one comes back to where one began: i_a to j_a by one loop, along the drive to j_b, by the other to i_b, and back."""
        legs = (a.i_from_j, self.nodes.between(a.j, b.j), inverse(b.i_from_j), self.nodes.between(b.i, a.i))
        end = Pose2(0.0, 0.0, 0.0)
        for leg in legs:
            end = compose(end, leg)
        way = sum(abs(self.nodes.all[p].travelled - self.nodes.all[q].travelled) for p, q in ((a.j, b.j), (a.i, b.i)))
        turn = 0.01 + 0.003 * np.sqrt(way)
        shift = 0.03 + 0.02 * np.sqrt(way) + turn * np.hypot(*a.i_from_j[:2])
        return bool((end[0] ** 2 + end[1] ** 2) / shift**2 + wrap(end[2]) ** 2 / turn**2 < CONSISTENT)
