"""In which order, and from which end, swaths are gone along: the asymmetric travelling salesman over oriented swaths.

First orders by rule (back and forth, and back and forth leaving some out, as Fields2Cover's and QGroundControl's patterns do), each
improved by reversals (2-opt) and by moving runs of swaths either way round (Or-opt), and again from disturbed orders (iterated local
search; Lourenco, Martin & Stutzle 2003). All costs of a move follow from prefix sums of the tour forwards and backwards.

An oriented swath is a number: 2 i goes along swath i from its first end to its second, 2 i + 1 the other way.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LONGEST_MOVED = 24  # swaths, in one move of a run
EFFORT = 600_000  # of all restarts together, in swaths squared
MOST_RESTARTS = 600
BETTER = 1e-7  # s


@compiled
def tour_cost(tour: Ints, cost: Floats) -> float:
    """Time [s] of a tour (n,) of oriented swaths. cost: (2 n + 1, 2 n + 1), the last row from the start and the last column to the end.

    It holds the time from one swath to the other and along the other.
    """
    last = len(cost) - 1
    before, sum_ = last, 0.0
    for each in tour:
        sum_ += cost[before, each]
        before = each
    total: float = sum_ + cost[before, last]
    return total


@compiled
def _prefixes(tour: Ints, cost: Floats, forward: Floats, backward: Floats) -> None:
    """Sums over the steps inside the tour up to each place, as it is and all the other way round."""
    forward[0] = 0.0
    backward[0] = 0.0
    for k in range(1, len(tour)):
        forward[k] = forward[k - 1] + cost[tour[k - 1], tour[k]]
        backward[k] = backward[k - 1] + cost[tour[k] ^ 1, tour[k - 1] ^ 1]


@compiled
def _reverse(tour: Ints, i: int, j: int) -> None:
    """Turns the run from i to j round, each swath of it too."""
    while i < j:
        tour[i], tour[j] = tour[j] ^ 1, tour[i] ^ 1
        i += 1
        j -= 1
    if i == j:
        tour[i] ^= 1


@compiled
def _reversal(tour: Ints, cost: Floats, sums: tuple[Floats, Floats]) -> bool:
    """The first reversal of a run that makes the tour quicker, done; False where there is none."""
    forward, backward = sums
    n, end = len(tour), len(cost) - 1
    for i in range(n):
        before = tour[i - 1] if i > 0 else end
        for j in range(i, n):
            after = tour[j + 1] if j < n - 1 else end
            now = cost[before, tour[i]] + forward[j] - forward[i] + cost[tour[j], after]
            then = cost[before, tour[j] ^ 1] + backward[j] - backward[i] + cost[tour[i] ^ 1, after]
            if then < now - BETTER:
                _reverse(tour, i, j)
                return True
    return False


@compiled
def _moved_run(tour: Ints, cost: Floats, sums: tuple[Floats, Floats]) -> bool:
    """The first move of a run to another place, either way round, that makes the tour quicker, done; False where there is none."""
    forward, backward = sums
    n, end = len(tour), len(cost) - 1
    for size in range(1, min(LONGEST_MOVED, n - 1) + 1):
        for i in range(n - size + 1):
            j = i + size - 1
            first, last = tour[i], tour[j]
            before = tour[i - 1] if i > 0 else end
            after = tour[j + 1] if j < n - 1 else end
            inside, turned = forward[j] - forward[i], backward[j] - backward[i]
            freed = cost[before, first] + inside + cost[last, after] - cost[before, after]
            for k in range(-1, n):
                if i - 1 <= k <= j:
                    continue
                left = tour[k] if k >= 0 else end
                right = tour[k + 1] if k < n - 1 else end
                base = -cost[left, right] - freed
                kept = base + cost[left, first] + inside + cost[last, right]
                flipped = base + cost[left, last ^ 1] + turned + cost[first ^ 1, right]
                if min(kept, flipped) < -BETTER:
                    _move(tour, (i, j), k, flipped < kept)
                    return True
    return False


@compiled
def _move(tour: Ints, run: tuple[int, int], after: int, turned: bool) -> None:
    """Moves the run to behind place ``after``."""
    i, j = run
    taken = tour[i : j + 1].copy()
    size = j - i + 1
    if turned:
        _reverse(taken, 0, size - 1)
    if after < i:
        for k in range(i - 1, after, -1):
            tour[k + size] = tour[k]
        tour[after + 1 : after + 1 + size] = taken
    else:
        for k in range(j + 1, after + 1):
            tour[k - size] = tour[k]
        tour[after + 1 - size : after + 1] = taken


@compiled
def improve(tour: Ints, cost: Floats) -> None:
    """Reverses and moves runs of the tour, in place, until no such change makes it quicker."""
    forward, backward = np.empty(len(tour)), np.empty(len(tour))
    changed = True
    while changed:
        _prefixes(tour, cost, forward, backward)
        changed = _reversal(tour, cost, (forward, backward)) or _moved_run(tour, cost, (forward, backward))


@compiled
def _restarts(tour: Ints, cost: Floats, cuts: Ints) -> float:
    """Improves disturbed copies of the tour, three cuts (r, 3) each that exchange two runs, and keeps what is quicker."""
    best = tour_cost(tour, cost)
    for r in range(len(cuts)):
        i, j, k = cuts[r]
        other = np.concatenate((tour[:i], tour[j:k], tour[i:j], tour[k:]))
        improve(other, cost)
        found = tour_cost(other, cost)
        if found < best - BETTER:
            best = found
            tour[:] = other
    return best


def best_tour(cost: Floats, first: list[Ints], seed: int = 0, restarts: bool = True) -> Ints:
    """A quick tour (n,) of oriented swaths from the orders ``first``. cost: as in ``tour_cost``; Without ``restarts`` it is only improved.

    It is no longer than the best of ``first``; the same seed gives the same tour.
    """
    n = (len(cost) - 1) // 2
    if n == 0:
        return np.empty(0, dtype=np.int64)
    tours = [tour.copy() for tour in first]
    for tour in tours:
        improve(tour, cost)
    best = min(tours, key=lambda tour: tour_cost(tour, cost))
    if restarts and n >= 4:
        rng = np.random.default_rng(seed)
        count = int(min(EFFORT / n**2, MOST_RESTARTS)) + 1
        cuts = np.sort(np.stack([rng.choice(n + 1, 3, replace=False) for _ in range(count)]), axis=1)
        _restarts(best, cost, cuts)
    return best


def rule_orders(groups: list[Ints], skips: list[int]) -> list[Ints]:
    """First orders: the groups of swaths one after the other, each back and forth, at once and leaving ``skips`` swaths out each time."""
    found = []
    for skip in skips:
        order = np.concatenate([group[_skipped(len(group), skip)] for group in groups])
        found.append(2 * order + np.arange(len(order)) % 2)
    return found


def _skipped(count: int, skip: int) -> Ints:
    """Places 0, skip, 1, skip + 1, ... of blocks of twice ``skip`` swaths: turns as wide as ``skip`` and ``skip`` - 1 swaths."""
    if skip <= 1:
        return np.arange(count)
    order = []
    for begin in range(0, count, 2 * skip):
        block = list(range(begin, min(begin + 2 * skip, count)))
        half = (len(block) + 1) // 2
        order += [k for pair in zip(block[:half], block[half:], strict=False) for k in pair] + block[half - 1 : half] * (len(block) % 2)
    return np.array(order)
