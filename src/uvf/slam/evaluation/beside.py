"""What lies beside a log to score its runs by: relations and reference trajectories that share its stamps."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.reference import Trajectory, read_trajectory
from uvf.slam.evaluation.relations import Relations, index_of, read_relations
from uvf.slam.logs.laser_log import LaserLog

Found = TypeVar("Found")

RELATIONS = "*.relations"
TRAJECTORIES = ("*poses.txt", "*trajectory.txt", "*.tum")
SHARED = 0.5
"""Share of a file's stamps that the log must have, for the file to be about it."""


@dataclass(frozen=True)
class Beside:
    """Files that lie beside a log and score its runs, by their names; those of the log's own stem first."""

    relations: dict[str, Relations]
    references: dict[str, Trajectory]
    notes: tuple[str, ...] = ()
    """Files that cannot be read, a line each: nobody has named them, so they end nothing."""


def beside(path: Path, log: LaserLog) -> Beside:
    """Relations and reference trajectories in the folder of the log at ``path``."""
    relations, of_relations = _readable(read_relations, _by_stem(path, log, (RELATIONS,)))
    references, of_references = _readable(read_trajectory, _by_stem(path, log, TRAJECTORIES))
    return Beside(
        {name: r for name, r in relations.items() if _is_about(log, r.stamps)},
        {name: t for name, t in references.items() if _is_about(log, t.stamps)},
        (*of_relations, *of_references),
    )


def _by_stem(path: Path, log: LaserLog, patterns: tuple[str, ...]) -> list[Path]:
    stem = log.name.split(".")[0]
    files = {p for pattern in patterns for p in path.parent.glob(pattern)}
    return sorted(files, key=lambda p: (not p.name.startswith(stem), p.name))


def _readable(read: Callable[[Path], Found], files: list[Path]) -> tuple[dict[str, Found], list[str]]:
    found, notes = {}, []
    for path in files:
        try:
            found[path.name] = read(path)
        except BadInput as error:
            notes.append(f"left out: {error}")
    return found, notes


def _is_about(log: LaserLog, stamps: NDArray[np.float64]) -> bool:
    return float((index_of(log.stamps, stamps) >= 0).mean()) >= SHARED
