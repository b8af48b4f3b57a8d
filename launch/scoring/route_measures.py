"""How near a vehicle came to the waypoints of its mission and to the legs between them, whoever drove or flew."""

from itertools import pairwise
from math import inf

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding, largest
from launch.scoring.path_measures import corners_of, leg_distance
from launch.scoring.recorded_track import RecordedTrack

Floats = NDArray[np.float64]


def waypoints_missed_by(track: RecordedTrack) -> Finding:
    """Largest horizontal distance by which a waypoint of the mission was missed, whoever drove [m].

    Counts over the whole run: the waypoints are looked for in their order, each from where the one before was passed. Infinite without
    waypoints.
    """
    passed = _in_order(track)
    if not passed:
        return Finding(inf, note="there are no waypoints")
    p = track.positions()
    distance, k, sample = max(passed)
    return Finding(distance, float(p[sample, 0]), (float(p[sample, 1]), float(p[sample, 2])), f"waypoint {k + 1} of {len(passed)}")


def cross_track_error(track: RecordedTrack) -> Finding:
    """Largest horizontal distance from the straight leg between two waypoints, whoever drove [m].

    Counts from the first waypoint to the last one, between the samples nearest to them. Infinite with fewer than two waypoints.
    """
    passed, corners, p = _in_order(track), corners_of(track), track.positions()
    legs = [(corners[i], corners[i + 1], p[a[2] : b[2] + 1]) for i, (a, b) in enumerate(pairwise(passed))]
    if not legs:
        return Finding(inf, note="fewer than two waypoints")
    errors = np.concatenate([leg_distance(samples[:, 1:3], a[:2], b[:2]) for a, b, samples in legs])
    return largest(errors, np.vstack([samples for _, _, samples in legs]))


def _in_order(track: RecordedTrack) -> list[tuple[float, int, int]]:
    """Of each waypoint: the distance [m] at which it was passed, its number, and the sample at which that was.

    They are passed one after the other, so that the sum of the distances is the least one that is possible.
    """
    p, corners = track.positions(), corners_of(track)[:, :2]
    if not len(p) or not len(corners):
        return []
    distances = np.linalg.norm(p[:, None, 1:3] - corners[None], axis=2)
    best = _cheapest_order(distances)
    return [(float(distances[sample, k]), k, sample) for k, sample in enumerate(best)]


def _cheapest_order(distances: Floats) -> list[int]:
    """Samples (k,), none before that of the waypoint before, with the least sum of distances (n, k) [m]: dynamic programming."""
    n, count = distances.shape
    least = np.zeros(n)
    chosen = np.zeros((count, n), dtype=np.int64)
    for k in range(count):
        cost = least + distances[:, k]
        running = np.minimum.accumulate(cost)
        is_new = np.r_[True, cost[1:] < running[:-1]]
        chosen[k] = np.maximum.accumulate(np.where(is_new, np.arange(n), 0))
        least = running
    order, sample = [0] * count, n - 1
    for k in reversed(range(count)):
        order[k] = sample = int(chosen[k, sample])
    return order
