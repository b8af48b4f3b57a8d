"""Costs round obstacles, in the values of ROS' costmap_2d: 0 free, 1-252 nearer and nearer, 253 inscribed, 254 lethal, 255 unknown."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.grids import distance_field

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FREE_SPACE, MAX_NON_OBSTACLE, INSCRIBED, LETHAL, NO_INFORMATION = 0, 252, 253, 254, 255


@dataclass(frozen=True)
class Inflation:
    """How far obstacles are felt, and how steeply costs fall off; Nav2's parameters of the same names."""

    inflation_radius: float  # m from the obstacle, beyond which there is no cost
    cost_scaling_factor: float  # 1/m, rate of decay from the inscribed radius on


@compiled
def inflated(distance: Floats, resolution: float, inscribed: float, inflation: tuple[float, float]) -> Bytes:
    """Values (rows, columns) by the distance [cells] from centre to centre of the nearest obstacle.

    inscribed: [m]; inflation: (radius [m], cost scaling factor [1/m]). (costmap_2d, InflationLayer::computeCost.)
    """
    out = np.empty(distance.shape, dtype=np.uint8)
    rows, columns = distance.shape
    for r in range(rows):
        for c in range(columns):
            d = distance[r, c] * resolution
            if d <= 0.0:
                out[r, c] = LETHAL
            elif d <= inscribed:
                out[r, c] = INSCRIBED
            elif d > inflation[0]:
                out[r, c] = FREE_SPACE
            else:
                out[r, c] = int(MAX_NON_OBSTACLE * np.exp(-inflation[1] * (d - inscribed)))
    return out


def inflate(values: Bytes, resolution: float, inscribed: float, inflation: Inflation) -> tuple[Bytes, Floats]:
    """Values (rows, columns) with costs round every lethal cell, and the distance field [cells, centre to centre].

    Unknown cells stay unknown, unless they lie within the inscribed radius [m] of an obstacle (Nav2: ``inflate_unknown`` false).
    """
    distance = distance_field(values == LETHAL)
    costs = inflated(distance, resolution, inscribed, (inflation.inflation_radius, inflation.cost_scaling_factor))
    keep = (values == NO_INFORMATION) & (costs < INSCRIBED)
    out = np.maximum(costs, np.where(values == NO_INFORMATION, 0, values)).astype(np.uint8)
    out[keep] = NO_INFORMATION
    return out, distance


def cost_factors(cost_travel_multiplier: float, unknown: float = -1.0) -> Floats:
    """(256,) factors [-] on a path's length by value: 1 + multiplier * value / 252; negative = impassable.

    cost_travel_multiplier: 0 or more [-], as Nav2's Smac planners call it; unknown: factor of unknown ground, 1 or more, or negative.
    """
    factors = 1.0 + cost_travel_multiplier * np.arange(256) / MAX_NON_OBSTACLE
    factors[INSCRIBED : NO_INFORMATION + 1] = (-1.0, -1.0, unknown)
    return factors
