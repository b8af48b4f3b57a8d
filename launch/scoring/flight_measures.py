"""Measures of formations and landings."""

from math import inf

import numpy as np
from numpy.typing import NDArray

from launch.scoring import formation_scores, touchdown
from launch.scoring.finding import Finding
from launch.scoring.recorded_track import RecordedTrack

Floats = NDArray[np.float64]


def separation(track: RecordedTrack) -> Finding:
    """Smallest distance from any other aircraft [m].

    Counts over the time in which both are heard. 0 when nothing was heard of this one; infinite when it is alone.
    """
    if not track.truth:
        return Finding(0.0, note="no truth was recorded")
    others = {name: other.motion() for name, other in track.team.items() if name != track.name and other.flies and other.truth}
    nearest = [(*formation_scores.separation(track.motion(), motion), name) for name, motion in others.items()]
    distance, t, name = min(nearest, default=(inf, 0.0, ""))
    return Finding(distance, t, track.place_at(t), f"from {name}") if name else Finding(inf, note="it is alone")


def spacing_error(track: RecordedTrack) -> Finding:
    """RMS of the distance from the formation slot along the leader's track [m].

    Counts every 0.1 s from 20 s after the start, in which slots are taken up, until the end of the run. Infinite for an aircraft that
    follows nobody.
    """
    errors = _station_errors(track)
    return Finding(float(np.sqrt(np.mean(errors[:, 1] ** 2)))) if len(errors) else Finding(inf, note="it follows nobody")


def station_error(track: RecordedTrack) -> Finding:
    """RMS of the distance from the formation slot in space [m].

    Counts every 0.1 s from 20 s after the start, in which slots are taken up, until the end of the run. Infinite for an aircraft that
    follows nobody.
    """
    errors = _station_errors(track)
    return Finding(float(np.sqrt(np.mean((errors[:, 1:] ** 2).sum(axis=1))))) if len(errors) else Finding(inf, note="it follows nobody")


def _station_errors(track: RecordedTrack) -> Floats:
    follow = track.site.members[track.name].entry.job.follow
    if follow is None or not track.truth or not track.team[follow.leader].truth:
        return np.zeros((0, 4))
    return formation_scores.station_errors(track.motion(), track.team[follow.leader].motion(), follow)


def touchdown_sink(track: RecordedTrack) -> Finding:
    """Sink rate at touchdown [m/s].

    Counts over the last 0.2 s before the wheels touch the ground for good. Infinite unless the aircraft has flown and
    stands whole at the end.
    """
    return _at_touchdown(track, touchdown.sink(track.positions()))


def touchdown_error(track: RecordedTrack) -> Finding:
    """Distance between the touchdown point and the aiming point, along the runway [m].

    Counts at the moment of touchdown. The aiming point is a quarter of the runway, at most 60 m, behind its threshold. Infinite without
    a runway or a landing.
    """
    return _at_touchdown(track, touchdown.error(track.positions(), track.site.world.strips))


def speed_at_end(track: RecordedTrack) -> Finding:
    """Mean speed in space [m/s].

    Counts over the last second of the run. Infinite for a wreck.
    """
    return _wrecked(track) or Finding(touchdown.speed_at_end(track.positions()))


def _wrecked(track: RecordedTrack) -> Finding | None:
    """A wreck stands too, and may have come down gently: it has not landed."""
    if track.crash is None:
        return None
    t, why = track.crash
    return Finding(inf, t, track.place_at(t), f"it crashed: {why}")


def _at_touchdown(track: RecordedTrack, value: float) -> Finding:
    if (wreck := _wrecked(track)) is not None:
        return wreck
    p = track.positions()
    at = touchdown.touchdown(p)
    if at is None:
        return Finding(value, note="it did not land and stand")
    return Finding(value, float(p[at, 0]), (float(p[at, 1]), float(p[at, 2])), "touchdown")
