"""Who drives first through a passage that is too narrow for two: the others wait where they are not in the way.

Each vehicle decides by itself from the same facts, where everybody is and the path that everybody follows; so all decide alike. Where
each stands in the passage of another, they would wait for each other without end: then the first by name drives, and steers past.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from uvf.planning.smoothing import first_part, resample, way_along

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

ROOM = 0.1  # m between two that pass each other
AHEAD = 5.0  # m of the way that is worth looking at
LOOKED = 30.0  # m of another one's way
EVEN = 0.5  # m of difference in the ways to the passage, up to which the names decide
JOINED = 0.4  # m between two narrow places that count as one passage


class Traveller(NamedTuple):
    """A vehicle of the team with its path (n, 2) [m], from where it is to where it goes, and its circumscribed radius [m]."""

    name: str
    path: Floats
    radius: float


class Wait(NamedTuple):
    """How far [m] along its path a vehicle may drive now, and for whom it waits."""

    until: float
    for_whom: str


def give_way(own: Traveller, clearance: Floats, others: Sequence[Traveller]) -> Wait | None:
    """Where a vehicle has to wait for others, the first such place of its path; None where it may drive on.

    clearance: (n,) m from the points of its own path to the nearest obstacle.
    """
    along = way_along(own.path)
    waits = [_wait(own, (along, clearance), other._replace(path=_looked_at(other))) for other in others if len(other.path)]
    return min((wait for wait in waits if wait is not None), default=None)


def that_meet(own: Traveller, others: Sequence[Traveller]) -> list[Traveller]:
    """Those of the others whose path comes so near to its own that one may have to wait; only they need ``give_way``."""
    moving = [other for other in others if len(other.path) and len(own.path)]
    return [other for other in moving if cdist(own.path, _looked_at(other)).min() < _apart(own, other)]


def is_first_of_circle(own: str, for_whom: str, waiting: Mapping[str, str]) -> bool:
    """Whether vehicles wait for each other in a circle of which ``own`` is the first by name, if it waits ``for_whom``.

    waiting: for whom each of the others says that it waits.
    """
    circle, name = [own], for_whom
    while name and name not in circle:
        circle.append(name)
        name = waiting.get(name, "")
    return name == own == min(circle)


def _wait(own: Traveller, way: tuple[Floats, Floats], other: Traveller) -> Wait | None:
    """Where it waits for this one. As much room as between the middles of two that pass each other is needed to either side."""
    (along, clearance), apart = way, _apart(own, other)
    for passage in _passages(along, clearance < apart):
        if _comes_first(own, other, (along, passage), apart):
            return Wait(_waiting_place(own.path[: passage.start + 1], along, other.path, apart), other.name)
    return None


def _looked_at(other: Traveller) -> Floats:
    """(n, 2) m of another one's path, at even distances."""
    return resample(first_part(other.path, LOOKED))


def _apart(own: Traveller, other: Traveller) -> float:
    """m between the middles of two that pass each other."""
    return own.radius + other.radius + ROOM


def _passages(along: Floats, narrow: Mask) -> list[slice]:
    """The narrow stretches of a path, as slices of its points."""
    found: list[slice] = []
    for k in np.flatnonzero(narrow).tolist():
        if found and along[k] - along[found[-1].stop - 1] <= JOINED:
            found[-1] = slice(found[-1].start, k + 1)
        else:
            found.append(slice(k, k + 1))
    return found


def _comes_first(own: Traveller, other: Traveller, where: tuple[Floats, slice], apart: float) -> bool:
    """Whether the other one comes through the passage towards this vehicle, and is to come before it."""
    along, passage = where
    stretch, theirs = own.path[passage], other.path
    near = cdist(stretch, theirs) < apart
    if not near.any():
        return False
    shared = np.flatnonzero(near.any(axis=1))
    enters, leaves = (int(np.argmin(cdist(stretch[k : k + 1], theirs)[0])) for k in (shared[0], shared[-1]))
    inside = bool(np.hypot(*(stretch - theirs[0]).T).min() < apart)
    if enters < leaves or (enters == leaves and not inside):
        return False  # it drives ahead in the same direction, or only crosses
    if passage.start == 0:
        return inside and other.name < own.name
    if inside:
        return True
    mine, their = float(along[passage.start]), float(way_along(theirs)[leaves])
    return their < mine - EVEN or (their <= mine + EVEN and other.name < own.name)


def _waiting_place(before: Floats, along: Floats, theirs: Floats, apart: float) -> float:
    """m along the path before the passage to the last place at which the other one can come by; 0 where there is none."""
    free = np.flatnonzero((cdist(before, theirs) >= apart).all(axis=1))
    return float(along[free[-1]]) if len(free) else 0.0
