"""A trajectory against a reference: absolute error after alignment (ATE), relative error along the way (RPE).

Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems" (2012), in the plane.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.alignment import aligned
from uvf.maths.se2_arrays import composed, inverted, wrapped
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.rows import rows_of

Floats = NDArray[np.float64]

ASSOCIATION = 0.05
"""s: poses that are farther apart in time are not of one another."""
FEWEST = 2
"""Poses in common, below which nothing can be aligned."""
ALIGNABLE = 0.3
"""m: a path that reaches less far across has no direction by which it could be laid onto another."""
WIDTHS = (4, 8)
FORMS = "'stamp x y yaw' or 'stamp x y z qx qy qz qw'"


@dataclass(frozen=True)
class Trajectory:
    """A trajectory: stamps (n,) [s], rising, and poses world_from_base (n, 3) [m, m, rad]."""

    stamps: Floats
    world_from_base: Floats

    def __len__(self) -> int:
        return len(self.stamps)


def read_trajectory(path: Path) -> Trajectory:
    """Trajectory of a text file, a pose a line: ``stamp x y yaw``, or as TUM has it ``stamp x y z qx qy qz qw``. Raises BadInput."""
    rows = [_row(numbers, place) for place, numbers in rows_of(path, "trajectory")]
    if not rows:
        raise BadInput(f"trajectory {path}: holds no pose")
    table = np.array(rows)
    table = table[np.argsort(table[:, 0], kind="stable")]
    return Trajectory(table[:, 0], table[:, 1:])


def _row(numbers: list[float], place: str) -> tuple[float, float, float, float]:
    if len(numbers) not in WIDTHS:
        raise BadInput(f"trajectory {place}: no pose; a line is {FORMS}")
    if len(numbers) == 4:
        stamp, x, y, yaw = numbers
    else:
        stamp, x, y, _, qx, qy, qz, qw = numbers
        yaw = np.arctan2(2.0 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz)  # of any length: files round
    return stamp, x, y, float(yaw)


def paired(estimate: Trajectory, reference: Trajectory) -> tuple[Floats, Floats]:
    """Poses (k, 3) of both at the times of the estimate that have a reference within ASSOCIATION; the nearest counts."""
    after = np.searchsorted(reference.stamps, estimate.stamps).clip(0, len(reference) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(reference.stamps[after] - estimate.stamps) < np.abs(reference.stamps[before] - estimate.stamps)
    nearest = np.where(nearer, after, before)
    found = np.abs(reference.stamps[nearest] - estimate.stamps) <= ASSOCIATION
    return estimate.world_from_base[found], reference.world_from_base[nearest[found]]


class TrajectoryError(NamedTuple):
    """Errors of a trajectory: rmse, mean and max of the translation [m], rmse of the rotation [deg]."""

    number: int
    rmse: float
    mean: float
    max: float
    rotation_rmse: float

    @classmethod
    def of(cls, error: Floats) -> "TrajectoryError":
        """Statistics of error poses (n, 3) [m, m, rad], which ought to be zero; NaN where there are none."""
        if not len(error):
            return cls(0, *[float("nan")] * 4)
        distance, turn = np.hypot(error[:, 0], error[:, 1]), np.degrees(error[:, 2])
        rms = [float(np.sqrt((e**2).mean())) for e in (distance, turn)]
        return cls(len(error), rms[0], float(distance.mean()), float(distance.max()), rms[1])


def deviations(estimate: Trajectory, reference: Trajectory) -> Floats:
    """Differences (k, 3) [m, m, rad] of the poses once the estimate is laid onto the reference as a whole, without scale.

    Of those poses of the estimate that have a reference. Raises BadInput.
    """
    ours, theirs = _enough(paired(estimate, reference))
    reference_from_map = np.array(aligned(theirs[:, :2], ours[:, :2]))
    laid = composed(reference_from_map, ours)
    return np.column_stack((laid[:, :2] - theirs[:, :2], wrapped(laid[:, 2] - theirs[:, 2])))


def is_alignable(estimate: Trajectory, reference: Trajectory) -> bool:
    """Whether the path in common reaches far enough across, ALIGNABLE, for its direction to be told by alignment."""
    _, theirs = paired(estimate, reference)
    return len(theirs) >= FEWEST and float(np.hypot(*np.ptp(theirs[:, :2], axis=0))) >= ALIGNABLE


def absolute_error(estimate: Trajectory, reference: Trajectory) -> TrajectoryError:
    """Absolute trajectory error (ATE): how far the poses are apart after alignment. Raises BadInput."""
    return TrajectoryError.of(deviations(estimate, reference))


def relative_error(estimate: Trajectory, reference: Trajectory, distance: float) -> TrajectoryError:
    """Relative pose error (RPE): that of the motion from each pose to the first one ``distance`` [m] further along the way.

    Raises BadInput.
    """
    ours, theirs = _enough(paired(estimate, reference))
    way = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(theirs[:, :2], axis=0).T))))
    ends = np.searchsorted(way, way + distance)
    starts = np.flatnonzero(ends < len(way))
    ends = ends[starts]
    moved, known = (composed(inverted(poses[starts]), poses[ends]) for poses in (ours, theirs))
    return TrajectoryError.of(composed(inverted(known), moved))


def _enough(pairs: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    if len(pairs[0]) < FEWEST:
        raise BadInput(f"the trajectories have {len(pairs[0])} poses within {ASSOCIATION} s of each other: nothing to compare")
    return pairs
