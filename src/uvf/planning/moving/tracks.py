"""Things that move, followed from scan to scan: a Kalman filter of constant velocity for each (Bar-Shalom, Li, Kirubarajan 2001, 6.3)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from uvf.planning.moving.circles import find_circle
from uvf.planning.moving.clusters import HIDDEN, LABEL, RADIUS, ROUGH, ROUND_POINTS, SPREAD, VAGUE, discs_of, labels_of, part_new, widths_of

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Point = tuple[float, float]

NEVER = 1e6
FIRST_SPEED = 2.0  # m/s, 1 sigma of what is seen for the first time
FRESH = 0.3  # weight of the last scan
SURE = 0.7
PART = 0.4  # of a thing's points
BESIDE = 0.15
"""m beyond the radius of a thing that moves, within which what is seen is part of it."""


@dataclass(frozen=True)
class TrackSettings:
    """What counts as a thing that moves."""

    widest: float = 1.6  # m, wider things are walls
    acceleration: float = 3.0  # m/s^2, 1 sigma of what a thing may do
    position_noise: float = 0.02  # m, 1 sigma of the centre of a disc that is seen whole
    round_noise: float = 0.01  # m, the same of what is round, besides that of its fit
    hidden_noise: float = 0.3  # m, the same of one that something covers in part
    gate: float = 1.0  # m from where a thing is expected, within which it is looked for
    least_speed: float = 0.2  # m/s, slower ones stand
    certainty: float = 2.0  # times its own standard deviation that a speed must have
    least_way: float = 0.1  # m that a thing must have gone until it is believed to move
    sure_way: float = 0.3  # m that a thing must have gone to be believed though it is slow
    rest: float = 0.5  # s for which something round that moved must be slower to stand
    least_hits: int = 3  # scans that show it whole until it is believed
    round_speed: float = 0.4  # m/s from which on what is round is believed to move by its middle alone
    round_certainty: float = 4.0  # times its own standard deviation that this speed must have
    lost: float = 0.3  # m from where something round is expected, within which its circle is sought
    sought: float = 0.3  # s without being seen for which it is
    coast: float = 0.3  # s that a thing is kept where it should be seen and is not
    coast_hidden: float = 2.0  # s that it is kept where it cannot be seen
    farthest: float = 20.0  # m


@dataclass(frozen=True)
class SeenFrom:
    """Where a scan was taken, and which of its points (n,) lie on ground that was free just before: something has come there."""

    eye: Point
    entered: Mask


@dataclass
class Track:
    """One thing: x, y [m], vx, vy [m/s], their covariance, and its radius [m]."""

    state: Floats
    covariance: Floats
    radius: float
    born: Floats
    """(2,) m, where it was first seen whole, or at all."""
    whole: int = 0
    """How often nothing covered a part of it; the visible part of a wall between two other things wanders along with the vehicle."""
    entered: float = 0.0
    """Share [0..1] of the last scans in which it stood on ground that had been free."""
    round: int = 0
    """How often it was seen to be round."""
    hits: int = 1
    unseen: float = 0.0  # s, in view without being seen
    hidden: float = 0.0  # s, out of view
    moves: bool = False
    """Whether it was found to move when it was last seen."""
    moved: bool = False
    """Whether it ever was."""
    stood: float = 0.0  # s, since when it moves and is too slow for it

    def judge(self, settings: TrackSettings) -> None:
        """Finds whether it moves: its speed is large enough, and has brought it somewhere; at first it must be sure enough too.

        The middle of what comes into view bit by bit moves as well; but it does not come onto ground that was free.
        """
        speed = float(np.hypot(self.state[2], self.state[3]))
        is_round = self.round >= settings.least_hits
        may_rest = self.moves and is_round and self.stood <= settings.rest
        if self.whole < settings.least_hits or (speed < settings.least_speed and not may_rest):
            self.moves = False
        elif not self.moves and (self.entered >= SURE or is_round):
            along = self.state[2:] / speed
            deviation = float(np.sqrt(along @ self.covariance[2:, 2:] @ along))
            gone = float(np.hypot(*(self.state[:2] - self.born)))
            if self.entered >= SURE:
                sure = speed > settings.certainty * deviation or gone > settings.sure_way
            else:
                least = settings.least_speed if self.moved else settings.round_speed
                sure = speed > max(settings.round_certainty * deviation, least)
            self.moves = sure and gone > settings.least_way
            if self.moves:
                self.moved, self.stood = True, 0.0

    def go_on(self, dt: float, settings: TrackSettings) -> None:
        """Remembers for how long it has stood, ``dt`` [s] after the last time: what turns round is slow for a moment, and moves on."""
        self.stood = 0.0 if np.hypot(self.state[2], self.state[3]) >= settings.least_speed else self.stood + dt


@dataclass
class MovingObjects:
    """Follows what moves; all in one frame that does not jump (odom)."""

    settings: TrackSettings = field(default_factory=TrackSettings)
    tracks: list[Track] = field(default_factory=list)
    _t: float | None = None

    def observe(self, t: float, points: Floats, ranges: Floats, seen_from: SeenFrom) -> Mask:
        """Takes a scan at ``t`` [s]: points (n, 2) [m] in the order of the beams, ranges (n,) [m], 0 = none.

        Returns the mask (n,) of beams that see something which moves. A scan that is no newer than the last is passed over.
        """
        if self._t is not None and t <= self._t:
            return np.zeros(len(ranges), dtype=np.bool_)
        eye = seen_from.eye
        dt, self._t = (0.0 if self._t is None else t - self._t), t
        self._predict(dt)
        seen = np.where(ranges <= self.settings.farthest, ranges, 0.0)
        followed, mask = self._follow_round(points, seen, eye)
        labels = labels_of(points, np.where(mask, 0.0, seen))
        walls = int(labels.max(initial=-1)) + 1
        part_new(labels, widths_of(points, labels, walls) > self.settings.widest, seen_from.entered)
        count = int(labels.max(initial=-1)) + 1
        discs = discs_of(points, seen, labels, eye)
        thing = discs[:, LABEL].astype(np.int64)
        discs = discs[(widths_of(points, labels, count)[thing] <= self.settings.widest) & ((thing < walls) | (discs[:, SPREAD] > 0.0))]
        matched = self._match(discs, [track for track in self.tracks if id(track) not in followed])
        found = followed | {id(track) for track in matched.values()}
        self._age(dt, [track for track in self.tracks if id(track) not in found], (eye, points, seen))
        moving = np.zeros(count, dtype=np.bool_)
        entered = np.bincount(labels[labels >= 0], seen_from.entered[labels >= 0], count) / np.maximum(
            np.bincount(labels[labels >= 0], minlength=count), 1
        )
        for k, disc in enumerate(discs):
            if (track := matched.get(k)) is None:
                self.tracks.append(self._begin(disc))
                continue
            self._correct(track, disc)
            track.entered += FRESH * (float(entered[int(disc[LABEL])] >= PART) - track.entered)
            if track.moves or not disc[HIDDEN]:
                track.judge(self.settings)
            moving[int(disc[LABEL])] = track.moves
        for track in self.tracks:
            track.go_on(dt, self.settings)
        mask[labels >= 0] = moving[labels[labels >= 0]]
        for x, y, _, _, radius in self.moving():  # parts of them that count as other things, or as parts of such
            mask |= (ranges > 0.0) & ((points[:, 0] - x) ** 2 + (points[:, 1] - y) ** 2 < (radius + BESIDE) ** 2)
        return mask

    def _follow_round(self, points: Floats, ranges: Floats, eye: Point) -> tuple[set[int], Mask]:
        """Finds the round things that move where they are expected, whatever they touch or is before them, the nearest ones first.

        Returns the identities of their tracks and the mask (n,) of the beams that see them.
        """
        s, free, found = self.settings, ranges.copy(), set()
        known = [track for track in self.tracks if track.moves and track.round >= s.least_hits and track.hidden + track.unseen <= s.sought]
        for track in sorted(known, key=lambda k: float(np.hypot(k.state[0] - eye[0], k.state[1] - eye[1]))):
            x, y = track.state[:2].tolist()
            own: Mask = np.zeros(len(ranges), dtype=np.bool_)
            at = find_circle(points, free, eye, (x, y, track.radius), own)
            if at[5] < ROUND_POINTS or at[3] > ROUGH or at[4] > VAGUE or np.hypot(at[0] - x, at[1] - y) > s.lost:
                continue
            self._update(track, np.array(at[:2]), float(np.hypot(s.round_noise, at[4])))
            track.judge(s)
            free[own] = 0.0
            found.add(id(track))
        return found, (free != ranges)

    def moving(self) -> Floats:
        """(m, 5) x, y [m], vx, vy [m/s], radius [m] of what moves, now."""
        rows = [(*track.state, track.radius) for track in self.tracks if track.moves]
        return np.array(rows, dtype=np.float64).reshape(-1, 5)

    def _predict(self, dt: float) -> None:
        step = np.eye(4)
        step[0, 2] = step[1, 3] = dt
        spread = np.array(((dt**4 / 4, dt**3 / 2), (dt**3 / 2, dt**2))) * self.settings.acceleration**2
        noise = np.kron(spread, np.eye(2))
        for track in self.tracks:
            track.state = step @ track.state
            track.covariance = step @ track.covariance @ step.T + noise

    def _match(self, discs: Floats, tracks: list[Track]) -> dict[int, Track]:
        """Discs to tracks, by the least sum of squared Mahalanobis distances within the gate."""
        if not len(discs) or not tracks:
            return {}
        offset = discs[:, None, :2] - np.array([track.state[:2] for track in tracks])
        spread = np.array([track.covariance[:2, :2] for track in tracks])
        noise = np.array([self._noise(disc) for disc in discs])[:, None] ** 2
        xx, yy, xy = spread[:, 0, 0] + noise, spread[:, 1, 1] + noise, spread[:, 0, 1]
        determinant = xx * yy - xy**2
        dx, dy = offset[..., 0], offset[..., 1]
        cost = (yy * dx**2 - 2.0 * xy * dx * dy + xx * dy**2) / determinant + np.log(determinant / 1e-4)
        cost[np.hypot(dx, dy) > np.minimum(self.settings.gate, 4.0 * np.sqrt(xx + yy))] = NEVER
        pairs = zip(*linear_sum_assignment(cost), strict=True)
        return {int(k): tracks[int(j)] for k, j in pairs if cost[k, j] < NEVER}

    def _noise(self, disc: Floats) -> float:
        """1 sigma [m] of a disc's middle."""
        s = self.settings
        if disc[SPREAD] > 0.0:
            return float(np.hypot(s.round_noise, disc[SPREAD]))
        return s.hidden_noise if disc[HIDDEN] else s.position_noise

    def _begin(self, disc: Floats) -> Track:
        """A track that begins with a disc."""
        place = self._noise(disc) ** 2
        covariance = np.diag((place, place, FIRST_SPEED**2, FIRST_SPEED**2))
        whole, is_round = int(not disc[HIDDEN]), int(disc[SPREAD] > 0.0)
        return Track(np.array((disc[0], disc[1], 0.0, 0.0)), covariance, float(disc[RADIUS]), disc[:2].copy(), whole, round=is_round)

    def _correct(self, track: Track, disc: Floats) -> None:
        """Kalman update. What is seen whole for the first time begins anew: the middle of its visible part was not its own."""
        if not disc[HIDDEN] and not track.whole:
            begun = self._begin(disc)
            track.state, track.covariance, track.radius, track.born = begun.state, begun.covariance, begun.radius, begun.born
        self._update(track, disc[:2], self._noise(disc))
        if not disc[HIDDEN]:
            track.radius += 0.3 * (float(disc[RADIUS]) - track.radius)
            track.whole += 1
        track.round = track.round + 1 if disc[SPREAD] > 0.0 else 0

    def _update(self, track: Track, place: Floats, sigma: float) -> None:
        """Takes a measured place (2,) [m] and its 1 sigma [m]."""
        gain = track.covariance[:, :2] @ np.linalg.inv(track.covariance[:2, :2] + sigma**2 * np.eye(2))
        track.state = track.state + gain @ (place - track.state[:2])
        track.covariance = track.covariance - gain @ track.covariance[:2, :]
        track.hits, track.unseen, track.hidden = track.hits + 1, 0.0, 0.0

    def _age(self, dt: float, missed: list[Track], scan: tuple[Point, Floats, Floats]) -> None:
        """Drops tracks that have not been seen for too long: soon where they should be seen, later where they cannot be."""
        for track in missed:
            if _passes(track.state[:2], track.radius, *scan):
                track.unseen += dt
            else:
                track.hidden += dt
        limits = self.settings
        kept = [k for k in self.tracks if k.unseen <= limits.coast and k.hidden <= limits.coast_hidden]
        self.tracks = [k for k in kept if k.hits > 1 or not k.hidden]


def _passes(place: Floats, radius: float, eye: Point, points: Floats, ranges: Floats) -> bool:
    """Whether a beam passes the middle of a disc at ``place`` (2,) [m] of ``radius`` [m], and ends behind it."""
    dx, dy = place[0] - eye[0], place[1] - eye[1]
    distance = float(np.hypot(dx, dy))
    along, across = (points[:, 0] - eye[0]) * dx + (points[:, 1] - eye[1]) * dy, (points[:, 1] - eye[1]) * dx - (points[:, 0] - eye[0]) * dy
    aimed = (along > 0.0) & (np.abs(across) <= 0.5 * radius / max(distance, 1e-6) * along)
    return bool((aimed & ((ranges <= 0.0) | (ranges > distance + radius))).any())
