"""How a windsock hangs in the wind, and what it looks like."""

import math

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_euler
from uvf.models.shapes.mesh_parts import MeshPart, lathe
from uvf.models.world.file import Windsock

Floats = NDArray[np.float64]

FULL = 7.72  # m/s, 15 kn: the wind in which it stands straight out (FAA AC 150/5345-27)
LENGTH, MOUTH, END = 2.4, 0.23, 0.11  # m, and radii at both ends (size 1 of the same)
BANDS = 5  # each for 3 kn
ORANGE, WHITE = (235, 110, 30), (245, 245, 245)


def top(sock: Windsock) -> Floats:
    """Place (3,) [m, world] where the mouth hangs."""
    x, y, z = sock.base
    return np.array((x, y, z + sock.height))


def hangs(wind: Floats) -> Floats:
    """Attitude wxyz (4,), world from sock, of one whose x axis runs from the mouth to the end, in a ``wind`` (3,) [m/s, world].

    It points to where the wind blows, and droops by a quarter turn in calm, less by as much of it as the wind has of ``FULL``.
    """
    droop = (1 - min(math.hypot(wind[0], wind[1]) / FULL, 1.0)) * math.pi / 2
    return from_euler(0.0, droop, math.atan2(wind[1], wind[0]))


def cloth() -> list[MeshPart]:
    """Its bands, orange and white, along the x axis from the mouth at the origin."""
    ends = np.linspace(0.0, 1.0, BANDS + 1)
    return [
        lathe(0, [(LENGTH * at, MOUTH + at * (END - MOUTH)) for at in (a, b)], (0.0, 0.0, 0.0), (ORANGE, WHITE)[k % 2])
        for k, (a, b) in enumerate(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
    ]
