"""Pose graphs: every .g2o file below DATA/slam/posegraphs, beside gtsam.

Costs are half the sum of chi square, as gtsam counts. Times are CPU ms of the optimisation alone, the best of ROUNDS, in one run; where
gtsam is not installed, its columns are left out.
"""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.pose_graph.in_gtsam import INSTALLED, SOLVERS, factors, levenberg
from launch.commands.bench import Figures
from uvf.maths.se2 import Pose2
from uvf.models.yaml_data import BadInput
from uvf.slam.pose_graph import g2o
from uvf.slam.pose_graph.descent import heading_first
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.linear import LinearSystem
from uvf.slam.pose_graph.pose_graph import PoseGraph, warm_up

Floats = NDArray[np.float64]
Result = TypeVar("Result")

ROUNDS = 3
EXACT = 1e-3
"""Last step [standard deviations of the graph] of the comparison of costs."""


def files(data: Path | None) -> list[Path]:
    """Raises BadInput where there are none."""
    found = sorted((data / "slam" / "posegraphs").rglob("*.g2o")) if data else []
    if not found:
        raise BadInput(f"no .g2o file below {data or '--data'}/slam/posegraphs; give --data FOLDER")
    return found


def graph_of(poses: Floats, edges: list[Edge]) -> PoseGraph:
    """UVF's pose graph with these poses and edges."""
    graph = PoseGraph()
    for pose in poses:
        graph.add_pose(Pose2(*pose))
    for edge in edges:
        graph.add_edge(edge)
    return graph


def timed(work: Callable[[], Result]) -> tuple[Result, float]:
    """What came out, and the least CPU ms."""
    taken = []
    for _ in range(ROUNDS):
        begun = time.process_time()
        result = work()
        taken.append(time.process_time() - begun)
    return result, 1e3 * min(taken)


def cost(data: Path | None) -> Figures:
    """No edge is robust. From the poses of the file, and from headings first (whose own time is not in the others)."""
    warm_up()
    rows: Figures = {}
    for path in files(data):
        read, edges = g2o.read(path)
        edges = [replace(edge, robust=False) for edge in edges]
        start = np.array(read)
        graph, ones = graph_of(start, edges), np.ones(len(edges))
        system = LinearSystem(len(start), graph.edges.rows, np.ones(len(edges), np.bool_), 0)
        headed, milliseconds = timed(partial(heading_first, system, start, ones))
        rows[path.stem] = {"poses": len(start), "edges": len(edges), **_beside(start, edges)}
        rows[f"{path.stem}, headings first"] = {"headings ms": milliseconds, **_beside(headed, edges)}
    return rows


def _beside(start: Floats, edges: list[Edge]) -> dict[str, float]:
    graph = graph_of(start, edges)
    row = {"start": graph.cost}

    def solve() -> None:
        graph.poses = start
        graph.enable(0, True)  # an edge that is touched has all planned anew
        graph.optimise(tolerance=EXACT)

    row["own ms"] = timed(solve)[1]
    row["own"] = graph.cost
    if INSTALLED:
        theirs = factors(edges, start[0])
        for solver in SOLVERS:
            (row[solver], _), row[f"{solver} ms"] = timed(partial(levenberg, theirs, start, solver))
        row["gtsam QR from own"] = levenberg(theirs, graph.poses, "gtsam QR")[0]
    return row


CASES = {"cost": cost}
