"""An octree as boxes where it is occupied, coloured by height, no more than a browser draws with ease."""

import numpy as np

from schemas.messages import OctreeMap
from services.gcs.view.drawing import Boxes
from uvf.models.yaml_data import BadInput

MOST = 12_000
LOW, HIGH = np.array((40, 90, 200)), np.array((250, 220, 90))


def octree_boxes(message: OctreeMap) -> Boxes | None:
    """The boxes [m, world]; None where nothing is occupied, or the message holds no octree."""
    from uvf.slam.octree.files import read_octree  # compiled code, which a page without this layer need not load
    from uvf.slam.octree.leaves import DEPTH, Leaves, TooLarge, boxes, coarser, leaves_of

    try:
        octree = read_octree(message.data, "the octree on the bus")
        every = leaves_of(octree)
    except (BadInput, TooLarge):
        return None
    on = every.values > 0
    leaves, depth = Leaves(every.codes[on], every.depths[on], every.values[on]), DEPTH
    while len(leaves.codes) > MOST:
        depth -= 1
        leaves = coarser(leaves, depth)
    if not len(leaves.codes):
        return None
    middles, sides = boxes(leaves, octree.resolution)
    low, high = middles[:, 2].min(), middles[:, 2].max()
    share = ((middles[:, 2] - low) / max(high - low, 1e-9))[:, None]
    return Boxes(middles, sides, (LOW * (1 - share) + HIGH * share).astype(np.uint8))
