"""A session's keyframes and edges as nodes and graph again."""

from math import hypot

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.slam.graph.nodes import KeyframeNodes, Node
from uvf.slam.maps.session import KINDS, Edges, MappingSession
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph

LOOP = KINDS.index("loop")


def add_keyframes(session: MappingSession, nodes: KeyframeNodes) -> tuple[float, float]:
    """Adds the keyframes that the nodes lack, and moves all to their poses; returns the way [m] and the turns [rad] to the last one."""
    known = len(nodes)
    nodes.poses[:] = [keyframe.map_from_base for keyframe in session.keyframes[:known]]
    way, turn = (nodes.all[-1].travelled, nodes.all[-1].turned) if known else (0.0, 0.0)
    for keyframe in session.keyframes[known:]:
        pose = keyframe.map_from_base
        moved = compose(inverse(nodes.poses[-1]), pose) if len(nodes) else IDENTITY
        way, turn = way + hypot(moved[0], moved[1]), turn + abs(moved[2])
        nodes.add(Node(keyframe.reading, cloud_of(keyframe.reading), way, turn), pose)
    return way, turn


def add_edges(edges: Edges, graph: PoseGraph, first: int = 0) -> None:
    """Adds a session's edges to a graph that has the poses already. first: the pose of the session's first keyframe.

    Raises ValueError as ``add_edge`` does.
    """
    rows = zip(edges.ends.tolist(), edges.measured.tolist(), edges.information, edges.kinds.tolist(), edges.enabled.tolist(), strict=True)
    for (i, j), measured, information, kind, enabled in rows:
        edge = graph.add_edge(Edge(first + i, first + j, Pose2(*measured), information, robust=kind == LOOP))
        if not enabled:
            graph.enable(edge, False)
