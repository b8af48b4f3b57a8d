"""What the pose graph costs while it grows: laps round a block, loops to earlier laps, some of them false."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.pose_graph.false_loops import between
from launch.commands.bench import Figures
from uvf.maths.se2 import Pose2, compose
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph, warm_up

Floats = NDArray[np.float64]

SIZES = ((1228, 2500), (4000, 6000))
"""Poses and edges at the end."""
LAP = 200  # poses
STEP = 0.4  # m
NEW = 5  # loops between two optimisations
FALSE = 20  # every so many loops one is false
SIGMA = np.array((0.02, 0.01, 0.005))  # m, m, rad, of a step and of a loop
INFORMATION = np.diag(1.0 / SIGMA**2)


def laps(poses: int) -> Floats:
    """(n, 3) true poses round a square."""
    side, along = LAP * STEP / 4, np.arange(poses) * STEP
    leg, rest = np.divmod(along, side)
    corner = np.array(((0.0, 0.0), (side, 0.0), (side, side), (0.0, side)))[leg.astype(int) % 4]
    yaw = leg * np.pi / 2
    return np.column_stack((corner[:, 0] + rest * np.cos(yaw), corner[:, 1] + rest * np.sin(yaw), yaw))


def measured(true: Floats, i: int, j: int, rng: np.random.Generator) -> Pose2:
    """The pose of j as i sees it, with noise of SIGMA [m, m, rad]."""
    return compose(between(true, i, j), Pose2(*rng.normal(0.0, SIGMA)))


def growing(data: Path | None) -> Figures:
    """CPU ms: mean and most of an optimisation over the last fifth of the drive; a full annealing at its end; a covariance of two poses,
    the first after a change and the next ones. "error m": mean distance to the truth at the end.
    """
    warm_up()
    rows: Figures = {}
    for poses, edges in SIZES:
        graph, taken = _drive(poses, edges)
        late = 1e3 * np.array(taken[-len(taken) // 5 :])
        row = {"poses": float(poses), "edges": float(len(graph.edges)), "optimised": float(len(taken))}
        row |= {"mean ms": float(late.mean()), "most ms": float(late.max())}
        row["anneal ms"] = _milliseconds(lambda graph=graph: graph.optimise(anneal=True))
        graph.poses = graph.poses.copy()
        row["first covariance ms"] = _milliseconds(lambda graph=graph: graph.relative_covariance(3, len(graph) - 1))
        row["next ms"] = _milliseconds(lambda graph=graph: graph.relative_covariance(4, len(graph) - 1))
        row["error m"] = float(np.hypot(*(graph.poses - laps(poses))[:, :2].T).mean())
        rows[f"growing to {poses}"] = row
    return rows


def _milliseconds(work: Callable[[], object]) -> float:
    begun = time.process_time()
    work()
    return 1e3 * (time.process_time() - begun)


def _drive(poses: int, edges: int) -> tuple[PoseGraph, list[float]]:
    """The graph and the CPU seconds of each optimisation."""
    rng, true = np.random.default_rng(1), laps(poses)
    graph, taken, loops = PoseGraph(), [], 0
    at = Pose2(*true[0])
    graph.add_pose(at)
    for k in range(1, poses):
        step = measured(true, k - 1, k, rng)
        at = compose(at, step)
        graph.add_edge(Edge(graph.add_pose(at) - 1, k, step, INFORMATION))
        while loops < (edges - poses) * (k - LAP) / (poses - LAP):
            loops += 1
            j = k - LAP * int(rng.integers(1, k // LAP + 1))
            seen = measured(true, j + LAP // 3 if loops % FALSE == 0 else j, k, rng)
            graph.add_edge(Edge(j, k, seen, INFORMATION, robust=True))
            if loops % NEW == 0:
                begun = time.process_time()
                graph.optimise()
                taken.append(time.process_time() - begun)
                at = Pose2(*graph.poses[-1])
    return graph, taken


CASES = {"growing": growing}
