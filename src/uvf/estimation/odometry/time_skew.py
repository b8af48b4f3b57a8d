"""By how much the stamps of the scans and those of the odometry are apart, from the turns that both have seen.

A turn that scan matching finds between two stamps is compared with the turn of the odometry between the same stamps, shifted by every
candidate of a grid. The likelihood of the candidates over many turns gives the skew and its standard deviation; what is unlike all
candidates (a wrong match, a wheel that slipped) hardly counts (Student's t: Lange, Little & Taylor, JASA 84, 1989). Only changes of
the turn rate tell anything: a standstill, a straight line and a steady turn look the same at all times.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

REACH, STEP = 1.0, 0.01  # s, the candidates
PRIOR_SIGMA = 0.5  # s
LEAST_CHANGE = 0.01  # rad by which the candidates' turns must differ for a pair of scans to be kept
LEAST_PAIRS = 10
KEPT = 600  # pairs, the newest
RENEWED_AFTER = 0.1  # times as many further pairs
LONGEST = 2.0  # s between two stamps that belong together
FREEDOM = 3.0  # degrees of freedom of Student's t
ROUNDS = 8
FINEST = 0.002  # rad, least 1 sigma of a matched turn
GAIN = (0.7, 1.4)  # how much longer or shorter the odometry's turns may be than the true ones


@dataclass(frozen=True)
class Skew:
    """Time skew [s] between odometry and scans, and its 1 sigma [s].

    The odometry at ``t + seconds`` belongs to the scan stamped ``t``: negative where scans come late.
    """

    seconds: float
    sigma: float


UNKNOWN = Skew(0.0, PRIOR_SIGMA)


class TimeSkew:
    """Estimates the skew from headings of the odometry and matched turns, as they come.

    A turn waits until the odometry is ``REACH`` ahead of it. The odometry's stamps must be its own: a pose that a logger has put beside
    a scan may be older than the scan's stamp. Stamps must rise; what comes with one that does not is left out, a step of more than
    ``LONGEST`` begins a new track.
    """

    def __init__(self) -> None:
        self._offsets: Floats = np.linspace(-REACH, REACH, 2 * round(REACH / STEP) + 1)
        self._times: deque[float] = deque()
        self._headings: deque[float] = deque()
        self._waiting: deque[tuple[float, float, float]] = deque()
        self._turns: deque[float] = deque(maxlen=KEPT)
        self._told: deque[Floats] = deque(maxlen=KEPT)
        self._new = 0
        self._estimate = UNKNOWN

    def add_odometry(self, t: float, heading: float) -> None:
        """Adds a heading [rad] of the base in the odometry's frame, stamped ``t`` [s]."""
        if not (np.isfinite(t) and np.isfinite(heading)):
            return
        if self._times and abs(t - self._times[-1]) > LONGEST:
            self._begin_anew()
        if not self._times:
            self._times.append(t)
            self._headings.append(heading)
        elif t > self._times[-1]:
            self._times.append(t)
            self._headings.append(self._headings[-1] + wrap(heading - self._headings[-1]))
        self._look()

    def add_turn(self, start: float, end: float, turn: float) -> None:
        """Adds the turn [rad] of the base, by matching, from the scan stamped ``start`` [s] to the one stamped ``end`` [s]."""
        if 0.0 < end - start <= LONGEST and np.isfinite(turn):
            self._waiting.append((start, end, wrap(turn)))

    def estimate(self) -> Skew:
        """The skew by the turns so far; ``UNKNOWN`` while these tell nothing."""
        if len(self._turns) >= LEAST_PAIRS and self._new >= RENEWED_AFTER * len(self._turns):
            self._estimate = fit(self._offsets, np.array(self._turns), np.array(self._told))
            self._new = 0
        return self._estimate

    def _begin_anew(self) -> None:
        for track in (self._times, self._headings, self._waiting):
            track.clear()

    def _look(self) -> None:
        """Takes in the turns whose whole surroundings the odometry has seen, and forgets the track before them."""
        while self._waiting and self._waiting[0][1] + REACH <= self._times[-1]:
            start, end, turn = self._waiting.popleft()
            if start - REACH < self._times[0]:
                continue
            times, headings = np.array(self._times), np.array(self._headings)
            told = np.interp(end + self._offsets, times, headings) - np.interp(start + self._offsets, times, headings)
            if np.ptp(told) > LEAST_CHANGE:
                self._turns.append(turn)
                self._told.append(told)
                self._new += 1
        begin = self._times[-1] - 2 * (REACH + LONGEST)
        while len(self._times) > 2 and self._times[1] < begin:
            self._times.popleft()
            self._headings.popleft()


def fit(offsets: Floats, turns: Floats, told: Floats) -> Skew:
    """The mean and deviation of the skew's posterior, with the odometry's gain and the noise found by expectation maximisation.

    offsets: (m,) s, candidates; turns: (n,) rad, matched; told: (n, m) rad, by the odometry at each candidate.
    """
    gain, best = 1.0, int(np.argmin(np.median(np.abs(turns[:, None] - told), axis=0)))
    squared = np.square(turns[:, None] - told)
    variance = max(float(np.median(squared[:, best])), FINEST**2)
    cost = np.zeros(len(offsets))
    for _ in range(ROUNDS):
        squared = np.square(turns[:, None] - gain * told)
        cost = (FREEDOM + 1) / 2 * np.log1p(squared / (FREEDOM * variance)).sum(axis=0) + (offsets / PRIOR_SIGMA) ** 2 / 2
        best = int(np.argmin(cost))
        weights = (FREEDOM + 1) / (FREEDOM + squared[:, best] / variance)
        variance = max(float(np.mean(weights * squared[:, best])), FINEST**2)
        energy = float(weights @ np.square(told[:, best]))
        gain = float(np.clip(weights @ (turns * told[:, best]) / max(energy, 1e-9), *GAIN))
    chance = np.exp(cost.min() - cost)
    chance /= chance.sum()
    mean = float(chance @ offsets)
    return Skew(mean, float(np.sqrt(chance @ np.square(offsets - mean) + (STEP / 2) ** 2)))
