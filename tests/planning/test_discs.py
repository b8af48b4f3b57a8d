"""Vehicles of the team as obstacles: those that the lidar looks over, and those that come nearer."""

import numpy as np
import pytest

from uvf.planning.costmap.discs import MOMENTS, NEAREST, SPACING, coming, disc_points, unseen

NOTHING = np.zeros((0, 2))
HERE = (1.0, -2.0)


def at(*discs):
    return np.array(discs).reshape(-1, 3)


@pytest.mark.parametrize("radius", [0.02, 0.1, 0.33, 2.5])
def test_points_cover_the_disc_and_nothing_else(radius):
    points = disc_points(at((3.0, 1.0, radius)), HERE, 5.0)
    away = np.hypot(*(points - (3.0, 1.0)).T)
    assert away.max() <= radius + 1e-9
    assert away.max() > radius - 1.5 * SPACING
    assert len(points) * SPACING**2 == pytest.approx(np.pi * radius**2, abs=8 * radius * SPACING + SPACING**2)


def test_what_is_far_or_here_is_left_out():
    for x, y, counts in ((9.0, 1.0, False), (1.1, -2.0, False), (1.3, -2.0, True)):
        assert (len(disc_points(at((x, y, 0.2)), HERE, 5.0)) > 0) == counts


def test_of_a_crowd_the_nearest_count():
    crowd = np.column_stack((np.linspace(1.5, 4.0, 100), np.full(100, -2.0), np.full(100, 0.01)))
    points = disc_points(crowd[::-1], HERE, 5.0)
    assert len(points) == NEAREST
    assert points[:, 0].max() < 2.0


def test_what_is_seen_is_known_better():
    seen = np.array(((2.75, 0.85), (2.8, 0.8), (2.9, 0.7), (7.0, 7.0)))
    discs = at((3.0, 1.0, 0.3), (2.2, 1.0, 0.2), (-1.0, 0.0, 0.1))
    assert unseen(discs, seen, HERE).tolist() == discs[1:].tolist()
    assert unseen(discs, NOTHING, HERE).tolist() == discs.tolist()


@pytest.mark.parametrize("forward", [-0.1, 0.0, 0.1])
def test_a_lidar_on_top_does_not_show_the_body_below_it(forward):
    round_about = np.linspace(0, 6.2, 60)
    lidar = np.array((3.0 + forward, 1.0)) + 0.035 * np.column_stack((np.cos(round_about), np.sin(round_about)))
    assert len(unseen(at((3.0, 1.0, 0.2)), lidar, HERE)) == 1


@pytest.mark.parametrize("heading", np.linspace(0.0, 2 * np.pi, 9))
@pytest.mark.parametrize("slant", np.linspace(0.0, 1.5, 8))
@pytest.mark.parametrize("beside", [-0.3, -0.16, 0.16, 0.3])
def test_a_wall_that_one_stands_along_does_not_show_it(heading, slant, beside):
    """A disc 0.2 m in radius with a wall 0.16 m beside its middle, as of a narrow body, looked at along the wall and towards it."""
    along, across = np.array((np.cos(heading), np.sin(heading))), np.array((-np.sin(heading), np.cos(heading)))
    disc = np.array((3.0, 1.0))
    wall = disc + beside * across + np.linspace(-3.0, 3.0, 121)[:, None] * along
    way = np.cos(slant) * along + np.sin(slant) * np.sign(beside) * across
    assert len(unseen(at((*disc, 0.2)), wall, tuple(disc - 1.5 * way))) == 1


def test_a_body_is_shown_though_it_is_a_little_away_from_where_it_says():
    body = np.array((3.0, 1.0)) + 0.12 * np.column_stack((np.cos(np.linspace(0, 6.2, 40)), np.sin(np.linspace(0, 6.2, 40))))
    for x, y in ((0.0, 0.0), (0.12, 0.0), (-0.12, 0.0), (0.0, 0.12), (0.0, -0.12), (0.1, 0.1), (-0.1, -0.1)):
        assert len(unseen(at((3.0 + x, 1.0 + y, 0.2)), body, HERE)) == 0, (x, y)


def test_who_moves_is_looked_at_on_its_way_and_who_stands_is_not():
    found = coming(at((3.0, 1.0, 0.2), (2.4, 1.0, 0.1)), np.array(((-0.4, 0.2), (0.0, 0.0))), 2.0)
    assert found.shape == (MOMENTS, 3)
    assert found[-1].tolist() == pytest.approx([2.2, 1.4, 0.2])
    assert (np.diff(found[:, 0]) < 0.0).all()


def test_nobody_covers_nothing():
    nobody = np.zeros((0, 3))
    assert disc_points(nobody, HERE, 5.0).shape == (0, 2)
    assert unseen(nobody, NOTHING, HERE).shape == (0, 3)
    assert coming(nobody, NOTHING, 1.0).shape == (0, 3)
