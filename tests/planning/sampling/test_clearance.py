"""Sphere stepping against a look at every point."""

import math

import numpy as np
import pytest

from tests.planning.sampling.grounds import SIDE, blocks, wall
from uvf.maths.curves.segments import end_of, sampled
from uvf.planning.sampling.clearance import clearance_field, disc, discs, free_length, is_free_way, rectangle, room


def free_at(ground, at):
    for offset, radius in zip(ground.body.offsets, ground.body.radii, strict=True):
        row = math.floor((at[1] + offset * math.sin(at[2])) / SIDE)
        column = math.floor((at[0] + offset * math.cos(at[2])) / SIDE)
        rows, columns = ground.field.values.shape
        if not (0 <= row < rows and 0 <= column < columns and ground.field.values[row, column] >= radius):
            return False
    return True


@pytest.mark.parametrize("body", [disc(0.0), disc(0.15), rectangle(0.5, 0.3, 0.3, 3)])
def test_what_is_free_is_free_at_every_point_and_little_else_is_refused(body):
    ground, rng = blocks(3, body), np.random.default_rng(1)
    free, refused, open_ways = 0, 0, 0
    for _ in range(400):
        start = (rng.uniform(0, 20), rng.uniform(0, 12), rng.uniform(-4, 4))
        segments = np.column_stack((rng.uniform(-2, 2, 3), rng.uniform(-1.5, 1.5, 3)))
        length = np.abs(segments[:, 0]).sum()
        points = sampled(start, segments, np.linspace(0, length, math.ceil(length / (0.02 * SIDE))))
        every = all(free_at(ground, p) for p in points.tolist())
        found = is_free_way(ground.field, body, start, segments, 1.0)
        assert every or not found
        free, refused, open_ways = free + found, refused + (every and not found), open_ways + every
    assert free > 50
    assert refused <= 0.03 * open_ways  # those that pass the corner of a cell within a hair


def test_the_free_length_ends_before_the_wall():
    ground = wall(slice(0, 0))
    found = free_length(ground.field, ground.body, (1.0, 5.0, 0.0), np.array([[8.0, 0.0]]), 1.0)
    assert 4.9 - 0.15 - 2 * SIDE <= 1.0 + found <= 4.9 - 0.1
    assert free_length(ground.field, ground.body, (4.85, 5.0, 0.0), np.array([[1.0, 0.0]]), 1.0) == -1.0


def test_a_footprint_that_looks_back_has_its_discs_behind():
    ground = wall(slice(0, 0), discs([(0.0, 0.1), (0.6, 0.1)]))
    still = np.array([[0.05, 0.0]])
    assert not is_free_way(ground.field, ground.body, (4.3, 5.0, 0.0), still, 1.0)
    assert is_free_way(ground.field, ground.body, (4.3, 5.0, 0.0), still, -1.0)


def test_room_never_says_more_than_there_is():
    ground, rng = blocks(5), np.random.default_rng(0)
    for x, y in rng.uniform((0, 0), (20, 12), (2000, 2)):
        far = room(ground.field, x, y, 0.15)
        assert (far >= 0) == free_at(ground, (x, y, 0.0))
        for angle in rng.uniform(0, 2 * math.pi, 5):
            reach = far * 0.999
            assert far <= 0 or free_at(ground, (x + reach * math.cos(angle), y + reach * math.sin(angle), 0.0))


def test_a_rectangle_is_covered_by_its_discs():
    body, rng = rectangle(0.5, 0.2, 0.4, 4), np.random.default_rng(2)
    points = rng.uniform((-0.2, -0.2), (0.5, 0.2), (5000, 2))
    gaps = np.hypot(points[:, :1] - body.offsets, points[:, 1:]) - body.radii
    assert (gaps.min(axis=1) <= 1e-12).all()


def test_a_field_without_obstacles_or_cells():
    field = clearance_field(np.zeros((5, 5), dtype=bool), 1.0)
    assert is_free_way(field, disc(0.3), (0.5, 0.5, 0.0), np.array([[3.0, 0.0]]), 1.0)
    assert not is_free_way(field, disc(0.3), (0.5, 0.5, 0.0), np.array([[5.0, 0.0]]), 1.0)
    assert end_of((0.5, 0.5, 0.0), np.array([[3.0, 0.0]])) == (3.5, 0.5, 0.0)
    with pytest.raises(ValueError, match="at least one of each"):
        clearance_field(np.zeros((0, 5), dtype=bool), 1.0)
    with pytest.raises(ValueError, match="resolution"):
        clearance_field(np.zeros((5, 5), dtype=bool), 0.0)
    with pytest.raises(ValueError, match="radius negative"):
        disc(-1.0)
