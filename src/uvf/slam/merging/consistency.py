"""Which closures between two sessions agree with each other.

Mangelson, Dominic, Eustice, Vasudevan, "Pairwise Consistent Measurement Set Maximization for Robust Multi-robot Map Merging" (2018):
two closures agree when the way around them, by both sessions' own measurements, comes back to where it began; what is believed is the
largest set of closures that all agree.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import compose
from uvf.slam.graph.loops import Closure
from uvf.slam.merging.part import VehicleMap
from uvf.slam.pose_graph.uncertainty import followed

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

CONSISTENT = 11.3
"""chi square, 3 degrees of freedom, 99 %."""


def chi_square(p: Closure, q: Closure, a: VehicleMap, b: VehicleMap) -> float:
    """Chi square [-] of the difference of two ways from p.i in a to q.j in b: by closure p and along b, and along a and by closure q."""
    along_b, along_a = b.nodes.between(p.j, q.j), a.nodes.between(p.i, q.i)
    first, second = compose(p.i_from_j, along_b), compose(along_a, q.i_from_j)
    of_p: Floats = np.asarray(np.linalg.inv(p.information), dtype=np.float64)
    of_q: Floats = np.asarray(np.linalg.inv(q.information), dtype=np.float64)
    covariance: Floats = followed(of_p, p.i_from_j, along_b, b.leg(p.j, q.j)) + followed(a.leg(p.i, q.i), along_a, q.i_from_j, of_q)
    off = np.array((first[0] - second[0], first[1] - second[1], wrap(first[2] - second[2])))
    return float(off @ np.linalg.solve(covariance, off))


def agreement(closures: Sequence[Closure], a: VehicleMap, b: VehicleMap) -> Mask:
    """Which closures agree with which (n, n); none with another of the same keyframe, which is in one place only."""
    n = len(closures)
    agree = np.zeros((n, n), dtype=np.bool_)
    for k, p in enumerate(closures):
        for m, q in enumerate(closures[:k]):
            if p.j != q.j:
                agree[k, m] = agree[m, k] = chi_square(p, q, a, b) < CONSISTENT
    return agree


def largest_clique(agree: Mask) -> list[int]:
    """Rows of ``agree`` (n, n) that all agree with each other, as many as the heuristic of Pattabiraman et al. (2013) finds.

    From each row on, always the one that agrees with the most is taken.
    """
    best: list[int] = []
    degree = agree.sum(axis=1)
    for start in np.argsort(-degree, kind="stable").tolist():
        if degree[start] < len(best):
            break
        clique, left = [start], agree[start].copy()
        while left.any():
            chosen = int(np.argmax(np.where(left, degree, -1)))
            clique.append(chosen)
            left &= agree[chosen]
        if len(clique) > len(best):
            best = clique
    return sorted(best)
