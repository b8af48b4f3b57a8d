"""What is known of a log to score runs over it by: relations, reference trajectories, and the truth of a simulated run.

The truth is read here, where methods do not get to see it.
"""

from dataclasses import dataclass
from pathlib import Path

from launch.scoring.truth import true_poses, within
from launch.slam.opening import is_recorded
from uvf.maths.se2_arrays import interpolated
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.laser_log import samples_of
from uvf.slam.evaluation.beside import beside
from uvf.slam.evaluation.reference import Trajectory
from uvf.slam.evaluation.relations import Relations, index_of, read_relations
from uvf.slam.logs.laser_log import LaserLog


@dataclass(frozen=True)
class Known:
    """The relations and references of a log, by the name of the file they come from."""

    relations: dict[str, Relations]
    references: dict[str, Trajectory]
    notes: tuple[str, ...] = ()
    """What is left out, a line each."""


def known_of(path: Path, log: LaserLog, vehicle: str | None, relations: Path | None) -> Known:
    """The relations and references that belong to a log; relations: a file to score by instead of those beside it. Raises BadInput."""
    found = beside(path, log)
    chosen = {relations.name: _about(log, relations)} if relations else found.relations
    references = dict(found.references)
    if is_recorded(path) and (truth := _truth(path, log, vehicle)) is not None:
        references["truth"] = truth
    return Known(chosen, references, found.notes)


def _about(log: LaserLog, path: Path) -> Relations:
    """Raises BadInput for a file that is broken or of another log."""
    relations = read_relations(path)
    if not (index_of(log.stamps, relations.stamps) >= 0).all(axis=1).any():
        raise BadInput(f"relations {path}: none of them is between two readings of the log; it belongs to another one")
    return relations


def _truth(path: Path, log: LaserLog, vehicle: str | None) -> Trajectory | None:
    """At the stamps of the readings, as far as they are between those of the truth; None where there is none."""
    name = vehicle or log.name.removeprefix(f"{path.stem}-")
    track = true_poses(samples_of(path), name)
    if len(track) < 2:
        return None
    stamps = log.stamps[within(track, log.stamps)]
    if not len(stamps):
        raise BadInput(f"log {path}: its scans and its truth are of different times")
    return Trajectory(stamps, interpolated(track, stamps))
