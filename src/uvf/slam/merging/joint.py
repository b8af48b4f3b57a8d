"""Sessions in one graph: where the keyframes of each lie in the frame of the first."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, inverted, wrapped
from uvf.slam.graph.loops import Closure
from uvf.slam.graph.restored import add_edges
from uvf.slam.maps.session import KINDS, Edges, MappingSession
from uvf.slam.merging.part import VehicleMap
from uvf.slam.method import Keyframe
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph

Floats = NDArray[np.float64]
LOOP = KINDS.index("loop")


@dataclass(frozen=True)
class Crossing:
    """A closure between keyframe i of session a and keyframe j of session b, by their names."""

    a: str
    b: str
    closure: Closure


@dataclass(frozen=True)
class JointGraph:
    """Several sessions in one graph: poses team_from_base (n, 3) [m, m, rad] by session, and the crossings that are believed."""

    poses: dict[str, Floats]
    crossings: list[Crossing]


def settled(parts: Mapping[str, VehicleMap], crossings: Sequence[Crossing], starts: Mapping[str, Floats]) -> JointGraph:
    """Optimises all measurements of all sessions at once, from starts (n, 3) [m, m, rad] by session.

    The first keyframe of the first session stays.
    """
    graph, first = PoseGraph(), _firsts(parts)
    for name in parts:
        for pose in starts[name].tolist():
            graph.add_pose(Pose2(*pose))
    for name, part in parts.items():
        add_edges(part.session.edges, graph, first[name])
    numbers = [
        graph.add_edge(Edge(first[c.a] + c.closure.i, first[c.b] + c.closure.j, c.closure.i_from_j, c.closure.information, robust=True))
        for c in crossings
    ]
    graph.optimise()
    believed = [c for c, number in zip(crossings, numbers, strict=True) if graph.weights[number] > 0.5]
    poses = graph.poses.copy()
    poses[:, 2] = wrapped(poses[:, 2])
    return JointGraph({name: poses[k : k + len(parts[name])] for name, k in first.items()}, believed)


def start_by(closure: Closure, placed_a: Floats, own_b: Floats) -> Floats:
    """Poses (n, 3) of the keyframes of b by a closure to a, from placed poses of a (m, 3) and b's own (n, 3) [m, m, rad]."""
    team_from_j = composed(placed_a[closure.i], np.array(closure.i_from_j))
    return composed(team_from_j, composed(inverted(own_b[closure.j]), own_b))


def session_of(parts: Mapping[str, VehicleMap], joint: JointGraph) -> MappingSession:
    """One session of all keyframes, one session after the other, and all edges."""
    first = _firsts(parts)
    keyframes = [
        Keyframe(Pose2(*pose), node.reading)
        for name, part in parts.items()
        for pose, node in zip(joint.poses[name].tolist(), part.nodes.all, strict=True)
    ]
    return MappingSession(tuple(keyframes), _edges(parts, joint.crossings, first), "graph", {})


def _edges(parts: Mapping[str, VehicleMap], crossings: Sequence[Crossing], first: Mapping[str, int]) -> Edges:
    own = [(part.session.edges, first[name]) for name, part in parts.items()]
    m = len(crossings)
    return Edges(
        np.concatenate(
            [
                *(e.ends + k for e, k in own),
                np.array([(first[c.a] + c.closure.i, first[c.b] + c.closure.j) for c in crossings]).reshape(m, 2),
            ]
        ).astype(np.int64),
        np.concatenate([*(e.measured for e, _ in own), np.array([c.closure.i_from_j for c in crossings]).reshape(m, 3)]),
        np.concatenate([*(e.information for e, _ in own), np.array([c.closure.information for c in crossings]).reshape(m, 3, 3)]),
        np.concatenate([*(e.kinds for e, _ in own), np.full(m, LOOP, dtype=np.uint8)]),
        np.concatenate([*(e.enabled for e, _ in own), np.ones(m, dtype=np.bool_)]),
    )


def _firsts(parts: Mapping[str, VehicleMap]) -> dict[str, int]:
    """The place of each session's first keyframe among all."""
    ends = np.cumsum([len(part) for part in parts.values()])
    return dict(zip(parts, (ends - [len(part) for part in parts.values()]).tolist(), strict=True))
