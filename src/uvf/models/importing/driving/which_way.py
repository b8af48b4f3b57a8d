"""Which way a foreign vehicle stands and drives: up, and which of two wheels is the left one."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvf.models.importing.driving.wheel_guess import Pair, WheelGuess, shapes_below
from uvf.models.importing.robot import Foreign
from uvf.models.shapes.mesh import reach

Floats = NDArray[np.float64]

LEFT = re.compile(
    r"left|izq|sinist|gauche|link?s|(^|[_\-.0-9])l([_\-.0-9]|$)|^l(w|wheel|m)|wheel_?l($|_)|wl($|_)|(?-i:[a-z]L($|[_A-Z]))",
    re.I,
)
RIGHT = re.compile(
    r"right|der(echa)?_|destr|droit|recht|(^|[_\-.0-9])r([_\-.0-9]|$)|^r(w|wheel|m)|wheel_?r($|_)|wr($|_)|(?-i:[a-z]R($|[_A-Z]))",
    re.I,
)


def names_of(pair: Pair) -> list[str]:
    """What the wheels of a pair are called: their joints and links."""
    return [w.joint.name + " " + w.joint.child for w in pair]


def up_of(foreign: Foreign, lateral: Floats, wheel: WheelGuess) -> Floats:
    """z unless the axle is upright then; else the direction in which the wheels are lowest."""
    best = np.array((0.0, 0.0, 1.0))
    if abs(lateral[2]) >= 0.3:
        options = [d for d in _six() if abs(d @ lateral) < 0.3]
        poses = foreign.model.link_poses()
        everything = [s for name in foreign.model.roots[:1] for s in shapes_below(foreign.model, name, poses)]
        lows = [max(float(reach(s, -d[None])[0]) for s in everything) + float(wheel.centre @ d) for d in options]
        best = options[int(np.argmin(lows))]
    level = best - (best @ lateral) * lateral
    up: Floats = level / np.linalg.norm(level)
    return up


def _six() -> Iterator[Floats]:
    for sign in (1.0, -1.0):
        yield from sign * np.eye(3)[::-1]


def left_is_first(pair: Pair, foreign: Foreign, up: Floats) -> bool:
    """x forward counts (REP-103); where x is no way to drive, names or the plugin say what is left."""
    a, b = pair
    forward = np.cross((a.centre - b.centre) / np.linalg.norm(a.centre - b.centre), up)
    by_names = _by_names(a, b, foreign)
    if abs(forward[0]) > 0.7:
        if by_names is not None and by_names != (forward[0] > 0):
            foreign.notes.add("left and right exchanged: by their places with x forward the wheels are on the other sides than named")
        return bool(forward[0] > 0)
    if by_names is None:
        foreign.notes.add("guessed which wheel is left: neither x nor the names tell; check the direction of driving")
        return bool(forward[np.argmax(np.abs(forward))] > 0)
    return by_names


def _by_names(a: WheelGuess, b: WheelGuess, foreign: Foreign) -> bool | None:
    """Whether the first is called left; None = not told."""
    for wheel, if_left in ((a, True), (b, False)):
        if wheel.joint.name in foreign.drive.left:
            return if_left
    names = names_of((a, b))
    lefts = [bool(LEFT.search(n)) and not RIGHT.search(n) for n in names]
    rights = [bool(RIGHT.search(n)) and not LEFT.search(n) for n in names]
    if (lefts[0] and not lefts[1]) or (rights[1] and not rights[0]):
        return True
    if (lefts[1] and not lefts[0]) or (rights[0] and not rights[1]):
        return False
    return None


def row(values: NDArray[Any]) -> str:
    """A vector (n,) as it is written in a note."""
    return "(" + ", ".join(f"{round(float(v), 2) + 0.0:g}" for v in values) + ")"
