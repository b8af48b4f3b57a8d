"""The figures of a run: numbers by name, as they go into tables and JSON."""

from typing import Any

import numpy as np

from launch.slam.known import Known
from uvf.slam.evaluation.reference import Trajectory, TrajectoryError, absolute_error, is_alignable, relative_error
from uvf.slam.evaluation.relations import RelationScore, Statistics, relation_errors, relation_scores
from uvf.slam.evaluation.run import LogRun

SHORT, LONG = 1.0, 10.0
"""m of way over which relative errors are told."""
POSES = ("online", "final")
Figures = dict[str, Any]


def figures(run: LogRun, known: Known) -> Figures:
    """Figures of a run: ``run`` has size and times; ``relations`` and ``references`` have errors by file, of online and final poses.

    The absolute error of the rotation is None where the path is too short to align.
    """
    poses = {"online": run.online, "final": run.final}
    return {
        "run": _of_run(run),
        "relations": {
            name: {when: _by_group(relation_scores(relation_errors(relations, run.log.stamps, poses[when]))) for when in POSES}
            for name, relations in known.relations.items()
        },
        "references": {
            name: {when: against(Trajectory(run.log.stamps, poses[when]), reference) for when in POSES}
            for name, reference in known.references.items()
        },
    }


def _of_run(run: LogRun) -> dict[str, float]:
    final = run.final
    return {
        "readings": len(run.log),
        "keyframes": len(run.keyframes),
        "duration_s": run.log.duration,
        "path_length_m": float(np.hypot(*np.diff(final[:, :2], axis=0).T).sum()),
        "wall_s": run.wall,
        "cpu_s": run.cpu,
        "times_real_time": run.times_real_time,
        "skew_s": run.skew,
        "mean_quality": float(run.quality.mean()),
    }


def _by_group(scores: dict[str, RelationScore]) -> dict[str, Figures]:
    return {group: _of_score(score) for group, score in scores.items() if score.rotation.number}


def _of_score(score: RelationScore) -> Figures:
    return {
        "number": score.rotation.number,
        "freiburg_m": _statistics(score.freiburg_translation),
        "cartographer_m": _statistics(score.cartographer_translation),
        "rotation_deg": _statistics(score.rotation),
        "gross": score.gross,
    }


def _statistics(s: Statistics) -> dict[str, float]:
    return {name: value for name, value in s._asdict().items() if name != "number"}


def against(estimate: Trajectory, reference: Trajectory) -> Figures:
    """Errors [m, deg] of a trajectory by their kind. Raises BadInput."""
    found = {
        "absolute": absolute_error(estimate, reference),
        f"per {SHORT:g} m": relative_error(estimate, reference, SHORT),
        f"per {LONG:g} m": relative_error(estimate, reference, LONG),
    }
    told: Figures = {name: _deviation(d) for name, d in found.items() if d.number}
    if not is_alignable(estimate, reference):
        told["absolute"]["rotation_rmse_deg"] = None
    return told


def _deviation(d: TrajectoryError) -> Figures:
    return {"number": d.number, "rmse_m": d.rmse, "mean_m": d.mean, "max_m": d.max, "rotation_rmse_deg": d.rotation_rmse}
