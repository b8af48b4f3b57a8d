"""Made-up open country: trees, cars and sheds that stand far apart, and a road among them."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ROAD = 3.5  # m, to either side of its middle, where nothing stands
AROUND = 90.0  # m, beyond the road's corners, that things stand in
TREE_RADIUS, TREE_CORNERS = (0.15, 0.5), 8  # m
SIZES = ((4.2, 1.8), (7.0, 5.0))
"""m, of cars and of sheds."""


def scattered(road: Floats, area: float, rng: np.random.Generator) -> Floats:
    """(n, 4) walls x0 y0 x1 y1 [m] of things beside a road of corners (m, 2), one in each ``area`` [m^2]; three of five are trees."""
    low, high = road.min(axis=0) - AROUND, road.max(axis=0) + AROUND
    number = round(float(np.prod(high - low)) / area)
    places = rng.uniform(low, high, (number, 2))
    places = places[_distance_to(road, places) > ROAD + max(SIZES)[0]]
    outlines = [_tree(place, rng) if rng.uniform() < 0.6 else _box(place, rng) for place in places]
    return np.concatenate([np.column_stack((outline, np.roll(outline, -1, axis=0))) for outline in outlines])


def _tree(place: Floats, rng: np.random.Generator) -> Floats:
    angles = np.arange(TREE_CORNERS) * (2 * np.pi / TREE_CORNERS)
    outline: Floats = place + rng.uniform(*TREE_RADIUS) * np.column_stack((np.cos(angles), np.sin(angles)))
    return outline


def _box(place: Floats, rng: np.random.Generator) -> Floats:
    (length, width), yaw = SIZES[rng.integers(len(SIZES))], rng.uniform(0.0, np.pi)
    along, across = np.array((np.cos(yaw), np.sin(yaw))) * length / 2, np.array((-np.sin(yaw), np.cos(yaw))) * width / 2
    return place + np.array((along + across, along - across, -along - across, across - along))


def _distance_to(road: Floats, places: Floats) -> Floats:
    """(n,) m from places (n, 2) to the nearest stretch of the road."""
    nearest = np.full(len(places), np.inf)
    for start, end in pairwise(road):
        way = end - start
        share = np.clip((places - start) @ way / (way @ way), 0.0, 1.0)
        nearest = np.minimum(nearest, np.hypot(*(places - start - share[:, None] * way).T))
    return nearest
