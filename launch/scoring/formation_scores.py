"""How well a formation was flown, from the truth: how near two aircraft came, and how far a follower was from its station."""

import numpy as np
from numpy.typing import NDArray

from uvf.models.mission.formation import Follow

Floats = NDArray[np.float64]

JOINING = 20.0  # s at the beginning, in which stations are taken up
PACE_OVER = 20.0  # s, over which the leader's airspeed is averaged
REACH = 10.0  # s, each way of the station: where on the leader's track a follower may be
SAMPLES = 0.1  # s


def separation(own: Floats, other: Floats) -> tuple[float, float]:
    """Least distance [m] between two aircraft, each (n, >= 4): t [s], x, y, z [m, world], and when [s]; infinite where they never met."""
    begin, end = max(own[0, 0], other[0, 0]), min(own[-1, 0], other[-1, 0])
    t = own[(own[:, 0] >= begin) & (own[:, 0] <= end), 0]
    if not len(t):
        return float("inf"), begin
    apart = np.linalg.norm(_at(own, t)[:, :3] - _at(other, t)[:, :3], axis=1)
    return float(apart.min()), float(t[apart.argmin()])


def station_errors(own: Floats, leader: Floats, follow: Follow) -> Floats:
    """Errors of the formation slot, (k, 4): t [s] and m late, right and above, every ``SAMPLES`` from ``JOINING`` on.

    own, leader: (n, 5) t [s], x, y, z [m, world], true airspeed [m/s]. The slot is where the leader was as long ago as it takes it, at
    its mean airspeed, to fly ``behind``. Late is measured over ground along the leader's track, from the point of it abeam of the follower.
    """
    begin = max(own[0, 0], leader[0, 0]) + JOINING
    times = np.arange(begin, min(own[-1, 0], leader[-1, 0]), SAMPLES)
    track_t = np.arange(leader[0, 0], leader[-1, 0], SAMPLES)
    track = _at(leader, track_t)[:, :3]
    here = _at(own, times)[:, :3]
    flown = np.concatenate(((0.0,), np.cumsum(np.diff(leader[:, 0]) * leader[1:, 4])))
    rows = []
    for t, p in zip(times, here, strict=True):
        since = max(t - PACE_OVER, leader[0, 0])
        pace = float(np.interp(t, leader[:, 0], flown) - np.interp(since, leader[:, 0], flown)) / (t - since)
        rows.append((t, *_off(p, t - follow.behind / pace, (track_t, track), follow)))
    return np.array(rows).reshape(-1, 4)


def _off(here: Floats, due: float, track: tuple[Floats, Floats], follow: Follow) -> tuple[float, float, float]:
    """m late, right and above; ``due`` [s]: when the leader was at the station."""
    t, points = track
    k = np.flatnonzero(np.abs(t[:-1] - due) < REACH)
    steps = points[k + 1, :2] - points[k, :2]
    lengths = np.maximum(np.linalg.norm(steps, axis=1), 1e-6)
    along = steps / lengths[:, None]
    right = np.column_stack((along[:, 1], -along[:, 0]))
    away = here[:2] - points[k, :2] - follow.right * right
    nearest = int(np.argmin(np.einsum("ij,ij->i", away, away)))
    ahead, aside = float(away[nearest] @ along[nearest]), float(away[nearest] @ right[nearest])
    ways = np.concatenate(((0.0,), np.cumsum(lengths)))
    late = float(np.interp(due, t[k], ways[:-1])) - ways[nearest] - ahead
    return late, aside, float(here[2] - points[k[nearest], 2] - follow.above)


def _at(rows: Floats, t: Floats) -> Floats:
    """(k, columns) without the time, interpolated."""
    return np.array([np.interp(t, rows[:, 0], column) for column in rows[:, 1:].T]).T
