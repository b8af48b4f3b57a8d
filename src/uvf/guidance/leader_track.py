"""The way that a leader has flown, as its follower knows it: from the leader's own estimates, spot by spot with the time of each.

A follower that passes each spot the same time after its leader flies as fast as the leader did there: in any wind and round any
corner at the leader's own airspeed (a delay-based spacing policy: Besselink and Johansson, IEEE TAC 62(9), 2017).
"""

import math
from bisect import bisect_right
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.guidance.vector_field import Point

Floats = NDArray[np.float64]

KEPT = 90.0  # s of the leader's flight
STEP = 0.1  # s, between spots
BEND = 2  # spots, each way, over which a curvature is taken
SMOOTH = 15  # spots, each way at most, over which heights are: what a corner shakes the leader by is not to be flown after it
PACE_OVER = 20.0  # s, over which the leader's airspeed is averaged: gusts are not to move the station
SPAN = 4.0  # s, each way: where the nearest spot is looked for, once it has been found
SLOWEST = 1.0  # m/s


@dataclass(frozen=True, slots=True)
class LeaderReport:
    """What an aircraft of a formation reports of itself, in the world frame."""

    t: float  # s, that it is valid for
    north: float  # m
    east: float  # m
    height: float  # m
    v_north: float  # m/s
    v_east: float  # m/s
    climb: float  # m/s
    airspeed: float  # m/s


@dataclass(frozen=True, slots=True)
class TrackPoint:
    """A point of the leader's track and how the leader flew there."""

    t: float  # s, when the leader was there
    north: float  # m
    east: float  # m
    height: float  # m
    course: float  # rad, from north, clockwise
    speed: float  # m/s over ground
    climb: float  # m/s
    curvature: float  # 1/m, to the right


class LeaderTrack:
    """The leader's track over the last ``KEPT`` seconds; before the oldest point and beyond the newest it goes straight on."""

    def __init__(self) -> None:
        self.newest: LeaderReport | None = None
        self._flown = 0.0  # m, of air
        self._paced = 0.0, 0.0
        self._t: list[float] = []
        self._rows: list[tuple[float, ...]] = []  # t, north, east, height, course (unwrapped), speed, air flown
        self._table: Floats = np.zeros((0, 7))

    def add(self, report: LeaderReport) -> None:
        """Adds a report; one that is not newer than the last, or has a number that is not finite, is ignored."""
        last = self.newest
        if not all(map(math.isfinite, astuple(report))) or (last is not None and report.t <= last.t):
            return
        if last is not None:
            self._flown += max(report.airspeed, SLOWEST) * (report.t - last.t)
        self.newest = report
        self._paced = self._mean(report)
        if not self._t or report.t >= self._t[-1] + STEP - 1e-6:
            self._append(report)

    def _append(self, report: LeaderReport) -> None:
        course = math.atan2(report.v_east, report.v_north)
        if self._rows:
            before = self._rows[-1][4]
            course = before + math.remainder(course - before, math.tau)
        speed = max(math.hypot(report.v_north, report.v_east), SLOWEST)
        self._t.append(report.t)
        self._rows.append((report.t, report.north, report.east, report.height, course, speed, self._flown))
        outlived = bisect_right(self._t, report.t - KEPT)
        del self._t[:outlived], self._rows[:outlived]
        self._table = np.array(self._rows)

    def _mean(self, newest: LeaderReport) -> tuple[float, float]:
        """Mean airspeed [m/s] up to now, and how it changes [m/s^2]."""
        k = max(bisect_right(self._t, newest.t - PACE_OVER) - 1, 0)
        if len(self._t) < 2 or newest.t - self._t[k] < STEP:
            return max(newest.airspeed, SLOWEST), 0.0
        seconds, air = newest.t - self._t[k], self._rows[k][-1]
        pace = (self._flown - air) / seconds
        leaving = (self._rows[k + 1][-1] - air) / (self._t[k + 1] - self._t[k]) if seconds >= PACE_OVER else pace
        return pace, (newest.airspeed - leaving) / seconds

    @property
    def pace(self) -> float:
        """Mean airspeed [m/s] of the leader over the last seconds. Only once there is a report, as ``at`` and ``nearest``."""
        return self._paced[0]

    @property
    def pace_rate(self) -> float:
        """Rate of change [m/s^2] of the pace."""
        return self._paced[1]

    def at(self, t: float) -> TrackPoint:
        """The point of the track where the leader was at ``t`` [s]."""
        table = self._table
        i = min(max(bisect_right(self._t, t) - 1, 0), len(table) - 1)
        row = table[i]
        if i + 1 == len(table) or t < row[0]:
            return self._beyond(i, t - float(row[0]))
        part = float((t - row[0]) / (table[i + 1, 0] - row[0]))
        _, north, east, _, course, speed, _ = (row + part * (table[i + 1] - row)).tolist()
        (height, climb, bend), after = self._smooth(i), self._smooth(i + 1)
        height, climb, bend = (a + part * (b - a) for a, b in zip((height, climb, bend), after, strict=True))
        return TrackPoint(t, north, east, height, course, speed, climb, bend)

    def _beyond(self, i: int, dt: float) -> TrackPoint:
        """``dt`` [s] straight on from a row at one of the ends."""
        t, north, east, height, course, speed, _ = self._rows[i]
        ground = dt * speed
        return TrackPoint(t + dt, north + ground * math.cos(course), east + ground * math.sin(course), height, course, speed, 0.0, 0.0)

    def _smooth(self, i: int) -> tuple[float, float, float]:
        """Height [m], climb [m/s] and curvature [1/m] about row ``i``."""
        room = min(i, len(self._rows) - 1 - i)
        if room == 0:
            return self._rows[i][3], 0.0, 0.0
        k, wide = min(room, BEND), min(room, SMOOTH)
        first, last = self._rows[i - k], self._rows[i + k]
        bend = (last[4] - first[4]) / ((last[0] - first[0]) * self._rows[i][5])
        heights = self._table[i - wide : i + wide + 1, 3]
        times = self._table[i - wide : i + wide + 1, 0] - self._table[i, 0]
        return float(heights.mean()), float(times @ heights / (times @ times)), bend

    def nearest(self, position: Point, about: float | None = None) -> TrackPoint:
        """The point of the track nearest to ``position`` (north, east [m]).

        Only within ``SPAN`` of the one passed at ``about`` [s], where that is given.
        """
        low, high = 0, len(self._t)
        if about is not None:
            low = min(bisect_right(self._t, about - SPAN), len(self._t) - 1)
            high = max(bisect_right(self._t, about + SPAN), low + 1)
        away = np.asarray(position) - self._table[low:high, 1:3]
        i = low + int(np.argmin(np.einsum("ij,ij->i", away, away)))
        t, north, east, _, course, speed, _ = self._rows[i]
        ahead = (position[0] - north) * math.cos(course) + (position[1] - east) * math.sin(course)
        return self.at(t + ahead / speed)
