"""Where and how an aircraft has touched the ground, from its true track."""

import math

import numpy as np
from numpy.typing import NDArray

from uvf.models.world.file import Strip

Floats = NDArray[np.float64]
FLEW = 5.0  # m above where it comes to rest, from which on it has flown
LOW = 1.0  # m above where it comes to rest, below which it touches: a tail-dragger's centre of gravity is still to sink
AT_ONCE, TAKEN, SHARE = 0.2, 0.3, 0.5  # s in which the ground takes this much of its sink [m/s], and this share; no flare does
ROLLS, LEVEL = 1.0, 0.05  # s over which it keeps its height within this [m]: it has come down like a feather
BEFORE = 0.2  # s before touching, over which the sink is taken
AIM_SHARE, AIM_MOST = 0.25, 60.0  # of the length of a strip, m: how far behind the threshold wheels are to touch


def touchdown(track: Floats) -> int | None:
    """Index of the first sample (n, 4: t, x, y, z) on the ground after the flight; None unless it flew and stands at the end."""
    if len(track) < 100 or speed_at_end(track) > 0.5:
        return None
    t, height = track[:, 0], track[:, 3] - track[-1, 3]
    flew = np.flatnonzero(height > FLEW)
    if not len(flew):
        return None
    climb = np.gradient(height, t)
    taken = np.interp(t + AT_ONCE, t, climb) - climb
    stopped = (taken > TAKEN) & (taken > -SHARE * climb) & (climb < 0.0)
    rolls = np.logical_and.reduce([abs(np.interp(t + ahead, t, height) - height) < LEVEL for ahead in (ROLLS / 2, ROLLS)])
    touched = (height < LOW) & (stopped | rolls)
    return int(flew[-1] + np.argmax(touched[flew[-1] :]))


def speed_at_end(track: Floats) -> float:
    """Mean speed [m/s] over the last second of a track (n, 4): t [s], x, y, z [m, world]; infinite without a track."""
    last = track[track[:, 0] >= track[-1, 0] - 1.0] if len(track) else track
    if len(last) < 2:
        return math.inf
    return float(np.linalg.norm(last[-1, 1:] - last[0, 1:]) / (last[-1, 0] - last[0, 0]))


def sink(track: Floats) -> float:
    """Sink rate [m/s] at touchdown of a track (n, 4): t [s], x, y, z [m, world]; infinite without a touchdown."""
    at = touchdown(track)
    if at is None:
        return math.inf
    before = int(np.searchsorted(track[:, 0], track[at, 0] - BEFORE))
    return float((track[before, 3] - track[at, 3]) / (track[at, 0] - track[before, 0]))


def error(track: Floats, strips: list[Strip]) -> float:
    """Distance [m] along the strip between touchdown and aiming point of a track (n, 4): t [s], x, y, z [m, world].

    Infinite without a strip or a landing.
    """
    at = touchdown(track)
    if at is None or not strips:
        return math.inf
    x, y = track[at, 1:3]
    strip = min(strips, key=lambda s: math.hypot(s.centre[0] - x, s.centre[1] - y))
    along = np.array((math.cos(strip.yaw), math.sin(strip.yaw)))
    direction = math.copysign(1.0, float(along @ (track[at, 1:3] - track[max(at - 50, 0), 1:3])))
    flown = direction * float(along @ (track[at, 1:3] - np.array(strip.centre[:2])))
    return abs(flown + strip.length / 2 - min(AIM_SHARE * strip.length, AIM_MOST))
