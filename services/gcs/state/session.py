"""What one browser has chosen, of vehicle, camera and layers; another one's clicks change nothing of it."""

from collections.abc import Set
from dataclasses import dataclass, field
from math import inf

ROOTS = {
    "Map": ("/map",),
    "Scan": ("/scan",),
    "Paths": ("/path", "/goal", "/mission"),
    "Fences": ("/fence",),
    "Tracks": ("/track",),
    "Labels": ("/label", "/height"),
    "Walls": ("/world/walls",),
    "Team maps": ("/team",),
    "True pose": ("/true",),
}
"""Layer -> the nodes that bear it; each bears nothing else."""
SHOWN_AT_FIRST = frozenset(ROOTS) - {"Team maps", "True pose"}


def hidden_roots(layers: Set[str]) -> frozenset[str]:
    """The scene nodes that a browser with these layers hides, with all below them."""
    return frozenset(root for layer, roots in ROOTS.items() if layer not in layers for root in roots)


@dataclass
class BrowserSession:
    """One connection of one browser; it ends with the connection."""

    page: int
    """Which; never given to another one in the life of this ground station."""
    vehicle: str
    """The name of the one that it shows and commands."""
    layers: set[str] = field(default_factory=lambda: set(SHOWN_AT_FIRST))
    """What it shows of the scene."""
    camera: str = ""
    """The field of the vehicle whose picture is on show, where it has that camera."""
    looked_at: float = -inf
    """When it last said that somebody has the picture before his eyes [s, wall]."""
    to_confirm: tuple[str, bool, float] | None = None
    """(vehicle, arm or disarm, when [s, wall]) of the first of the two clicks that arming takes."""
