"""The octree and what is seen of it from above as messages."""

from schemas.messages import Grid, OctreeMap
from uvf.runtime.messages.convert import occupancy_grid, stamp
from uvf.runtime.messages.maps.height_grids import heights_message
from uvf.slam.octree.columns import Columns
from uvf.slam.octree.files import read_octree, to_bt
from uvf.slam.octree.leaves import DEPTH, coarser, leaves_of
from uvf.slam.octree.octree import Octree

FRAME = "world"


def octree_message(octree: Octree, most: int, t: float) -> OctreeMap:
    """The whole map stamped ``t`` [s], coarsened by doubling its cells until its file has at most ``most`` bytes. Raises TooLarge."""
    leaves, depth = leaves_of(octree), DEPTH
    data = to_bt(leaves, octree.resolution)
    while len(data) > most and depth > 1:
        depth -= 1
        leaves = coarser(leaves, depth)
        data = to_bt(leaves, octree.resolution)
    return OctreeMap(timestamp=stamp(t), frame_id=FRAME, resolution=octree.resolution, depth=depth, data=data)


def octree_from(message: OctreeMap) -> Octree:
    """The octree of a message. Raises BadInput."""
    return read_octree(message.data, f"the octree told at {message.timestamp.seconds} s")


def slice_message(columns: Columns, t: float) -> Grid:
    """The horizontal slice as an occupancy grid in the world frame, stamped ``t`` [s]."""
    return occupancy_grid(columns.slice, columns.resolution, columns.x, columns.y, FRAME, t)


def heights_of_columns(columns: Columns, t: float) -> Grid:
    """The grid of heights stamped ``t`` [s]."""
    return heights_message(columns.top, columns.ground, columns.resolution, (columns.x, columns.y), t)
