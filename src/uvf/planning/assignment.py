"""Which vehicle of a team goes to which goals, and in which order, so that the last one is done early.

The open vehicle routing problem with several depots and the longest tour as its cost. Goals are inserted where they cost least; then
some of them, in turn neighbours and any, are taken out and inserted again, as long as that makes it no worse (ruin and recreate:
Schrimpf, Schneider, Stamm-Wilbrandt & Dueck, J. Comput. Phys. 159, 2000).
"""

from itertools import pairwise
from math import inf, isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Cost = tuple[float, float]

ROUNDS = 2000
TAKEN_OUT, EVENLY = 8, 0.3  # goals at most in a round; share of rounds that insert evenly
SAME = 1e-9  # s


class Assignment(NamedTuple):
    """Goals by vehicle."""

    tours: list[list[int]]
    """Of each vehicle: indices of its goals in the order in which it goes to them."""
    times: list[float]
    """Of each vehicle: how long its tour takes [s]."""
    unreachable: list[int]
    """Indices of goals that are in no tour: no vehicle gets there, or none that can go on from its other goals."""


def assign(to_goals: Floats, between: Floats, rounds: int = ROUNDS, seed: int = 0) -> Assignment:
    """Tours of V vehicles to G goals: the longest time as short as possible, then the sum of all.

    to_goals: (V, G) time [s] of each vehicle from where it is to each goal; between: (V, G, G) from one goal to another, or (G, G) for all
    alike; infinite where there is no way. The same seed gives the same tours. Raises ValueError for other shapes and times below 0 or NaN.
    """
    to_goals = np.asarray(to_goals, dtype=np.float64)
    if to_goals.ndim != 2 or len(to_goals) == 0:
        raise ValueError(f"to_goals has the shape {to_goals.shape}; it is (vehicles, goals), of one vehicle at least")
    vehicles, goals = to_goals.shape
    between = np.asarray(between, dtype=np.float64)
    if between.shape not in ((goals, goals), (vehicles, goals, goals)):
        raise ValueError(f"between has the shape {between.shape}; it is ({goals}, {goals}) or ({vehicles}, {goals}, {goals})")
    if not ((to_goals >= 0.0).all() and (between >= 0.0).all()):
        raise ValueError("a time is below 0 or no number; where there is no way it is infinite")
    return _Tours(to_goals, np.broadcast_to(between, (vehicles, goals, goals))).best(rounds, np.random.default_rng(seed))


class _Tours:
    """Tours under construction."""

    def __init__(self, to_goals: Floats, between: Floats) -> None:
        self._first: list[list[float]] = to_goals.tolist()
        self._between: list[list[list[float]]] = between.tolist()
        finite = np.where(np.isfinite(between), between, 1e12).min(axis=0)
        self._near: list[list[int]] = np.argsort(np.minimum(finite, finite.T), axis=1, kind="stable").tolist()
        self._goals = to_goals.shape[1]

    def best(self, rounds: int, rng: np.random.Generator) -> Assignment:
        """The best found in so many rounds."""
        tours: list[list[int]] = [[] for _ in self._first]
        nearest = np.min(np.array(self._first).reshape(len(tours), -1), axis=0)
        left = self._insert(tours, np.argsort(-nearest, kind="stable").tolist())
        cost = self._cost(tours)
        for number in range(rounds if self._goals > 1 else 0):
            together = self._near[rng.integers(self._goals)] if number % 2 else rng.permutation(self._goals).tolist()
            out = together[: rng.integers(1, min(TAKEN_OUT, self._goals) + 1)]
            others = [[goal for goal in tour if goal not in out] for tour in tours]
            missing = self._insert(others, rng.permutation(sorted({*out, *left})).tolist(), evenly=rng.random() < EVENLY)
            found = self._cost(others)
            if len(missing) < len(left) or (len(missing) == len(left) and _is_no_worse(found, cost)):
                tours, left, cost = others, missing, found
        return Assignment(tours, [self._time(v, tour) for v, tour in enumerate(tours)], sorted(left))

    def _insert(self, tours: list[list[int]], goals: list[int], evenly: bool = False) -> list[int]:
        """Inserts each goal where it costs least, or ``evenly``: where its vehicle is done first; those that have no place are returned."""
        times = [self._time(v, tour) for v, tour in enumerate(tours)]
        left = []
        for goal in goals:
            longest = max(times)
            best: tuple[float, float, int, int] = (inf, inf, -1, -1)
            for v, tour in enumerate(tours):
                for place, more in enumerate(self._detours(v, tour, goal)):
                    best = min(best, (times[v] + more if evenly else max(longest, times[v] + more), more, v, place))
            longer, more, v, place = best
            if isfinite(longer):
                tours[v].insert(place, goal)
                times[v] += more
            else:
                left.append(goal)
        return left

    def _detours(self, v: int, tour: list[int], goal: int) -> list[float]:
        """How much longer the tour gets with the goal at each place [s]."""
        between, found = self._between[v], []
        for place in range(len(tour) + 1):
            before = self._first[v] if place == 0 else between[tour[place - 1]]
            if place == len(tour):
                found.append(before[goal])
            else:
                more = before[goal] + between[goal][tour[place]]
                found.append(more - before[tour[place]] if isfinite(more) else inf)
        return found

    def _time(self, v: int, tour: list[int]) -> float:
        ways = (self._between[v][a][b] for a, b in pairwise(tour))
        return self._first[v][tour[0]] + sum(ways) if tour else 0.0

    def _cost(self, tours: list[list[int]]) -> Cost:
        times = [self._time(v, tour) for v, tour in enumerate(tours)]
        return max(times), sum(times)


def _is_no_worse(found: Cost, cost: Cost) -> bool:
    """The sum decides where the longest times are the same."""
    return found[0] < cost[0] - SAME or (found[0] < cost[0] + SAME and found[1] <= cost[1])
