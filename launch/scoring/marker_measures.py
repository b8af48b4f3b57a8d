"""Measures of searches: which of the mission's markers were found, how well, and to which somebody has been."""

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding
from launch.scoring.recorded_track import RecordedTrack

Floats = NDArray[np.float64]

FOUND_WITHIN = 1.0  # m
REACHED_WITHIN = 2.0  # m


def markers_found(track: RecordedTrack) -> Finding:
    """Mission's markers within 1 m of which the vehicle tells of one [count].

    Counts at the end of the run.
    """
    distances = _distances(track)
    return Finding(float((distances.min(axis=1) <= FOUND_WITHIN).sum()) if distances.size else 0.0)


def marker_error(track: RecordedTrack) -> Finding:
    """Largest horizontal distance of a marker that the vehicle tells of from the nearest one of the mission [m].

    Counts at the end of the run. Infinite when it tells of none, or the mission has none.
    """
    distances = _distances(track)
    return Finding(float(distances.min(axis=0).max()) if distances.size else np.inf)


def markers_reached(track: RecordedTrack) -> Finding:
    """Mission's markers to within 2 m of which the vehicle, or another ground vehicle of the mission, has come [count].

    Counts over the whole run, by the true positions.
    """
    drivers = [other for other in track.team.values() if not other.flies]
    reached, last = 0, 0.0
    for marker in _markers(track):
        times = [t for driver in drivers if (t := _arrival(driver, marker)) is not None]
        reached += bool(times)
        last = max(last, min(times, default=0.0))
    return Finding(float(reached), last if reached else None)


def _markers(track: RecordedTrack) -> Floats:
    return np.array([(m.x, m.y) for m in track.site.mission.markers]).reshape(-1, 2)


def _distances(track: RecordedTrack) -> Floats:
    """(markers, detections) [m]."""
    told = [] if track.detections is None else [(d.position.x, d.position.y) for d in track.detections.detections]
    seen = np.array(told).reshape(-1, 2)
    return np.asarray(np.linalg.norm(_markers(track)[:, None] - seen[None, :], axis=2), dtype=np.float64)


def _arrival(track: RecordedTrack, marker: Floats) -> float | None:
    positions = track.positions()
    near = np.nonzero(np.linalg.norm(positions[:, 1:3] - marker, axis=1) <= REACHED_WITHIN)[0]
    return float(positions[near[0], 0]) if len(near) else None
