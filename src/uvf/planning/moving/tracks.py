"""Things that move, followed from scan to scan: a Kalman filter of constant velocity for each (Bar-Shalom, Li, Kirubarajan 2001, 6.3)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from uvf.planning.moving.clusters import discs_of, labels_of

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class TrackSettings:
    """What counts as a thing that moves."""

    widest: float = 1.6  # m, wider things are walls
    acceleration: float = 1.5  # m/s^2, 1 sigma of what a thing may do
    position_noise: float = 0.06  # m, 1 sigma of a disc's centre
    gate: float = 0.9  # m from where a thing is expected to where it is looked for
    least_speed: float = 0.25  # m/s, slower ones stand
    certainty: float = 2.5  # times its own standard deviation that a speed must have
    least_hits: int = 4  # scans until it is believed
    coast: float = 0.6  # s that a thing is kept without being seen
    farthest: float = 10.0  # m


@dataclass
class Track:
    """One thing: x, y [m], vx, vy [m/s], their covariance, and its radius [m]."""

    state: Floats
    covariance: Floats
    radius: float
    seen: float  # s
    hits: int = 1
    born: Floats = field(default_factory=lambda: np.zeros(2))

    def is_moving(self, settings: TrackSettings) -> bool:
        """Whether its speed is large enough, and sure enough, and has brought it somewhere."""
        speed = float(np.hypot(self.state[2], self.state[3]))
        if self.hits < settings.least_hits or speed < settings.least_speed:
            return False
        along = self.state[2:] / speed
        deviation = float(np.sqrt(along @ self.covariance[2:, 2:] @ along))
        travelled = float(np.hypot(*(self.state[:2] - self.born)))
        return speed > settings.certainty * deviation and travelled > 0.5 * settings.position_noise + 0.08


class MovingObjects:
    """Follows what moves; all in one frame that does not jump (odom)."""

    def __init__(self, settings: TrackSettings | None = None) -> None:
        self.settings = settings or TrackSettings()
        self.tracks: list[Track] = []
        self._t: float | None = None

    def observe(self, t: float, eye: tuple[float, float], points: Floats, ranges: Floats) -> Mask:
        """Takes a scan at ``t`` [s]: points (n, 2) [m] in the order of the beams, ranges (n,) [m], 0 = none, from ``eye`` [m].

        Returns the mask (n,) of beams that see something which moves. A scan that is older than the last is passed over.
        """
        settings = self.settings
        if self._t is not None and t <= self._t:
            return np.zeros(len(ranges), dtype=np.bool_)
        self._predict(0.0 if self._t is None else t - self._t)
        self._t = t
        used = np.where(ranges <= settings.farthest, ranges, 0.0)
        labels = labels_of(points, used)
        discs = discs_of(points, labels, eye, settings.widest)
        matched = self._match(discs)
        moving = np.zeros(len(discs) and int(discs[:, 3].max()) + 1, dtype=np.bool_)
        for k, disc in enumerate(discs):
            track = matched.get(k)
            if track is None:
                self._begin(t, disc)
                continue
            self._correct(track, disc, t)
            moving[int(disc[3])] = track.is_moving(settings)
        self.tracks = [track for track in self.tracks if t - track.seen <= settings.coast]
        known = (labels >= 0) & (labels < len(moving))
        mask = np.zeros(len(ranges), dtype=np.bool_)
        mask[known] = moving[labels[known]]
        return mask

    def moving(self) -> Floats:
        """(m, 5) x, y [m], vx, vy [m/s], radius [m] of what moves, now."""
        rows = [(*track.state, track.radius) for track in self.tracks if track.is_moving(self.settings)]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)

    def _predict(self, dt: float) -> None:
        step = np.eye(4)
        step[0, 2] = step[1, 3] = dt
        spread = np.array(((dt**4 / 4, dt**3 / 2), (dt**3 / 2, dt**2))) * self.settings.acceleration**2
        noise = np.kron(spread, np.eye(2))
        for track in self.tracks:
            track.state = step @ track.state
            track.covariance = step @ track.covariance @ step.T + noise

    def _match(self, discs: Floats) -> dict[int, Track]:
        if not len(discs) or not self.tracks:
            return {}
        expected = np.array([track.state[:2] for track in self.tracks])
        distance = np.hypot(discs[:, None, 0] - expected[:, 0], discs[:, None, 1] - expected[:, 1])
        cost = np.minimum(distance, 10.0 * self.settings.gate)
        rows, columns = linear_sum_assignment(cost)
        return {
            int(r): self.tracks[int(c)] for r, c in zip(rows, columns, strict=True) if distance[r, c] <= self._gate(self.tracks[int(c)])
        }

    def _gate(self, track: Track) -> float:
        """m; a thing that has been followed for a while is known better."""
        deviation = float(np.sqrt(max(track.covariance[0, 0], track.covariance[1, 1]) + self.settings.position_noise**2))
        return min(self.settings.gate, 4.0 * deviation)

    def _begin(self, t: float, disc: Floats) -> None:
        r = self.settings.position_noise**2
        covariance = np.diag((r, r, 2.0**2, 2.0**2))
        self.tracks.append(Track(np.array((disc[0], disc[1], 0.0, 0.0)), covariance, float(disc[2]), t, born=disc[:2].copy()))

    def _correct(self, track: Track, disc: Floats, t: float) -> None:
        r = self.settings.position_noise**2 * np.eye(2)
        gain = track.covariance[:, :2] @ np.linalg.inv(track.covariance[:2, :2] + r)
        track.state = track.state + gain @ (disc[:2] - track.state[:2])
        track.covariance = track.covariance - gain @ track.covariance[:2, :]
        track.radius += 0.3 * (float(disc[2]) - track.radius)
        track.seen = t
        track.hits += 1
