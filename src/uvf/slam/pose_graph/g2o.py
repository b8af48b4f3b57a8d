"""Pose graphs as g2o's text files: ``VERTEX_SE2 id x y yaw`` and ``EDGE_SE2 i j x y yaw`` with the upper triangle of the information.

g2o measures the error of an edge along the axes of the measured pose j, an ``Edge`` along those of i: the information is turned.
"""

import heapq
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.yaml_data import BadInput, nearest
from uvf.slam.pose_graph.edges import Edge, checked
from uvf.slam.pose_graph.pose_graph import PoseGraph

Floats = NDArray[np.float64]

FIELDS = {"VERTEX_SE2": (1, 3), "EDGE_SE2": (2, 9)}
"""Of each kind of line: how many ids and how many numbers."""
UPPER = np.triu_indices(3)


def read(path: Path) -> tuple[list[Pose2], list[Edge]]:
    """Poses and edges of a file; edges that do not join successive poses are robust. Raises BadInput.

    A file without vertices gets those that follow from its edges, along successive poses where it can.
    """
    poses: list[Pose2] = []
    places: dict[int, str] = {}
    edges: list[tuple[str, Edge]] = []
    for number, line in enumerate(_text(path).splitlines(), start=1):
        words, place = line.split(), f"{path}:{number}"
        if not words or words[0].startswith("#"):
            continue
        ids, numbers = _parsed(words, place)
        if len(ids) == 2:
            edges.append((place, _edge(ids, numbers)))
            continue
        if ids[0] in places:
            raise BadInput(f"{place}: vertex {ids[0]} is there twice, first in {places[ids[0]]}; remove one")
        if ids[0] != len(poses):
            raise BadInput(f"{place}: vertex {ids[0]} where {len(poses)} should be; number them 0, 1, 2, ... in order, without gaps")
        places[ids[0]] = place
        poses.append(Pose2(*numbers.tolist()))
    return _complete(path, poses, edges), [edge for _, edge in edges]


def write(path: Path, graph: PoseGraph) -> None:
    """Writes all poses and the enabled edges."""
    lines = [f"VERTEX_SE2 {k} {_said(pose)}" for k, pose in enumerate(graph.poses)]
    rows = graph.edges.rows
    for k in np.flatnonzero(rows.enabled):
        information = turned(rows.information[k], -float(rows.measured[k, 2]))
        lines.append(f"EDGE_SE2 {rows.ends[k, 0]} {rows.ends[k, 1]} {_said(rows.measured[k])} {_said(information[UPPER])}")
    path.write_text("\n".join(lines) + "\n")


def _said(numbers: Floats) -> str:
    return " ".join(repr(float(x)) for x in numbers)


def _text(path: Path) -> str:
    try:
        return path.read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read: {error}; give a g2o text file") from error


def _parsed(words: list[str], place: str) -> tuple[list[int], Floats]:
    if words[0] not in FIELDS:
        raise BadInput(f"{place}: '{words[0]}' is not known; {nearest(words[0], FIELDS)}")
    ids, numbers = FIELDS[words[0]]
    if len(words) != 1 + ids + numbers:
        raise BadInput(f"{place}: {words[0]} with {len(words) - 1} fields; it has {ids + numbers}: complete the line or remove it")
    try:
        parsed = [int(w) for w in words[1 : 1 + ids]], np.array([float(w) for w in words[1 + ids :]])
    except ValueError as error:
        raise BadInput(f"{place}: {error}; write ids as whole numbers and the rest as decimal ones") from error
    if not np.isfinite(parsed[1]).all():
        raise BadInput(f"{place}: a number that is not finite; remove the line")
    return parsed


def turned(information: Floats, yaw: float) -> Floats:
    """Information (3, 3) along the axes of a frame in which those of the given one are turned by ``yaw`` [rad]."""
    c, s = np.cos(yaw), np.sin(yaw)
    turn = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    turned: Floats = turn @ information @ turn.T
    return turned


def _edge(ids: list[int], numbers: Floats) -> Edge:
    information = np.zeros((3, 3))
    information[UPPER] = numbers[3:]
    information += np.triu(information, 1).T
    i, j = ids
    return Edge(i, j, Pose2(*numbers[:3].tolist()), turned(information, float(numbers[2])), robust=abs(i - j) != 1)


def _complete(path: Path, poses: list[Pose2], edges: list[tuple[str, Edge]]) -> list[Pose2]:
    """The poses, or those along the edges where there are none; every edge looked at."""
    if not poses and not edges:
        raise BadInput(f"{path}: no vertex and no edge; give a file with VERTEX_SE2 or EDGE_SE2 lines")
    count = len(poses) or 1 + max(max(edge.i, edge.j) for _, edge in edges)
    for place, edge in edges:
        try:
            checked(edge, count)
        except ValueError as error:
            raise BadInput(f"{place}: {error}; correct the line or remove it") from error
    return poses or _chained(path, count, [edge for _, edge in edges])


def _chained(path: Path, count: int, edges: list[Edge]) -> list[Pose2]:
    """From pose 0 over the edges that span the least numbers of poses (Prim 1957)."""
    ties: list[list[tuple[int, Pose2]]] = [[] for _ in range(count)]
    for edge in edges:
        ties[edge.i].append((edge.j, edge.i_from_j))
        ties[edge.j].append((edge.i, inverse(edge.i_from_j)))
    found: dict[int, Pose2] = {}
    waiting = [(0, 0, IDENTITY)]
    while waiting:
        _, k, pose = heapq.heappop(waiting)
        if k in found:
            continue
        found[k] = pose
        for other, k_from_other in ties[k]:
            if other not in found:
                heapq.heappush(waiting, (abs(k - other), other, compose(pose, k_from_other)))
    if len(found) < count:
        lost = min(set(range(count)) - set(found))
        raise BadInput(f"{path}: no edges lead from pose 0 to pose {lost}; add VERTEX_SE2 lines or the edges, numbered without gaps")
    return [found[k] for k in range(count)]
