"""How far a trajectory is off the known motions between some of its poses.

Kuemmerle et al., "On measuring the accuracy of SLAM algorithms" (2009). The benchmark's relations come as text, a motion a
line: ``stamp1 stamp2 x y z roll pitch yaw``, where the robot is at stamp2 as seen from where it is at stamp1.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2_arrays import composed, inverted, wrapped
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.rows import rows_of

Floats = NDArray[np.float64]

NEAR = 20.0
"""s between the two stamps, below which a relation tests the odometry and the matching rather than the closing of loops."""
GROSS = 0.5
"""m of error that count as gross."""
COLUMNS = 8


@dataclass(frozen=True)
class Relations:
    """Known motions between pairs of poses.

    stamps: (n, 2) [s]; first_from_second: (n, 3) [m, m, rad], the pose at the second stamp as seen from the first.
    """

    stamps: Floats
    first_from_second: Floats

    def __len__(self) -> int:
        return len(self.stamps)

    @property
    def is_near(self) -> NDArray[np.bool_]:
        """Mask (n,) of the relations whose two stamps are less than NEAR apart."""
        near: NDArray[np.bool_] = np.abs(self.stamps[:, 1] - self.stamps[:, 0]) < NEAR
        return near

    def only(self, mask: NDArray[np.bool_]) -> "Relations":
        """The relations that the mask (n,) selects."""
        return Relations(self.stamps[mask], self.first_from_second[mask])


def read_relations(path: Path) -> Relations:
    """Relations of a text file. Raises BadInput where the file or a line of it is not as it should be."""
    rows = [_row(numbers, place) for place, numbers in rows_of(path, "relations")]
    if not rows:
        raise BadInput(f"relations {path}: holds none")
    table = np.array(rows)
    return Relations(table[:, :2], np.column_stack((table[:, 2], table[:, 3], wrapped(table[:, 7]))))


def _row(row: list[float], place: str) -> list[float]:
    if len(row) != COLUMNS:
        raise BadInput(f"relations {place}: no relation; a line is 'stamp1 stamp2 x y z roll pitch yaw'")
    return row


def index_of(stamps: Floats, wanted: Floats) -> NDArray[np.int64]:
    """Index of each wanted stamp [s] among ``stamps`` (n,) [s], to the microsecond, in the shape of ``wanted``; -1 where it is missing."""
    where = {stamp: i for i, stamp in reversed(list(enumerate(np.rint(stamps * 1e6).tolist())))}
    found = [where.get(stamp, -1) for stamp in np.rint(wanted * 1e6).ravel().tolist()]
    return np.array(found, dtype=np.int64).reshape(wanted.shape)


class RelationErrors(NamedTuple):
    """Errors (n,) [m] and [rad] of each relation whose two stamps are known, by both formulas; never negative."""

    freiburg_translation: Floats
    cartographer_translation: Floats
    rotation: Floats
    """The same by both."""
    is_near: NDArray[np.bool_]


def relation_errors(relations: Relations, stamps: Floats, map_from_base: Floats) -> RelationErrors:
    """Errors of a trajectory with stamps (m,) [s] and poses map_from_base (m, 3) [m, m, rad].

    Freiburg (metricEvaluator): the difference of the two motions by components. Cartographer (compute_relations_metrics):
    the length of ``motion o known motion^-1``, to which an error of the heading adds in proportion to the length.
    """
    ends = index_of(stamps, relations.stamps)
    found = ends.min(axis=1) >= 0
    known = relations.first_from_second[found]
    first, second = map_from_base[ends[found, 0]], map_from_base[ends[found, 1]]
    moved = composed(inverted(first), second)
    by_parts, error = moved - known, composed(moved, inverted(known))
    return RelationErrors(
        np.hypot(by_parts[:, 0], by_parts[:, 1]),
        np.hypot(error[:, 0], error[:, 1]),
        np.abs(wrapped(by_parts[:, 2])),
        relations.is_near[found],
    )


class Statistics(NamedTuple):
    """Statistics of errors, in their unit; NaN for no errors at all."""

    number: int
    mean: float
    std: float
    mean_square: float
    median: float
    p95: float
    max: float

    @classmethod
    def of(cls, errors: Floats) -> "Statistics":
        """Statistics of errors (n,); std is that of a sample (n - 1)."""
        n = len(errors)
        if n == 0:
            return cls(0, *[float("nan")] * 6)
        std = float(errors.std(ddof=1)) if n > 1 else 0.0
        median, p95 = np.percentile(errors, (50, 95)).tolist()
        return cls(n, float(errors.mean()), std, float((errors**2).mean()), median, p95, float(errors.max()))


class RelationScore(NamedTuple):
    """Scores of a group of relations."""

    freiburg_translation: Statistics
    cartographer_translation: Statistics
    rotation: Statistics
    """Degrees."""
    gross: int
    """How many are off by more than GROSS, by Freiburg's formula."""


def relation_scores(errors: RelationErrors) -> dict[str, RelationScore]:
    """Scores of ``all`` relations, of the ``near`` ones (less than NEAR apart) and of the ``far`` ones."""
    everything = np.ones(len(errors.is_near), dtype=np.bool_)
    return {name: _score(errors, mask) for name, mask in (("all", everything), ("near", errors.is_near), ("far", ~errors.is_near))}


def _score(errors: RelationErrors, mask: NDArray[np.bool_]) -> RelationScore:
    translation = errors.freiburg_translation[mask]
    return RelationScore(
        Statistics.of(translation),
        Statistics.of(errors.cartographer_translation[mask]),
        Statistics.of(np.degrees(errors.rotation[mask])),
        int((translation > GROSS).sum()),
    )
