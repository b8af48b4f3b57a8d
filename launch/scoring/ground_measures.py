"""Measures of ground vehicles, and those that any vehicle has: distance, contacts, pose, goals."""

from math import acos, cos, degrees, inf, radians

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding, largest
from launch.scoring.recorded_track import RecordedTrack
from schemas.messages import NavStatus

Floats = NDArray[np.float64]
TIPPED = radians(60.0)
GOALS = ("goal", "waypoints", "through", "patrol")
"""Jobs that lead to places that somebody asked for."""


def distance_driven(track: RecordedTrack) -> Finding:
    """Distance travelled over the ground [m].

    Counts over the whole run, from the true positions.
    """
    p = track.positions()
    return Finding(float(np.linalg.norm(np.diff(p[:, 1:3], axis=0), axis=1).sum()) if len(p) > 1 else 0.0)


def contacts(track: RecordedTrack) -> Finding:
    """Number of times that the vehicle began to touch something [count].

    Counts over the whole run. Infinite when no contact message was received.
    """
    if not track.felt:
        return Finding(inf, note="no contact message was received")
    if not track.touches:
        return Finding(0.0)
    first = track.touches[0]
    others = ", ".join(dict.fromkeys(touch.other for touch in track.touches))
    return Finding(float(len(track.touches)), first.t, track.place_at(first.t), f"against {others}")


def crashed(track: RecordedTrack) -> Finding:
    """Whether the vehicle crashed [0 or 1].

    Counts over the whole run. An aircraft has crashed when its simulator says so, a ground vehicle when it is tilted by more than
    60 degrees. Infinite without any truth.
    """
    if track.crash is not None:
        t, why = track.crash
        return Finding(1.0, t, track.place_at(t), why)
    if not track.truth:
        return Finding(inf, note="no truth was recorded")
    upright = np.array(track.uprightness)
    if track.flies or upright.min() >= cos(TIPPED):
        return Finding(0.0)
    t = track.truth[int(np.argmax(upright < cos(TIPPED)))][0]
    return Finding(1.0, t, track.place_at(t), f"tilted by {degrees(acos(max(-1.0, upright.min()))):.0f} deg")


def pose_error(track: RecordedTrack) -> Finding:
    """Largest horizontal distance between the estimated and the true position [m].

    Counts over the whole run, from the first estimated pose on. Infinite without a pose.
    """
    errors, track_of = _pose_errors(track)
    return largest(errors, track_of) if len(errors) else Finding(inf, note="no pose was estimated")


def pose_error_rms(track: RecordedTrack) -> Finding:
    """RMS of the horizontal distance between the estimated and the true position [m].

    Counts over the whole run, from the first estimated pose on. Infinite without a pose.
    """
    errors, _ = _pose_errors(track)
    return Finding(float(np.sqrt(np.mean(errors**2)))) if len(errors) else Finding(inf, note="no pose was estimated")


def _pose_errors(track: RecordedTrack) -> tuple[Floats, Floats]:
    """Errors (n,) [m], and where the vehicle was: t [s], x, y [m, world]."""
    p, estimated = track.positions(), np.array(track.pose).reshape(-1, 3)
    if not len(p) or not len(estimated):
        return np.zeros(0), np.zeros((0, 3))
    t = estimated[:, 0]
    true = np.column_stack((t, np.interp(t, p[:, 0], p[:, 1]), np.interp(t, p[:, 0], p[:, 2])))
    return np.linalg.norm(true[:, 1:] - estimated[:, 1:], axis=1), true


def goal_time(track: RecordedTrack) -> Finding:
    """Longest time from when a goal was taken until it was reached [s].

    Counts over the whole run, each place of a route by itself. Infinite when a goal was not reached, or none was given.
    """
    longest, given = Finding(0.0), False
    since: float | None = None
    goal = (0.0, 0.0)
    for t, status in track.navigation:
        place = status.goal.x, status.goal.y
        if status.job not in GOALS:
            if since is not None:
                return Finding(inf, t, track.place_at(t), f"goal ({goal[0]:.1f}, {goal[1]:.1f}) was given up")
            continue
        if since is None and status.state in (NavStatus.PLANNING, NavStatus.DRIVING, NavStatus.RECOVERING):
            since, goal, given = t, place, True
        elif since is not None and status.state == NavStatus.REACHED:
            took = t - since
            longest = max(longest, Finding(took, t, goal, "reached"), key=lambda found: found.value)
            since = None
        elif since is not None and status.state in (NavStatus.BLOCKED, NavStatus.CANCELLED):
            return Finding(inf, t, track.place_at(t), f"goal ({goal[0]:.1f}, {goal[1]:.1f}): {status.reason}")
    if since is not None:
        return Finding(inf, since, goal, "was not reached before the run ended")
    return longest if given else Finding(inf, note="no goal was taken")
