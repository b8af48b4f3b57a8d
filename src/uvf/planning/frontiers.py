"""Frontiers: where known free ground meets unknown ground, and which one to drive to next (Yamauchi 1997)."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.grids import distance_field
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.information_gain import unknown_area, utility

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Cell = tuple[int, int]

REACH = 3.5  # m that a vehicle is taken to see, where frontiers are chosen by what could be seen
MOST_SIZE = 60  # cells of a frontier beyond which it is worth no more
ALL_ROUND = np.ones((3, 3), dtype=int)


@dataclass(frozen=True)
class Frontier:
    """A connected frontier and the cell from which to look at it."""

    goal: Cell
    """Where to go to look at it."""
    size: int
    """Cells."""
    way: float
    """Cost of the way there [cells]."""


class FrontierChoice(Enum):
    """Which frontier is best."""

    NEAREST = "nearest"
    SIZE = "size"
    """Near and wide."""
    INFORMATION_GAIN = "information_gain"
    """From where much unknown ground could be seen, and near."""


@dataclass(frozen=True)
class FrontierWeights:
    """What makes a frontier worth going to."""

    least_size: int  # cells; smaller ones are cracks
    view: float  # m from the frontier from which it is seen well enough
    worth: float  # cells of way that one cell of frontier is worth, where they are chosen by size
    choice: FrontierChoice = FrontierChoice.SIZE


def frontier_mask(costs: Costmap) -> Mask:
    """Mask (rows, columns) of free cells beside unknown ones, not along obstacles."""
    beside_unknown = ndimage.binary_dilation(costs.unknown)
    mask: Mask = costs.free & beside_unknown & (costs.clearance > costs.resolution)
    return mask


def frontiers(costs: Costmap, way: Floats, shunned: Mask, taste: FrontierWeights) -> list[Frontier]:
    """Frontiers that can be seen from a reachable cell, best first.

    way: (rows, columns), cost to go [cells], inf where no path leads; shunned: mask (rows, columns) of cells that do not count.
    """
    labels, _ = ndimage.label(frontier_mask(costs) & ~shunned, structure=ALL_ROUND)
    reachable = np.isfinite(way)
    found = []
    margin = int(np.ceil(taste.view / costs.resolution))
    for label, box in enumerate(ndimage.find_objects(labels), start=1):
        window = tuple(slice(max(s.start - margin, 0), s.stop + margin) for s in box)
        cluster = labels[window] == label
        size = int(cluster.sum())
        if size < taste.least_size:
            continue
        near = distance_field(cluster) * costs.resolution <= taste.view
        cost = np.where(near & reachable[window], way[window], np.inf)
        best = np.unravel_index(int(np.argmin(cost)), cost.shape)
        if np.isfinite(cost[best]):
            goal = (int(best[0]) + window[0].start, int(best[1]) + window[1].start)
            found.append(Frontier(goal, size, float(cost[best])))
    if taste.choice == FrontierChoice.INFORMATION_GAIN:
        taken = ~costs.free & ~costs.unknown
        return sorted(found, key=lambda f: (-_gain(f, costs, taken), f.goal))
    worth = 0.0 if taste.choice == FrontierChoice.NEAREST else taste.worth
    return sorted(found, key=lambda f: (f.way - worth * min(f.size, MOST_SIZE), f.goal))


def _gain(frontier: Frontier, costs: Costmap, taken: Mask) -> float:
    """Worth of what could be seen from there, less for a long way."""
    area = unknown_area(costs.unknown, taken, frontier.goal, REACH / costs.resolution) * costs.resolution**2
    return utility(area, frontier.way * costs.resolution)
