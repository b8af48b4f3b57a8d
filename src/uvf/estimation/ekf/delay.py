"""Where it has been: satellite fixes and pressures are compared with the state of the moment they were taken, not of that they come."""

from collections import deque
from typing import NamedTuple

import numpy as np

from uvf.estimation.ekf.states import POSITION, VELOCITY, Floats

KEPT = 1.5  # s, more than the oldest fix that is taken


class _Past(NamedTuple):
    t: float
    motion: Floats  # (6,) velocity, position
    corrected: Floats  # (6,) all corrections up to then


class Delay:
    """Velocity and position of the last moments; what has been corrected since then was wrong then already."""

    def __init__(self) -> None:
        self._past: deque[_Past] = deque()
        self._corrected: Floats = np.zeros(6)

    def keep(self, t: float, x: Floats) -> None:
        """Stores velocity and position of the states ``x`` (25,) at ``t`` [s]."""
        self._past.append(_Past(t, x[VELOCITY.start : POSITION.stop].copy(), self._corrected))
        while t - self._past[0].t > KEPT:
            self._past.popleft()

    def correct(self, before: Floats, x: Floats) -> None:
        """Notes that a measurement, not time, has changed the states (25,) from ``before`` to ``x``."""
        self._corrected = self._corrected + (x - before)[VELOCITY.start : POSITION.stop]

    def at(self, t: float) -> tuple[Floats, Floats]:
        """Velocity (3,) [m/s] and position (3,) [m], NED, at ``t`` [s] as they are known now; interpolated linearly."""
        later = self._past[-1]
        for past in reversed(self._past):
            if past.t <= t:
                share = (t - past.t) / (later.t - past.t) if later.t > past.t else 0.0
                motion = self._now(past) + share * (self._now(later) - self._now(past))
                return motion[:3], motion[3:]
            later = past
        motion = self._now(later)
        return motion[:3], motion[3:]

    def _now(self, past: _Past) -> Floats:
        motion: Floats = past.motion + self._corrected - past.corrected
        return motion

    def clear(self) -> None:
        """Forgets the past: the states have been set anew."""
        self._past.clear()
