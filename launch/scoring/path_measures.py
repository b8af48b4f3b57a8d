"""Measures of missions: items reached, and how well the path between them was kept."""

from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding, largest
from launch.scoring.recorded_track import RecordedTrack
from schemas.messages import MissionItem
from uvf.maths.rotations import wrap
from uvf.runtime.messages.convert import array

Floats = NDArray[np.float64]

PASSED = 3.0  # s, within which of being told so a waypoint is passed
NO_PATH = Finding(inf, note="fewer than two waypoints, or no item was reached")


def circuits(track: RecordedTrack) -> Finding:
    """Rounds of the mission completed [count].

    Counts over the whole run. A round is complete when a jump leads back to the first item.
    """
    return Finding(float(max((laps for _, _, laps in track.progress), default=0)))


def legs(track: RecordedTrack) -> Finding:
    """Mission items reached [count].

    Counts over the whole run, each round anew.
    """
    reached = [(t, r) for t, r, _ in track.progress]
    passed = [(t, r) for (_, before), (t, r) in pairwise(reached) if r != before and r >= 0]
    return Finding(float(len(passed)), passed[-1][0], track.place_at(passed[-1][0]), "the last one") if passed else Finding(0.0)


def path_error(track: RecordedTrack) -> Finding:
    """Largest horizontal distance from the nearest leg of the mission [m].

    Counts from the first mission item reached until the end of the run. Legs are straight lines between waypoints, the last to the
    first included. Infinite with fewer than two waypoints, or when no item was reached.
    """
    p, corners = _scored(track), corners_of(track)
    if not len(p) or len(corners) < 2:
        return NO_PATH
    closed = np.vstack((corners, corners[:1]))
    return largest(np.min([leg_distance(p[:, 1:3], a[:2], b[:2]) for a, b in pairwise(closed)], axis=0), p)


def altitude_error(track: RecordedTrack) -> Finding:
    """Largest difference from the altitude of the nearest leg of the mission [m].

    Counts from the first mission item reached until the end of the run. Infinite with fewer than two waypoints, or when no item was
    reached.
    """
    p, corners = _scored(track), corners_of(track)
    if not len(p) or len(corners) < 2:
        return NO_PATH
    closed = np.vstack((corners, corners[:1]))
    distances = np.array([leg_distance(p[:, 1:3], a[:2], b[:2]) for a, b in pairwise(closed)])
    altitudes = np.array([_altitude(p[:, 1:3], a, b) for a, b in pairwise(closed)])
    nearest_leg = distances.argmin(axis=0)
    return largest(np.abs(p[:, 3] - altitudes[nearest_leg, np.arange(len(p))]), p)


def waypoint_error(track: RecordedTrack) -> Finding:
    """Largest distance in space by which a waypoint was missed [m].

    Counts within 3 s of the moment at which each waypoint was reached for the first time: there the nearest sample is taken. Infinite when
    a waypoint was not reached, or the mission has none.
    """
    found = [(float(np.linalg.norm(p[0, 1:4] - array(item.position))), k, p) for k, item, p in _passes(track)]
    return _worst(found, "there are no waypoints")


def course_error(track: RecordedTrack) -> Finding:
    """Largest difference between the course over ground and the course that a waypoint asks for [rad].

    Counts at the sample nearest to each waypoint that has a course, within 3 s of the moment at which it was reached. Infinite when one was
    not reached, or no waypoint has a course.
    """
    asked = [(k, item, p) for k, item, p in _passes(track) if item.HasField("course")]
    flown = [np.arctan2(*(p[1] - p[0])[[2, 1]]) if len(p) > 1 else np.inf for _, _, p in asked]
    found = [(abs(float(wrap(c - item.course))), k, p) for (k, item, p), c in zip(asked, flown, strict=True)]
    return _worst(found, "no waypoint has a course")


def _worst(found: list[tuple[float, int, Floats]], nothing: str) -> Finding:
    """The largest of (value, index of the item, samples from where it was passed)."""
    if not found:
        return Finding(inf, note=nothing)
    value, k, p = max(found, key=lambda each: (np.isnan(each[0]), each[0]))
    if not np.isfinite(p[0, 0]):
        return Finding(inf, note=f"item {k} was not reached")
    return Finding(value, float(p[0, 0]), (float(p[0, 1]), float(p[0, 2])), f"item {k}")


def _passes(track: RecordedTrack) -> list[tuple[int, MissionItem, Floats]]:
    """Each waypoint by its index with the samples (t, x, y, z) from where it was passed nearest, in the order of the mission."""
    p, found = track.positions(), []
    reached = {r: t for t, r, _ in reversed(track.progress)}
    for index, item in enumerate(track.mission.items if track.mission else ()):
        if item.kind != MissionItem.WAYPOINT:
            continue
        near = p[np.abs(p[:, 0] - reached.get(index, np.inf)) < PASSED]
        k = int(np.linalg.norm(near[:, 1:4] - array(item.position), axis=1).argmin()) if len(near) else 0
        found.append((index, item, near[k:] if len(near) else np.full((1, 4), np.inf)))
    return found


def corners_of(track: RecordedTrack) -> Floats:
    """The waypoints (n, 3) [m, world] of the vehicle's mission."""
    items = track.mission.items if track.mission else ()
    return np.array([array(i.position) for i in items if i.kind == MissionItem.WAYPOINT]).reshape(-1, 3)


def _scored(track: RecordedTrack) -> Floats:
    begun = next((t for t, reached, _ in track.progress if reached >= 0), np.inf)
    p = track.positions()
    return p[p[:, 0] >= begun]


def _along(p: Floats, a: Floats, b: Floats) -> Floats:
    d = b - a
    share: Floats = np.clip((p - a) @ d / max(float(d @ d), 1e-12), 0.0, 1.0)
    return share


def leg_distance(p: Floats, a: Floats, b: Floats) -> Floats:
    """Distances (n,) [m] of points (n, 2) from the leg between two waypoints."""
    nearest_point = a + _along(p, a, b)[:, None] * (b - a)
    distance: Floats = np.linalg.norm(p - nearest_point, axis=1)
    return distance


def _altitude(p: Floats, a: Floats, b: Floats) -> Floats:
    altitude: Floats = a[2] + _along(p, a[:2], b[:2]) * (b[2] - a[2])
    return altitude
