"""How a vehicle gets from one swath to the next: Dubins paths over ground for an aircraft, ways inside the field for a ground vehicle."""

import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.inside import InsideWays, ways_inside
from uvf.planning.coverage.task import End
from uvf.planning.coverage.transits import segments_of, times_between
from uvf.planning.coverage.vehicles import GroundVehicle, SurveyAircraft

Floats = NDArray[np.float64]

HEADINGS = 24  # tried at an end whose course is free
ONE_LINE = 1e-6  # m, between swaths that lie on one line


class Connections(Protocol):
    """Times and ways between oriented swaths: 2 i along swath i as given, 2 i + 1 the other way."""

    def between(self) -> Floats:
        """Times (2 n, 2 n) [s] from the end of each to the beginning of each."""

    def along(self) -> Floats:
        """Times (2 n,) [s] along each, with what is flown straight on before and after."""

    def from_start(self, start: End) -> Floats:
        """Times (2 n,) [s] from a place to the beginning of each."""

    def to_end(self, end: End) -> Floats:
        """Times (2 n,) [s] from the end of each to a place."""

    def way(self, one: int | End, other: int | End) -> Floats:
        """Segments (k, 5) x, y [m], course [rad], curvature [1/m], length [m] from the end of one swath, or a place, to another."""

    def straight_on(self, one: int, other: int) -> bool:
        """Whether the second swath lies straight on behind the first, so near that there is no room for lead-out and lead-in."""


def both_ways(swaths: Floats) -> tuple[Floats, Floats]:
    """Poses (2 n, 3) x, y [m], course [rad] at the beginnings and at the ends of swaths (n, 4) [m], both ways along each."""
    begins = swaths.reshape(-1, 2)
    ends = swaths[:, (2, 3, 0, 1)].reshape(-1, 2)
    away = ends - begins
    courses = np.arctan2(away[:, 1], away[:, 0])
    return np.column_stack((begins, courses)), np.column_stack((ends, courses))


@dataclass(frozen=True)
class AirConnections:
    """Connections of an aircraft between swaths (n, 4) [m]: the quickest Dubins paths, wherever they lead."""

    swaths: Floats
    vehicle: SurveyAircraft

    @cached_property
    def _poses(self) -> tuple[Floats, Floats]:
        entering, leaving = both_ways(self.swaths)
        for poses, ahead in ((entering, -self.vehicle.lead_in), (leaving, self.vehicle.lead_out)):
            poses[:, 0] += ahead * np.cos(poses[:, 2])
            poses[:, 1] += ahead * np.sin(poses[:, 2])
        return entering, leaving

    def between(self) -> Floats:
        """Times (2 n, 2 n) [s] from the end of each to the beginning of each."""
        entering, leaving = self._poses
        times = self._times(leaving, entering)
        ahead = self._ahead
        near = np.isfinite(ahead)
        times[near] = (ahead / self.vehicle.speed.at(leaving[:, 2])[:, None])[near]
        return times

    @cached_property
    def _ahead(self) -> Floats:
        """(2 n, 2 n) m, below 0: how far the lead-in of one begins behind the end of the other's lead-out on one line; else infinite."""
        entering, leaving = self._poses
        c, s = np.cos(leaving[:, 2])[:, None], np.sin(leaving[:, 2])[:, None]
        dx, dy = entering[:, 0] - leaving[:, 0][:, None], entering[:, 1] - leaving[:, 1][:, None]
        ahead, aside = c * dx + s * dy, np.abs(c * dy - s * dx)
        same = np.cos(entering[:, 2] - leaving[:, 2][:, None]) > 1.0 - 1e-9
        near = same & (aside < ONE_LINE) & (ahead < 0.0) & (ahead > -self.vehicle.lead_in - self.vehicle.lead_out)
        found: Floats = np.where(near, ahead, np.inf)
        return found

    def straight_on(self, one: int, other: int) -> bool:
        """Whether the second swath lies straight on behind the first, so near that there is no room for lead-out and lead-in."""
        return bool(np.isfinite(self._ahead[one, other]))

    def along(self) -> Floats:
        """Times (2 n,) [s] along each, lead-in and lead-out included."""
        entering, leaving = self._poses
        lengths = np.hypot(*(leaving - entering)[:, :2].T)
        times: Floats = lengths / self.vehicle.speed.at(entering[:, 2])
        return times

    def from_start(self, start: End) -> Floats:
        """Times (2 n,) [s] from a place to the beginning of each."""
        times: Floats = self._times(_headings(start), self._poses[0]).min(axis=0)
        return times

    def to_end(self, end: End) -> Floats:
        """Times (2 n,) [s] from the end of each to a place."""
        times: Floats = self._times(self._poses[1], _headings(end)).min(axis=1)
        return times

    def way(self, one: int | End, other: int | End) -> Floats:
        """Segments (k, 5) of the quickest Dubins path from the end of one swath, or a place, to another."""
        starts = _headings(one) if isinstance(one, End) else self._poses[1][one][None]
        ends = _headings(other) if isinstance(other, End) else self._poses[0][other][None]
        k = int(self._times(starts, ends).argmin())
        return segments_of(starts[k // len(ends)], ends[k % len(ends)], self.vehicle.motion)

    def _times(self, leaving: Floats, entering: Floats) -> Floats:
        times = np.empty((len(leaving), len(entering)))
        times_between(leaving, entering, self.vehicle.motion, times)
        return times


def _headings(end: End) -> Floats:
    """Poses (k, 3) at a place: of its course, or of many."""
    courses = np.arange(HEADINGS) * (2 * np.pi / HEADINGS) if end.course is None else np.array((end.course,))
    return np.column_stack((np.full(len(courses), end.x), np.full(len(courses), end.y), courses))


class GroundConnections:
    """Connections of a ground vehicle between swaths (n, 4) [m]: the shortest ways inside the field, turned on the spot.

    A vehicle with a turn radius takes the Dubins path where it sees the next swath, and bends of that radius on the way elsewhere.
    """

    def __init__(self, swaths: Floats, vehicle: GroundVehicle, field: CoverageField, ends: tuple[End | None, End | None]) -> None:
        """ends: where the path begins and ends, if anywhere; they must lie in the field. Raises ValueError for parts that no way joins."""
        self._vehicle = vehicle
        self._entering, self._leaving = both_ways(swaths)
        self._count = 2 * len(swaths)
        self._ends = {end: self._count + k for k, end in enumerate(end for end in ends if end is not None)}
        places = np.array([(end.x, end.y) for end in self._ends]).reshape(-1, 2)
        self._ways: InsideWays = ways_inside(field, np.concatenate((self._entering[:, :2], places)))
        if not np.isfinite(self._ways.lengths[:, : self._count + len(places)]).all():
            raise ValueError(
                "the field, or an end of the path, is apart from the rest: no way inside joins them; plan each part on its own"
            )

    def between(self) -> Floats:
        """Times (2 n, 2 n) [s] from the end of each to the beginning of each: the end of one is the beginning of its other way."""
        order = np.arange(self._count) ^ 1
        lengths = self._ways.lengths[order, : self._count].copy()
        if self._vehicle.radius > 0.0:
            away = np.hypot(*(self._leaving[:, None, :2] - self._entering[None, :, :2]).transpose(2, 0, 1))
            dubins = np.empty_like(lengths)
            times_between(self._leaving, self._entering, self._vehicle.motion, dubins)
            seen = lengths < away + 1e-6
            lengths = np.where(seen, dubins * self._vehicle.speed, lengths + np.pi * self._vehicle.radius)
        times: Floats = lengths / self._vehicle.speed
        return times

    def along(self) -> Floats:
        """Times (2 n,) [s] along each."""
        times: Floats = np.hypot(*(self._leaving - self._entering)[:, :2].T) / self._vehicle.speed
        return times

    def from_start(self, start: End) -> Floats:
        """Times (2 n,) [s] from a place to the beginning of each."""
        times: Floats = self._ways.lengths[self._ends[start], : self._count] / self._vehicle.speed
        return times

    def to_end(self, end: End) -> Floats:
        """Times (2 n,) [s] from the end of each to a place."""
        times: Floats = self._ways.lengths[np.arange(self._count) ^ 1, self._ends[end]] / self._vehicle.speed
        return times

    def way(self, one: int | End, other: int | End) -> Floats:
        """Segments (k, 5) from the end of one swath, or a place, to another."""
        start = self._ends[one] if isinstance(one, End) else one ^ 1
        end = self._ends[other] if isinstance(other, End) else other
        corners = self._ways.way(start, end)
        if self._vehicle.radius <= 0.0:
            return straights(corners)
        courses = _courses(corners)
        for k, side, poses in ((0, one, self._leaving), (-1, other, self._entering)):
            own = side.course if isinstance(side, End) else float(poses[side, 2])
            courses[k] = own if own is not None else courses[k]
        poses = np.column_stack((corners, courses))
        found = [segments_of(a, b, self._vehicle.motion) for a, b in itertools.pairwise(poses)]
        return np.concatenate([np.empty((0, 5)), *found])

    def straight_on(self, one: int, other: int) -> bool:
        """Never: it needs no room."""
        return False


def straights(corners: Floats) -> Floats:
    """Segments (k, 5) along corners (k + 1, 2) [m]; none where corners are the same place."""
    away = np.diff(corners, axis=0)
    lengths = np.hypot(*away.T)
    courses = np.arctan2(away[:, 1], away[:, 0])
    found: Floats = np.column_stack((corners[:-1], courses, np.zeros(len(away)), lengths))[lengths > 1e-6]
    return found


def _courses(corners: Floats) -> Floats:
    """A course [rad] at each corner (k, 2): from the one before it to the one behind it."""
    around = corners[np.minimum(np.arange(len(corners)) + 1, len(corners) - 1)] - corners[np.maximum(np.arange(len(corners)) - 1, 0)]
    courses: Floats = np.arctan2(around[:, 1], around[:, 0])
    return courses
