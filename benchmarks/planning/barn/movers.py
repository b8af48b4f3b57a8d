"""Discs that move by keyframes over and over, as the obstacles of DynaBARN (Nair et al. 2022).

Between two keys the path is a cubic Hermite spline. Gazebo's, a Catmull-Rom spline, has the tangent (p[i+1] - p[i-1]) / 2 in a
key and the one-sided half difference at an end, whatever the times of the keys are; with "linear" it is the straight line.
At the end of the period a disc is back at its first key.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]
Interpolation = Literal["catmull-rom", "linear"]


@dataclass(frozen=True)
class Track:
    """One disc's motion: radius [m], period [s], keys (k, 3) t [s], x, y [m]; t rises from 0 to at most the period."""

    radius: float
    period: float
    keys: Floats


@dataclass(frozen=True)
class Movers:
    """Moving discs, packed: discs (n, 2) radius [m], period [s]; legs (m, 10) t [s], duration [s], ends and tangents x, y [m].

    first: (n + 1,) index of each disc's first leg.
    """

    discs: Floats
    legs: Floats
    first: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.discs)

    def at(self, t: float) -> Floats:
        """(n, 3) x, y, radius [m] at ``t`` [s] since the animation began; before that too, it is periodic."""
        out = np.empty((len(self.discs), 3))
        _at(t, self.discs, self.legs, self.first, out)
        return out


def movers_of(tracks: Sequence[Track], interpolation: Interpolation = "catmull-rom") -> Movers:
    """Packs tracks. Raises ValueError, naming the track by its number, for one that is no motion."""
    discs, legs, first = [], [np.zeros((0, 10))], [0]
    for i, track in enumerate(tracks):
        if fault := _fault(track):
            raise ValueError(f"obstacle {i}: {fault}")
        discs.append((track.radius, track.period))
        legs.append(_legs(track, interpolation))
        first.append(first[-1] + len(legs[-1]))
    return Movers(np.array(discs, dtype=np.float64).reshape(-1, 2), np.concatenate(legs), np.array(first, dtype=np.int64))


def _fault(track: Track) -> str:
    keys = track.keys
    if keys.ndim != 2 or keys.shape[1] != 3 or len(keys) < 2 or not np.isfinite(keys).all():
        return "keyframes must be two or more rows of finite t [s], x, y [m]"
    if keys[0, 0] != 0.0 or not (np.diff(keys[:, 0]) > 0.0).all():
        return "times of keyframes must rise from 0 s"
    if not 0.0 < track.radius < np.inf:
        return f"radius is {track.radius}; it must be above 0 m"
    if not keys[-1, 0] <= track.period < np.inf:
        return f"period is {track.period}; it must be at least the last keyframe's time, {keys[-1, 0]} s"
    return ""


def _legs(track: Track, interpolation: Interpolation) -> Floats:
    t, p = track.keys[:, 0], track.keys[:, 1:]
    if interpolation == "linear":
        begin = end = np.diff(p, axis=0)
    else:
        tangents = np.gradient(p, axis=0)
        tangents[[0, -1]] *= 0.5
        if (p[0] == p[-1]).all():
            tangents[[0, -1]] = (p[1] - p[-2]) / 2
        begin, end = tangents[:-1], tangents[1:]
    return np.column_stack((t[:-1], np.diff(t), p[:-1], p[1:], begin, end))


@compiled
def _at(t: float, discs: Floats, legs: Floats, first: NDArray[np.int64], out: Floats) -> None:
    """After the last key a disc waits there until the period is over."""
    for i in range(discs.shape[0]):
        time = t % discs[i, 1]
        leg = first[i]
        while leg + 1 < first[i + 1] and legs[leg + 1, 0] <= time:
            leg += 1
        s = min((time - legs[leg, 0]) / legs[leg, 1], 1.0)
        a, b = (1 + 2 * s) * (1 - s) ** 2, s * s * (3 - 2 * s)
        c, d = s * (1 - s) ** 2, s * s * (s - 1)
        for k in range(2):
            out[i, k] = a * legs[leg, 2 + k] + b * legs[leg, 4 + k] + c * legs[leg, 6 + k] + d * legs[leg, 8 + k]
        out[i, 2] = discs[i, 0]


NO_MOVERS = movers_of(())
