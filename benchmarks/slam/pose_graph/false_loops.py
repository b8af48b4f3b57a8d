"""Pose graphs with false loops: places taken for others, alone or, as when a corridor looks like another, several in a row that agree.

Every .g2o file below DATA/slam/posegraphs.
"""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.slam.pose_graph.optimisation import EXACT, files, graph_of
from launch.commands.bench import Figures
from uvf.maths.alignment import aligned
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse, transform
from uvf.models.yaml_data import BadInput
from uvf.slam.pose_graph import g2o
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.pose_graph import PoseGraph, warm_up
from uvf.slam.pose_graph.robust import LIMIT

Floats = NDArray[np.float64]

APART = 20  # poses between the two that are taken for one place
NEAR = (0.5, 0.5, 0.3)  # m, m, rad: sigma of where the one is seen from the other
NOISE = (0.02, 0.02, 0.01)
ROW = (5, 10)  # false loops that agree
TRUTH = "_gt.txt"
SHARES, SEEDS = (0.1, 0.5, 1.0), 2


def between(poses: Floats, i: int, j: int) -> Pose2:
    """The pose of j as i sees it."""
    return compose(inverse(Pose2(*poses[i])), Pose2(*poses[j]))


def false_loops(poses: Floats, information: Floats, count: int, rows: bool, seed: int) -> list[Edge]:
    """poses: (n, 3) by odometry, along which the loops of a row agree."""
    rng = np.random.default_rng(seed)
    edges: list[Edge] = []
    while len(edges) < count:
        i, j = sorted(rng.integers(0, len(poses), 2).tolist())
        if j - i < APART:
            continue
        seen = Pose2(*rng.normal(0.0, NEAR))
        for k in range(int(rng.integers(ROW[0], ROW[1] + 1)) if rows else 1):
            if j + k < len(poses) and len(edges) < count:
                along = compose(compose(between(poses, i + k, i), seen), between(poses, j, j + k))
                edges.append(Edge(i + k, j + k, compose(along, Pose2(*rng.normal(0.0, NOISE))), information, robust=True))
    return edges


def truth_beside(path: Path, poses: int) -> Floats | None:
    """(n, 3) poses along the exact edges ``EDGE2 i j x y yaw ...`` of the file NAME_gt.txt beside NAME.g2o; None without one."""
    beside = path.with_name(path.stem + TRUTH)
    if not beside.exists():
        return None
    steps = {}
    for line in beside.read_text().splitlines():
        words = line.split()
        if words[0] == "EDGE2" and int(words[2]) == int(words[1]) + 1:
            steps[int(words[1])] = Pose2(*(float(w) for w in words[3:6]))
    true = [IDENTITY]
    for k in range(poses - 1):
        if k not in steps:
            raise BadInput(f"{beside}: no EDGE2 from {k} to {k + 1}; add it, or take the file away")
        true.append(compose(true[-1], steps[k]))
    return np.array(true)


def false(data: Path | None) -> Figures:
    """False loops by the number of true ones, from the poses of the file: alone ("random") and in rows of 5 to 10 that agree.

    ATE: root mean square distance [m] to the truth beside the file or, without one, to the optimum without false loops and kernel.
    x truth: the truncated cost over that of the best poses known to be right; below 1 the false loops explain more than the truth.
    """
    warm_up()
    rows: Figures = {}
    for path in files(data):
        read, edges = g2o.read(path)
        start = np.array(read)
        right = graph_of(start, [replace(edge, robust=False) for edge in edges])
        right.optimise(tolerance=EXACT)
        truth = truth_beside(path, len(start))
        reference = right.poses.copy() if truth is None else truth
        rows[f"{path.stem}, none false"] = _robust(start, edges, 0, (right.poses, reference))
        loops = sum(edge.robust for edge in edges)
        information = np.median([edge.information for edge in edges if edge.robust], axis=0)
        for rowed in (False, True):
            for share in SHARES:
                each = []
                for seed in range(SEEDS):
                    wrong = false_loops(start, information, round(share * loops), rowed, seed)
                    each.append(_robust(start, edges + wrong, len(wrong), (right.poses, reference)))
                name = f"{path.stem}, {share:.0%} {'in rows' if rowed else 'random'}"
                rows[name] = {key: float(np.mean([row[key] for row in each])) for key in each[0]}
    return rows


def truncated(graph: PoseGraph) -> float:
    """What the robust optimisation lowers."""
    chi2 = graph.chi2
    return 0.5 * float(np.where(graph.edges.rows.robust, np.minimum(chi2, LIMIT), chi2).sum())


def _robust(start: Floats, edges: list[Edge], wrong: int, known: tuple[Floats, Floats]) -> dict[str, float]:
    """wrong: how many edges at the end are false; known: poses that are right, and those that the error is counted from."""
    graph = graph_of(known[0], edges)
    best = truncated(graph)
    graph.poses = start
    begun = time.process_time()
    outcome = graph.optimise()
    taken = time.process_time() - begun
    true, robust = len(edges) - wrong, graph.edges.rows.robust
    off = graph.weights < 0.5
    ours = transform(aligned(known[1][:, :2], graph.poses[:, :2]), graph.poses[:, :2])
    return {
        "true loops": float(robust[:true].sum()),
        "lost": float(off[:true].sum()),
        "false": float(wrong),
        "kept": float((~off[true:]).sum()),
        "ATE m": float(np.sqrt(((ours - known[1][:, :2]) ** 2).sum(axis=1).mean())),
        "x truth": truncated(graph) / best,
        "steps": float(outcome.iterations),
        "own ms": 1e3 * taken,
    }


CASES = {"false": false}
