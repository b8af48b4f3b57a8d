"""What lies beside a log to score its runs by: relations and reference trajectories that share its stamps."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.slam.evaluation.reference import Trajectory, read_trajectory
from services.slam.evaluation.relations import Relations, index_of, read_relations
from services.slam.logs.laser_log import LaserLog

RELATIONS = "*.relations"
TRAJECTORIES = ("*poses.txt", "*trajectory.txt", "*.tum")
SHARED = 0.5
"""Share of a file's stamps that the log must have, for the file to be about it."""


def relations_beside(path: Path, log: LaserLog) -> dict[str, Relations]:
    """By the name of their file; of the log's own stem first."""
    found = {p: read_relations(p) for p in _by_stem(path, [*path.parent.glob(RELATIONS)])}
    return {p.name: r for p, r in found.items() if _is_about(log, r.stamps)}


def references_beside(path: Path, log: LaserLog) -> dict[str, Trajectory]:
    """By the name of their file; of the log's own stem first."""
    found = {p: read_trajectory(p) for p in _by_stem(path, [p for pattern in TRAJECTORIES for p in path.parent.glob(pattern)])}
    return {p.name: t for p, t in found.items() if _is_about(log, t.stamps)}


def _by_stem(log: Path, files: list[Path]) -> Iterator[Path]:
    stem = log.name.split(".")[0]
    yield from sorted(files, key=lambda p: (not p.name.startswith(stem), p.name))


def _is_about(log: LaserLog, stamps: NDArray[np.float64]) -> bool:
    return float((index_of(log.stamps, stamps) >= 0).mean()) >= SHARED
