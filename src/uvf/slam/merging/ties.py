"""Further closures between sessions whose place to each other is known: wherever one comes near the other's way."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose, inverse
from uvf.maths.se2_arrays import wrapped
from uvf.slam.merging.crossing import fit
from uvf.slam.merging.joint import Crossing
from uvf.slam.merging.part import VehicleMap

Floats = NDArray[np.float64]

SPACING = 6  # keyframes from one look to the next
REACH, REACH_TURN = 1.5, 0.7
"""m, rad between two keyframes that must see the same."""


@dataclass(frozen=True)
class Ties:
    """Further closures between two sessions. looked: number of places where the sessions are near each other.

    crossings: those at which they fit.
    """

    looked: int
    crossings: tuple[Crossing, ...]

    def __add__(self, other: "Ties") -> "Ties":
        return Ties(self.looked + other.looked, self.crossings + other.crossings)


def agreement(found: Iterable[Ties]) -> float:
    """Mean part, 0 to 1, of what they tell that is confirmed where they are near each other; 1 where there is no such place."""
    every = list(found)
    looked = sum(of_two.looked for of_two in every)
    return sum(c.closure.score for of_two in every for c in of_two.crossings) / looked if looked else 1.0


def ties(parts: Mapping[str, VehicleMap], poses: Mapping[str, Floats], a: str, b: str, since: int = 0) -> Ties:
    """Closures of keyframes of b, from ``since`` on, in submaps of a. poses: team_from_base (n, 3) [m, m, rad] by session."""
    found, looked = [], 0
    for j in range(since, len(parts[b]), SPACING):
        pose = poses[b][j]
        away = np.hypot(*(poses[a][:, :2] - pose[:2]).T) + np.abs(wrapped(poses[a][:, 2] - pose[2]))
        i = int(np.argmin(away))
        near = np.hypot(*(poses[a][i, :2] - pose[:2])) < REACH and abs(float(wrapped(poses[a][i, 2] - pose[2]))) < REACH_TURN
        if near:
            looked += 1
            i_from_j = compose(inverse(Pose2(*poses[a][i].tolist())), Pose2(*pose.tolist()))
            closure = fit(parts[a], parts[b], j, compose(parts[a].nodes.poses[i], i_from_j))
            found += [Crossing(a, b, closure)] if closure else []
    return Ties(looked, tuple(found))
