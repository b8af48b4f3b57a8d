"""A fence in the scene: zones to stay in as walls with edges, zones to keep out of with diagonals and in red; floor and ceiling."""

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Fence, FenceZone
from services.gcs.view.drawing import Colour, MeshNode, Node, Polyline

Floats = NDArray[np.float64]

KEEP_OUT: Colour = (240, 70, 60)
CORNERS = 48  # of a circle
POSTS = 8  # of a circle
OPEN_ABOVE = 100.0  # m of wall shown where there is no ceiling
ON_GROUND = (0.02, 0.25)  # m: what is shown of a wall that only a ground vehicle minds
WALL, WALL_OUT = 0.07, 0.2  # opacity


def fence_nodes(fence: Fence, colour: Colour, flies: bool) -> dict[str, Node]:
    """Scene nodes of a fence by the end of their name; ``colour`` is that of inclusion zones. None without zones."""
    nodes: dict[str, Node] = {}
    for i, zone in enumerate(fence.zones):
        shade, opacity = (KEEP_OUT, WALL_OUT) if zone.excludes else (colour, WALL)
        ring, posts = outline(zone)
        low, high = _heights(fence) if flies else ON_GROUND
        closed = not flies or fence.HasField("ceiling")
        nodes[f"/{i}/edge"] = Polyline(_stroke(ring, posts, (low, high), (zone.excludes, closed)), shade, 2.5)
        nodes[f"/{i}/wall"] = MeshNode(*_wall(ring, low, high), shade, opacity)
    return nodes


def outline(zone: FenceZone) -> tuple[Floats, list[int]]:
    """The outline (n, 2) [m, world] of a zone, not closed, and the indices of the points that get a post."""
    if zone.vertices:
        return np.array([(v.x, v.y) for v in zone.vertices]), list(range(len(zone.vertices)))
    turns = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
    ring = np.array((zone.centre.x, zone.centre.y)) + zone.radius * np.column_stack((np.cos(turns), np.sin(turns)))
    return ring, list(range(0, CORNERS, CORNERS // POSTS))


def _heights(fence: Fence) -> tuple[float, float]:
    """m, of an aircraft's fence."""
    low = fence.floor if fence.HasField("floor") else min(0.0, fence.ceiling if fence.HasField("ceiling") else 0.0)
    return low, fence.ceiling if fence.HasField("ceiling") else low + OPEN_ABOVE


def _stroke(ring: Floats, posts: list[int], heights: tuple[float, float], style: tuple[bool, bool]) -> Floats:
    """(n, 3) m: ring below, posts, ring above if it is closed there, diagonals of what is kept out of; drawn in one stroke."""
    low, high = heights
    crossed, closed = style
    below = [(*map(float, p), low) for p in (*ring, ring[0])]
    points = list(below)
    for start, end in zip(posts, [*posts[1:], len(ring)], strict=True):
        along = below[start : end + 1]
        points.append((*along[0][:2], high))
        points += [(x, y, high) for x, y, _ in along] if closed else [along[0]]
        points += along[::-1] if crossed and closed else []
        points += [(*along[0][:2], high), along[-1]] if crossed else []
        points += [along[-1]] if closed else along[1:]
    return np.array(points)


def _wall(ring: Floats, low: float, high: float) -> tuple[Floats, NDArray[np.int64]]:
    n = len(ring)
    vertices = np.vstack([np.column_stack((ring, np.full(n, z))) for z in (low, high)])
    here, after = np.arange(n), (np.arange(n) + 1) % n
    faces = np.vstack((np.column_stack((here, after, after + n)), np.column_stack((here, after + n, here + n))))
    return vertices, faces
