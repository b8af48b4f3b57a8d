"""Two sessions that know nothing of each other: what is searched of one in the other, and whether they have met."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uvf.slam.graph.loops import Closure
from uvf.slam.merging.consistency import agreement, largest_clique
from uvf.slam.merging.crossing import searched, the_other_way_round
from uvf.slam.merging.part import VehicleMap

Floats = NDArray[np.float64]

MOST_ASKED = 40
"""Places that are searched for at first, spread over all of them."""
SPREAD = 0.6180339887
"""Multiples of the golden ratio, without their whole part, lie evenly, however many there are."""
LEAST_CLOSURES = 4
LEAST_SPREAD = 5.0
"""m between the two places farthest from each other: within a room that has its double elsewhere everything may agree."""
RIVAL = 0.5
"""Part of the number of closures that agree, which no other closures may reach that agree on another place."""
KEPT = 60  # closures that wait for others to agree with them


@dataclass
class Pair:
    """Two sessions, and the closures found between keyframes i of a and j of b, right ones and wrong ones."""

    a: VehicleMap
    b: VehicleMap
    closures: list[Closure] = field(default_factory=list)
    asked: int = 0
    _waiting: deque[tuple[bool, int]] = field(default_factory=deque)
    _known: tuple[int, int] = (0, 0)

    def grow(self) -> None:
        """Queues new places for the search; of those that are there at first only those of the session with fewer places."""
        before, self._known = self._known, (len(self.a.places), len(self.b.places))
        if 0 in self._known:
            self._known = (0, 0)
        elif before == (0, 0):
            of_a = self._known[0] < self._known[1]
            places = self.a.places if of_a else self.b.places
            order = sorted(range(len(places)), key=lambda k: k * SPREAD % 1.0)
            chosen = order[:: -(-len(order) // MOST_ASKED)]
            self._waiting.extend((of_a, places[k]) for k in sorted(chosen, key=lambda k: k * SPREAD % 1.0))
        else:
            self._waiting.extend((True, i) for i in self.a.places[before[0] :])
            self._waiting.extend((False, j) for j in self.b.places[before[1] :])

    @property
    def waiting(self) -> int:
        """Number of places that have not been searched for yet."""
        return len(self._waiting)

    def ask(self, most: int) -> int:
        """Searches for at most ``most`` of the waiting places; returns how many there were."""
        for done in range(most):
            if not self._waiting:
                return done
            of_a, place = self._waiting.popleft()
            found = searched(self.b, self.a, place) if of_a else searched(self.a, self.b, place)
            self.closures += [the_other_way_round(closure) for closure in found] if of_a else found
            self.asked += 1
        self.closures = self.closures[-KEPT:]
        return most

    def met(self) -> list[Closure]:
        """Closures that agree with each other, are enough, and have no rivals; none where the sessions have not met."""
        if len(self.closures) < LEAST_CLOSURES:
            return []
        agree = agreement(self.closures, self.a, self.b)
        clique = largest_clique(agree)
        others = np.flatnonzero(~agree[clique].any(axis=0))
        others = others[~np.isin(others, clique)]
        rivals = largest_clique(agree[np.ix_(others, others)])
        enough = len(clique) >= LEAST_CLOSURES and len(rivals) <= RIVAL * len(clique)
        agreed = [self.closures[k] for k in clique]
        return agreed if enough and self._spread(agreed) > LEAST_SPREAD else []

    def _spread(self, closures: list[Closure]) -> float:
        places = np.array([self.b.nodes.poses[c.j][:2] for c in closures])
        return float(np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)).max())
