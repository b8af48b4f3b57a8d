"""The nodes of Hybrid-A*: a pool that is kept from query to query, and a table that says which node a state has.

Nodes are numbered on from query to query, so that an older number in the table says that this query has not been there: nothing is
cleared in between.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

X, Y, YAW, COST = 0, 1, 2, 3
PARENT, STATE, MOVE, CLOSED = 0, 1, 2, 3
ROOM = 16_384  # nodes at first


class Nodes(NamedTuple):
    """``poses`` (n, 4) x, y [cells], yaw [rad], cost from the start [cells]; ``links`` (n, 4) parent, state, the move there, closed."""

    poses: Floats
    links: Ints


def make_nodes() -> Nodes:
    """An empty pool."""
    return Nodes(np.empty((ROOM, 4)), np.empty((ROOM, 4), dtype=np.int32))


@compiled
def with_nodes(nodes: Nodes, count: int, more: int) -> Nodes:
    """The pool of ``count`` nodes, doubled where it lacks room for ``more``."""
    if count + more <= nodes.poses.shape[0]:
        return nodes
    room = 2 * nodes.poses.shape[0] + more
    poses, links = np.empty((room, 4)), np.empty((room, 4), dtype=np.int32)
    poses[:count], links[:count] = nodes.poses[:count], nodes.links[:count]
    return Nodes(poses, links)


@compiled
def put(nodes: Nodes, i: int, pose: tuple[float, float, float, float], links: tuple[int, int, int]) -> None:
    """Writes node ``i``, open: x, y, yaw, cost; parent, state, move."""
    nodes.poses[i, X], nodes.poses[i, Y], nodes.poses[i, YAW], nodes.poses[i, COST] = pose
    nodes.links[i, PARENT], nodes.links[i, STATE], nodes.links[i, MOVE] = links
    nodes.links[i, CLOSED] = 0
