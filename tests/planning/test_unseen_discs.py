"""Vehicles of the team that the lidar looks over are obstacles; those that it sees, or that cannot be there, are none."""

import numpy as np
import pytest

from uvf.planning.costmap.unseen_discs import NEAREST, SPACING, unseen_points

NOTHING = np.zeros((0, 2))
HERE = (1.0, -2.0)


def at(*discs):
    return np.array(discs).reshape(-1, 3)


@pytest.mark.parametrize("radius", [0.02, 0.1, 0.33, 2.5])
def test_points_cover_the_disc_and_nothing_else(radius):
    points = unseen_points(at((3.0, 1.0, radius)), NOTHING, HERE, 5.0)
    away = np.hypot(*(points - (3.0, 1.0)).T)
    assert away.max() <= radius + 1e-9
    assert away.max() > radius - 1.5 * SPACING
    assert len(points) * SPACING**2 == pytest.approx(np.pi * radius**2, abs=8 * radius * SPACING + SPACING**2)


def test_what_is_seen_or_far_or_here_is_left_out():
    seen = np.array(((2.9, 1.0),))
    assert len(unseen_points(at((3.0, 1.0, 0.2)), seen, HERE, 5.0)) == 0
    assert len(unseen_points(at((2.4, 1.0, 0.2)), seen, HERE, 5.0)) > 0
    assert len(unseen_points(at((9.0, 1.0, 0.2)), NOTHING, HERE, 5.0)) == 0
    assert len(unseen_points(at((1.1, -2.0, 0.2)), NOTHING, HERE, 5.0)) == 0
    assert len(unseen_points(at((1.3, -2.0, 0.2)), NOTHING, HERE, 5.0)) > 0


def test_of_a_crowd_the_nearest_count():
    crowd = np.column_stack((np.linspace(1.5, 4.0, 100), np.full(100, -2.0), np.full(100, 0.01)))
    points = unseen_points(crowd[::-1], NOTHING, HERE, 5.0)
    assert len(points) == NEAREST
    assert points[:, 0].max() < 2.0


def test_nobody_covers_nothing():
    assert unseen_points(np.zeros((0, 3)), NOTHING, HERE, 5.0).shape == (0, 2)
