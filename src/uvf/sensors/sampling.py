"""When a sensor's readings are taken, which are lost, and when they arrive."""

import math
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

T = TypeVar("T")
EARLY = 1e-6
"""Part of a period by which the clock may be short of a due time: rounding only."""


class Due:
    """Tells when a sensor that runs at ``hz`` takes a new reading.

    The k-th one is due at k / hz and is taken at the first step from then on: a rate that does not divide that of the steps
    keeps its mean exactly, and no reading is taken twice.
    """

    def __init__(self, hz: float) -> None:
        self._hz = hz
        self._n = 0

    def at(self, t: float) -> bool:
        """Whether a new reading is due at ``t`` [s]; True once for each."""
        if t * self._hz < self._n + 1 - EARLY:
            return False
        self._n = math.floor(t * self._hz + EARLY)
        return True


class Dropout:
    """Which readings are lost: each that is not in a burst begins one with ``probability``; ``burst`` readings are then lost in a row.

    The share that is lost in the long run is p b / (p b + 1 - p).
    """

    def __init__(self, probability: float, burst: int, rng: np.random.Generator) -> None:
        self._probability = probability
        self._burst = burst
        self._rng = rng
        self._to_lose = 0

    def lost(self) -> bool:
        """Whether the next reading is lost."""
        begins = self._rng.random() < self._probability  # drawn within a burst too: one number a reading
        if self._to_lose == 0 and begins:
            self._to_lose = self._burst
        if self._to_lose == 0:
            return False
        self._to_lose -= 1
        return True


class DelayLine(Generic[T]):
    """Delivers a sensor's readings: takes them when they are due, loses some, hands over the rest late and in order."""

    def __init__(self, hz: float, latency: float = 0.0, dropout: Dropout | None = None) -> None:
        """latency: s, from the moment a reading is valid for."""
        self._due = Due(hz)
        self._latency = latency
        self._dropout = dropout
        self._under_way: deque[tuple[float, T]] = deque()

    def step(self, t: float, take: Callable[[], T]) -> T | None:
        """Reading that arrives at the step at ``t`` [s], if any.

        ``take`` is called for lost ones too, so that the noise does not depend on losses.
        """
        if self._due.at(t):
            reading = take()
            if self._dropout is None or not self._dropout.lost():
                self._under_way.append((t + self._latency - EARLY, reading))
        if self._under_way and t >= self._under_way[0][0]:
            return self._under_way.popleft()[1]
        return None
