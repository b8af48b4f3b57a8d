"""VFH+ (Ulrich, Borenstein 1998): the direction to drive in, from a histogram of how much stands where round the vehicle."""

from math import asin, atan2, copysign, cos, hypot, pi, sqrt, tau
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.local.path_following import TURN_GAIN, LookAhead, carrot, turn_rate_over
from uvf.planning.local.planner import STOP, Limits, LocalSituation, State
from uvf.planning.local.window import Grids

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

NARROWER = (1.0, 0.7, 0.45)
"""Shares of the active window's radius: where every direction is shut it looks less far."""
PACES = (1.0, 0.5, 0.25)
"""Shares of the speed that are tried."""
ARRIVED = 0.02  # m from the path's end


class VfhSettings(NamedTuple):
    """Parameters under the paper's names where it has them."""

    sectors: int = 72
    window_radius: float = 1.5  # m, of the active window
    safety_distance: float = 0.04  # m, d_s, beyond the footprint's inscribed radius
    tau_low: float = 0.015  # m of outlines, weighed by nearness, below which a sector opens
    tau_high: float = 0.03  # m of the same, above which it shuts
    wide_valley: float = 1.4  # rad, s_max
    target_cost: float = 5.0  # mu_1
    heading_cost: float = 2.0  # mu_2
    previous_cost: float = 2.0  # mu_3
    target_distance: float = 1.2  # m to the target on the path
    turn_in_place: float = 0.9  # rad off the heading, from which on it turns on the spot
    time_to_collision: float = 0.7  # s along the arc that must be free of contacts


class VfhPlus:
    """Drives towards the opening that costs least: off the path's direction, off its heading, off what it chose before."""

    def __init__(self, limits: Limits, footprint: RobotFootprint, settings: VfhSettings) -> None:
        self.settings = settings
        self._limits, self._radius = limits, footprint.inscribed_radius + settings.safety_distance
        self._look = LookAhead(limits, footprint)
        self._shut = np.zeros(settings.sectors, dtype=np.bool_)
        self._chosen: float | None = None

    def reset(self) -> None:
        """Forgets which sectors were shut and which direction was chosen."""
        self._shut[:] = False
        self._chosen = None

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where all directions are shut, or the ways into the open ones touch something."""
        s, state = self.settings, now.state
        x, y, left = carrot(now.path, state.x, state.y, s.target_distance)
        target, distance = atan2(y - state.y, x - state.x), hypot(x - state.x, y - state.y)
        if left < ARRIVED and distance < ARRIVED:
            return STOP
        for share in NARROWER:
            window = share * min(s.window_radius, distance + self._radius)
            free, depths = self._openings(now.grids, state, window)
            for direction in self._candidates(free, state, target):
                ahead = min(float(depths[self._sector(direction)]), max(left, distance))
                if (wanted := self._steered(now, direction, ahead)) is not None:
                    self._chosen = direction
                    return wanted
        self._chosen = None
        return None

    def _openings(self, grids: Grids, state: State, window: float) -> tuple[Mask, Floats]:
        """(n,) sectors that are open, and (n,) m that may be driven in each, within a radius of ``window`` [m]."""
        s = self.settings
        sizes = (window, self._radius)
        density, depths = histogram(grids, (state.x, state.y), sizes, s.sectors)
        self._shut = np.where(density > s.tau_high, True, np.where(density < s.tau_low, False, self._shut))
        speed = abs(state.speed)
        most = min(self._limits.max_turn_rate, self._limits.lateral_acceleration / max(speed, 1e-3))
        right, left = reachable(grids, (state.x, state.y, state.yaw), sizes, speed / most)
        turned = (np.arange(s.sectors) * (tau / s.sectors) - state.yaw + pi) % tau - pi
        free: Mask = ~self._shut & (turned >= right) & (turned <= left)
        return free, depths

    def _sector(self, direction: float) -> int:
        return round(direction * self.settings.sectors / tau) % self.settings.sectors

    def _candidates(self, free: Mask, state: State, target: float) -> list[float]:
        """Directions [rad] worth driving in, best first (equations 9 to 12)."""
        s = self.settings
        found = [c for begin, end in valleys(free) for c in self._in_valley(begin, end, target)]
        chosen = state.yaw if self._chosen is None else self._chosen

        def cost(c: float) -> float:
            off = (abs(wrap(c - target)), abs(wrap(c - state.yaw)), abs(wrap(c - chosen)))
            return s.target_cost * off[0] + s.heading_cost * off[1] + s.previous_cost * off[2]

        return sorted(found, key=cost)

    def _in_valley(self, begin: int, end: int, target: float) -> list[float]:
        """The middle of a narrow valley; of a wide one its borders and the target, where that lies between."""
        width = tau / self.settings.sectors
        if end - begin == self.settings.sectors:
            return [target]
        right, left = begin * width, end * width
        if left - right <= self.settings.wide_valley:
            return [0.5 * (right + left)]
        half = 0.5 * self.settings.wide_valley
        inside = (target - right - half) % tau <= left - right - 2.0 * half
        return [right + half, left - half] + ([target] if inside else [])

    def _steered(self, now: LocalSituation, direction: float, ahead: float) -> Twist | None:
        """Velocity towards a direction with ``ahead`` [m] to go; None where its arc touches something."""
        s, limits, state = self.settings, self._limits, now.state
        error = wrap(direction - state.yaw)
        if abs(error) > s.turn_in_place:
            spin = Twist(0.0, turn_rate_over(error, limits))
            return None if self._look.collides(now, spin, abs(error / spin.angular)) else spin
        fastest = min(limits.max_speed, sqrt(limits.acceleration * max(ahead, 0.02))) * cos(0.5 * pi * abs(error) / s.turn_in_place)
        for pace in PACES:
            speed = pace * fastest
            most = min(limits.max_turn_rate, limits.lateral_acceleration / max(speed, 1e-3))
            wanted = Twist(speed, copysign(min(most, TURN_GAIN * abs(error)), error))
            if not self._look.collides(now, wanted, min(s.time_to_collision, abs(error / wanted.angular) if wanted.angular else np.inf)):
                return wanted
        return None


@compiled
def histogram(grids: Grids, place: tuple[float, float], sizes: tuple[float, float], sectors: int) -> tuple[Floats, Floats]:
    """(n,) m of outlines in each sector's direction, weighed by nearness, and (n,) m that a disc may be driven in it.

    place: (x, y) [m]; sizes: radius of the active window and of the disc [m]. Sector k looks along k * 2 pi / n [rad] in the
    window's frame. Each occupied cell is widened by the disc's radius (equations 1 to 5, its certainty being 1).
    """
    density, depths = np.zeros(sectors), np.full(sectors, sizes[0])
    x0, y0, resolution = grids.frame
    rows, columns = grids.values.shape
    width = tau / sectors
    for r in range(rows):
        dy = y0 + (r + 0.5) * resolution - place[1]
        if abs(dy) > sizes[0]:
            continue
        for c in range(columns):
            dx = x0 + (c + 0.5) * resolution - place[0]
            d = np.hypot(dx, dy)
            if grids.values[r, c] != LETHAL or d > sizes[0]:
                continue
            half = asin(sizes[1] / d) if d > sizes[1] else 0.5 * pi
            magnitude = (1.0 - (d / sizes[0]) ** 2) * resolution
            direction = atan2(dy, dx)
            for k in range(int(np.ceil((direction - half) / width)), int(np.floor((direction + half) / width)) + 1):
                density[k % sectors] += magnitude
                depths[k % sectors] = min(depths[k % sectors], max(d - sizes[1], 0.0))
    return density, depths


@compiled
def reachable(grids: Grids, pose: tuple[float, float, float], sizes: tuple[float, float], turning: float) -> tuple[float, float]:
    """Largest turns [rad] to the right (below 0) and to the left that the turning circles leave open (equations 6 to 8).

    pose: x, y [m], yaw [rad]; sizes: as of ``histogram``; turning: radius [m] of the narrowest turn at the present speed.
    """
    x0, y0, resolution = grids.frame
    rows, columns = grids.values.shape
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    right, left = -pi, pi
    for r in range(rows):
        for c in range(columns):
            if grids.values[r, c] != LETHAL:
                continue
            dx, dy = x0 + (c + 0.5) * resolution - pose[0], y0 + (r + 0.5) * resolution - pose[1]
            d = np.hypot(dx, dy)
            if d > sizes[0] or d <= sizes[1]:  # what is within the disc already is for the look along the arc
                continue
            ahead, aside = cosine * dx + sine * dy, cosine * dy - sine * dx
            bearing = atan2(aside, ahead)
            if bearing < 0.0 and np.hypot(ahead, aside + turning) < turning + sizes[1]:
                right = max(right, bearing)
            elif bearing >= 0.0 and np.hypot(ahead, aside - turning) < turning + sizes[1]:
                left = min(left, bearing)
    return right, left


def valleys(free: Mask) -> list[tuple[int, int]]:
    """First and last sector of each run of open ones, in order; the last one may be beyond the number of sectors, past zero."""
    n = len(free)
    if free.all():
        return [(0, n)]
    begins = np.flatnonzero(free & ~np.roll(free, 1))
    shut_after = [int(np.flatnonzero(~np.roll(free, -int(b)))[0]) for b in begins]
    return [(int(b), int(b) + run - 1) for b, run in zip(begins, shut_after, strict=True)]
