"""An octree as boxes where it is occupied, coloured by height, no more than a browser draws with ease."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from schemas.messages import OctreeMap
from services.gcs.view.drawing import Boxes
from uvf.models.yaml_data import BadInput

if TYPE_CHECKING:
    from uvf.slam.octree.leaves import Leaves

Floats = NDArray[np.float64]

MOST = 30_000
LEVEL = 0.5  # m of height that count as one level
COARSEST = 8  # depth
LOW, HIGH = np.array((40, 90, 200)), np.array((250, 220, 90))


def octree_boxes(message: OctreeMap) -> Boxes | None:
    """The boxes [m, world]; None where nothing is occupied, or the message holds no octree."""
    from uvf.slam.octree.files import read_octree  # compiled code, which a page without this layer need not load
    from uvf.slam.octree.leaves import Leaves, TooLarge, leaves_of

    try:
        octree = read_octree(message.data, "the octree on the bus")
        every = leaves_of(octree)
    except (BadInput, TooLarge):
        return None
    on = every.values > 0
    occupied = Leaves(every.codes[on], every.depths[on], every.values[on])
    if not len(occupied.codes):
        return None
    middles, sides = _within(occupied, octree.resolution)
    low, high = middles[:, 2].min(), middles[:, 2].max()
    share = ((middles[:, 2] - low) / max(high - low, 1e-9))[:, None]
    return Boxes(middles, sides, (LOW * (1 - share) + HIGH * share).astype(np.uint8))


def _within(leaves: "Leaves", resolution: float) -> tuple[Floats, Floats]:
    """Middles and sides of at most ``MOST`` boxes: the ground, most of what an aircraft sees, is made coarser before what stands on it."""
    from uvf.slam.octree.leaves import DEPTH, boxes, coarser

    heights = np.floor(boxes(leaves, resolution)[0][:, 2] / LEVEL).astype(np.int64)
    levels, counts = np.unique(heights, return_counts=True)
    is_ground = heights == levels[counts.argmax()]
    parts = [_chosen(leaves, is_ground), _chosen(leaves, ~is_ground)]
    for n, part in enumerate(parts):
        depth = DEPTH
        while sum(len(one.codes) for one in parts) > MOST and depth > COARSEST and len(parts[n].codes) > MOST // 4:
            depth -= 1
            parts[n] = coarser(part, depth)
    both = [boxes(part, resolution) for part in parts]
    return np.concatenate([one[0] for one in both]), np.concatenate([one[1] for one in both])


def _chosen(leaves: "Leaves", which: NDArray[np.bool_]) -> "Leaves":
    return type(leaves)(leaves.codes[which], leaves.depths[which], leaves.values[which])
