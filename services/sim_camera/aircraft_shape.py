"""The plain aircraft drawn for a vehicle without a mesh: boxes with the proportions of a small pusher with a twin-boom tail."""

from typing import NamedTuple

Triple = tuple[float, float, float]


class Part(NamedTuple):
    """A box in the body frame (FLU) [m]."""

    centre: Triple
    size: Triple
    colour: Triple


_WHITE, _ORANGE, _DARK = (0.92, 0.92, 0.94), (0.95, 0.45, 0.1), (0.15, 0.15, 0.17)

PARTS = (
    Part((0.1, 0.0, 0.0), (1.0, 0.2, 0.22), _WHITE),  # fuselage
    Part((0.0, 0.0, 0.12), (0.28, 2.9, 0.035), _WHITE),  # wing
    Part((0.0, 1.3, 0.121), (0.282, 0.3, 0.04), _ORANGE),  # left tip
    Part((0.0, -1.3, 0.121), (0.282, 0.3, 0.04), _ORANGE),  # right tip
    Part((-0.65, 0.35, 0.1), (1.2, 0.04, 0.04), _DARK),  # left boom
    Part((-0.65, -0.35, 0.1), (1.2, 0.04, 0.04), _DARK),  # right boom
    Part((-1.2, 0.0, 0.3), (0.18, 0.74, 0.03), _WHITE),  # tail plane
    Part((-1.2, 0.35, 0.2), (0.18, 0.03, 0.24), _ORANGE),  # left fin
    Part((-1.2, -0.35, 0.2), (0.18, 0.03, 0.24), _ORANGE),  # right fin
)
