"""Elastic band (Quinlan, Khatib 1993): the path as bubbles of free space that contract it and are pushed off by obstacles."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.grids import distance_field
from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.local.planner import Limits, LocalSituation
from uvf.planning.local.regulated_pure_pursuit import RegulatedPurePursuit, RppSettings
from uvf.planning.local.window import Grids
from uvf.planning.smoothing import resample

Floats = NDArray[np.float64]

MOST = 256  # bubbles
LEAST = 0.02  # m, radius that a smaller bubble counts as having, when it moves and where two must overlap
OVERLAP = 0.9
"""Share of the sum of two radii within which neighbours must lie."""
NEAR = 0.5  # m from the vehicle within which a bubble that lies behind is passed
LEAP = 0.3
"""Share of its radius that a bubble moves by at most in one round."""


class FreeRoom(NamedTuple):
    """How much room there is in the window."""

    distance: Floats
    """(rows, columns) cells to the nearest occupied one, from centre to centre."""
    frame: tuple[float, float, float]
    """x, y [m] of the corner of cell [0, 0], resolution [m]."""
    inscribed: float  # m, radius of the footprint


class ElasticBandSettings(NamedTuple):
    """The band's forces, under the names of eband_local_planner where it has them."""

    internal_force_gain: float = 0.3
    external_force_gain: float = 2.0  # 1/m
    obstacle_reach: float = 0.35  # m beyond the inscribed radius, up to which obstacles push
    largest_bubble: float = 0.6  # m
    rounds: int = 12  # of forces in a control period


class ElasticBand:
    """Keeps a band from the vehicle along the path to the window's border, and follows it by pure pursuit.

    The band is kept while the path stays the same, so that what moves in is moved round; a new path lays it anew.
    """

    def __init__(self, limits: Limits, footprint: RobotFootprint, settings: ElasticBandSettings) -> None:
        self.settings = settings
        self._inscribed = footprint.inscribed_radius
        self._follower = RegulatedPurePursuit(limits, footprint, RppSettings())
        self._given: Floats = np.zeros((0, 2))
        self._path: Floats = np.zeros((0, 2))
        self._laid = 0  # points of the path that the band has covered
        self._bubbles = np.empty((MOST, 3))
        self._count = 0

    def reset(self) -> None:
        """Forgets the band."""
        self._given, self._laid, self._count = np.zeros((0, 2)), 0, 0
        self._follower.reset()

    @property
    def bubbles(self) -> Floats:
        """(n, 3) x, y [m] and radius [m] of the band's bubbles, from the vehicle on; the radius is beyond the inscribed one."""
        return self._bubbles[: self._count].copy()

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where the band is broken: obstacles leave no way beside the path, or its arc touches."""
        occupied = now.grids.values == LETHAL
        room = FreeRoom(distance_field(occupied), now.grids.frame, self._inscribed)
        if not np.array_equal(now.path, self._given):
            self._begin(now.path)
        whole = self._relaxed(now, room)
        if not whole and self._laid:  # deformed too far: once more from the path as it was given
            self._begin(now.path)
            whole = self._relaxed(now, room)
        if not whole:
            self.reset()
            return None
        rest = self._path[self._laid :]
        band = np.concatenate((self._bubbles[: self._count, :2], rest))
        return self._follower.command(replace(now, path=band))

    def _begin(self, path: Floats) -> None:
        self._given, self._path = path.copy(), resample(path)
        self._laid, self._count = 0, 0

    def _relaxed(self, now: LocalSituation, room: FreeRoom) -> bool:
        """Moves the band on with the vehicle and lets its forces work; False where it is broken."""
        state = now.state
        if self._count == 0:
            self._count = 1
            nearest = int(np.argmin(np.hypot(self._path[:, 0] - state.x, self._path[:, 1] - state.y)))
            self._laid = min(nearest + 1, len(self._path) - 1)
        self._bubbles[0] = state.x, state.y, 0.0
        self._extend(now.grids)
        self._count = relaxed(self._bubbles, self._count, room, self.settings)
        return is_whole(self._bubbles[: self._count])

    def _extend(self, grids: Grids) -> None:
        """Bubbles for the next points of the path up to where it leaves the window."""
        x0, y0, resolution = grids.frame
        rows, columns = grids.values.shape
        while self._laid < len(self._path) and self._count < MOST:
            x, y = self._path[self._laid]
            if not (x0 <= x < x0 + columns * resolution and y0 <= y < y0 + rows * resolution):
                return
            self._bubbles[self._count] = x, y, 0.0
            self._count, self._laid = self._count + 1, self._laid + 1


@compiled
def room_at(room: FreeRoom, x: float, y: float) -> float:
    """Distance [m] that the inscribed circle at (x, y) has to the nearest obstacle, between the cells' centres linearly."""
    rows, columns = room.distance.shape
    u = min(max((x - room.frame[0]) / room.frame[2] - 0.5, 0.0), columns - 1.000001)
    v = min(max((y - room.frame[1]) / room.frame[2] - 0.5, 0.0), rows - 1.000001)
    c, r = int(u), int(v)
    u, v = u - c, v - r
    below = room.distance[r, c] * (1.0 - u) + room.distance[r, c + 1] * u
    above = room.distance[r + 1, c] * (1.0 - u) + room.distance[r + 1, c + 1] * u
    found: float = (below * (1.0 - v) + above * v) * room.frame[2] - room.inscribed
    return found


@compiled
def relaxed(bubbles: Floats, count: int, room: FreeRoom, settings: ElasticBandSettings) -> int:
    """Lets the forces move the first ``count`` of the bubbles (n, 3), removes and adds some, in place; how many there are then."""
    for i in range(count):
        bubbles[i, 2] = min(room_at(room, bubbles[i, 0], bubbles[i, 1]), settings.largest_bubble)
    while count > 2 and _is_passed(bubbles):
        count = _without(bubbles, count, 1)
    for _ in range(settings.rounds):
        for i in range(1, count - 1):
            _move(bubbles, i, room, settings)
        i = 1
        while i < count - 1:  # those whose neighbours overlap are not needed
            if _overlap(bubbles, i - 1, i + 1):
                count = _without(bubbles, count, i)
            else:
                i += 1
        i = 0
        while i < count - 1 and count < bubbles.shape[0]:
            if not _overlap(bubbles, i, i + 1):
                for k in range(count, i + 1, -1):
                    bubbles[k] = bubbles[k - 1]
                x, y = 0.5 * (bubbles[i, 0] + bubbles[i + 2, 0]), 0.5 * (bubbles[i, 1] + bubbles[i + 2, 1])
                bubbles[i + 1, 0], bubbles[i + 1, 1] = x, y
                bubbles[i + 1, 2] = min(room_at(room, x, y), settings.largest_bubble)
                count += 1
                i += 1
            i += 1
    return count


@compiled
def _move(bubbles: Floats, i: int, room: FreeRoom, settings: ElasticBandSettings) -> None:
    """One bubble by the contraction of the band and the push of obstacles, across the band only (equations 2 to 6)."""
    x, y, radius = bubbles[i, 0], bubbles[i, 1], bubbles[i, 2]
    fx, fy = 0.0, 0.0
    for k in (i - 1, i + 1):
        dx, dy = bubbles[k, 0] - x, bubbles[k, 1] - y
        apart = np.hypot(dx, dy)
        if apart > 1e-9:
            fx += settings.internal_force_gain * dx / apart
            fy += settings.internal_force_gain * dy / apart
    if radius < settings.obstacle_reach:
        h = 0.5 * room.frame[2]
        push = settings.external_force_gain * (settings.obstacle_reach - radius) / (2.0 * h)
        fx += push * (room_at(room, x + h, y) - room_at(room, x - h, y))
        fy += push * (room_at(room, x, y + h) - room_at(room, x, y - h))
    along_x, along_y = bubbles[i + 1, 0] - bubbles[i - 1, 0], bubbles[i + 1, 1] - bubbles[i - 1, 1]
    squared = along_x * along_x + along_y * along_y
    if squared > 1e-12:
        share = (fx * along_x + fy * along_y) / squared
        fx, fy = fx - share * along_x, fy - share * along_y
    force, size = np.hypot(fx, fy), max(radius, LEAST)
    if not force > 1e-9:
        return
    step = min(force, LEAP) * size / force
    moved = min(room_at(room, x + step * fx, y + step * fy), settings.largest_bubble)
    if moved >= min(radius, LEAST):
        bubbles[i, 0], bubbles[i, 1], bubbles[i, 2] = x + step * fx, y + step * fy, moved


@compiled
def _overlap(bubbles: Floats, i: int, k: int) -> bool:
    apart = np.hypot(bubbles[i, 0] - bubbles[k, 0], bubbles[i, 1] - bubbles[k, 1])
    return bool(apart <= OVERLAP * (max(bubbles[i, 2], LEAST) + max(bubbles[k, 2], LEAST)))


@compiled
def _is_passed(bubbles: Floats) -> bool:
    """Whether the vehicle, the first bubble, is beyond the second, seen along the band."""
    dx, dy = bubbles[0, 0] - bubbles[1, 0], bubbles[0, 1] - bubbles[1, 1]
    ahead = dx * (bubbles[2, 0] - bubbles[1, 0]) + dy * (bubbles[2, 1] - bubbles[1, 1])
    return bool(ahead > 0.0 and np.hypot(dx, dy) < NEAR)


@compiled
def _without(bubbles: Floats, count: int, i: int) -> int:
    for k in range(i, count - 1):
        bubbles[k] = bubbles[k + 1]
    return count - 1


@compiled
def is_whole(bubbles: Floats) -> bool:
    """Whether neighbours overlap and all have room, from the first that has: a vehicle that stands too near may leave."""
    first, count = 0, bubbles.shape[0]
    while first < count and bubbles[first, 2] <= 0.0:
        first += 1
    for i in range(first, count):
        if bubbles[i, 2] <= 0.0 or (i + 1 < count and not _overlap(bubbles, i, i + 1)):
            return False
    return bool(first < count)
