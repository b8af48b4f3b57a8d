"""Layers of the scene: what of it a browser shows or hides, and below which nodes it hangs."""

from collections.abc import Set

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
