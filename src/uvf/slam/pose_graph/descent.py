"""Gauss-Newton down to the poses that given weights want, from good starts and from bad ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.slam.pose_graph.linear import REST, LinearSystem

Floats = NDArray[np.float64]

PATIENCE = 5
"""Steps that may raise the cost one after the other: Gauss-Newton on poses climbs on its way out of a bad start."""
FIRST_DAMPING = 1e-2
QUICK = 0.1
"""How much shorter than the last a step has to be for the factor to do for another."""
HEADINGS, POSITIONS = np.array((False, False, True)), np.array((True, True, False))


@dataclass(frozen=True)
class Descent:
    """Outcome of a descent: poses (n, 3) [m, m, rad], number of linear systems solved, and whether the last step was short enough."""

    poses: Floats
    steps: int
    converged: bool


def heading_first(system: LinearSystem, poses: Floats, weights: Floats) -> Floats:
    """Poses (n, 3) [m, m, rad] found from the headings that the edges want and the positions that follow from those.

    Both are linear problems once the turns are counted, which is done from the headings of ``poses``: Carlone, Aragues, Castellanos,
    Bona, "A Fast and Accurate Approximation for Planar Pose Graph Optimization" (2014).
    """
    found = poses.copy()
    for axes in (HEADINGS, POSITIONS):
        system.linearise_some(found, weights, axes)
        found += system.step()[0]
    return found


def descend(system: LinearSystem, poses: Floats, weights: Floats, limits: tuple[int, float]) -> Descent:
    """Descends from poses (n, 3) [m, m, rad] to the least cost under weights (m,) of all edges.

    limits: most steps, and the length of a step [standard deviations] that is short enough to end it.
    A factor is used again as long as each step by it is much shorter than the one before.
    The first step that raises the cost is held against a start by headings. When PATIENCE steps in a row stay above the best, it goes back
    there and damps (Levenberg-Marquardt).
    """
    most, tolerance = limits
    now, best, lowest, worse, damping = poses, poses, np.inf, 0, REST
    length, tried = 0.0, False
    for taken in range(1, most + 1):
        cost = system.linearise(now, weights)
        if cost >= lowest and not tried:
            tried = True
            other = heading_first(system, best, weights)
            cost, length = system.linearise(other, weights), 0.0
            now = other if cost < lowest else now
        if cost < lowest:
            best, lowest, worse, damping = now, cost, 0, max(damping / 10.0, REST)
        else:
            worse += 1
            length = 0.0
            if worse > PATIENCE:
                now, damping = best, max(10.0 * damping, FIRST_DAMPING)
            system.linearise(now, weights)
        x, length, fresh = _step(system, length, damping)
        if length >= tolerance or fresh:
            now = now + x
        if length < tolerance:
            return Descent(now, taken, True)
    return Descent(now if worse == 0 else best, most, False)


def _step(system: LinearSystem, last: float, damping: float) -> tuple[Floats, float, bool]:
    """The step, its length, and whether it is by a factor of its own: that of the last one does if the step is much shorter by it.

    ``last``: how long that was, 0 where there was none. The shortest steps by an old factor tell that the end is reached, but where an
    information is extremely unequal along its axes they lead away from it.
    """
    if last > 0.0:
        x, length = system.step_again()
        if length < QUICK * last:
            return x, length, False
    return *system.step(damping), True
