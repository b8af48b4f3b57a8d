"""Signed distances to areas, and regions made of them."""

import itertools
import math

import numpy as np
import pytest

from uvf.maths.zones import Disc, Overlap, Polygon, Region

SQUARE = Polygon([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
L_SHAPE = Polygon([(0.0, 0.0), (100.0, 0.0), (100.0, 40.0), (40.0, 40.0), (40.0, 100.0), (0.0, 100.0)])
HOLE = Disc((50.0, 50.0), 10.0)


def at(area, *points):
    return area.inside(np.array(points)).tolist()


def test_distance_to_a_polygon_is_positive_inside_and_negative_outside():
    assert at(SQUARE, (50.0, 50.0), (10.0, 50.0), (-5.0, 50.0), (103.0, 104.0)) == pytest.approx([50.0, 10.0, -5.0, -5.0])


def test_a_notch_is_outside_and_its_corner_is_the_nearest_point():
    assert at(L_SHAPE, (70.0, 70.0), (37.0, 36.0)) == pytest.approx([-30.0, 5.0])


@pytest.mark.parametrize("turned", [0.0, 0.4, 2.0])
def test_neither_the_way_round_nor_the_place_of_a_polygon_matters(turned):
    rng = np.random.default_rng(3)
    points = rng.uniform(-50, 150, (200, 2))
    rotation = np.array(((math.cos(turned), -math.sin(turned)), (math.sin(turned), math.cos(turned))))
    corners = (np.array(L_SHAPE.vertices) @ rotation.T + (7.0, -3.0))[::-1]
    same = Polygon([tuple(c) for c in corners]).inside(points @ rotation.T + (7.0, -3.0))
    assert same == pytest.approx(L_SHAPE.inside(points))


def test_distances_agree_with_a_dense_outline():
    rng = np.random.default_rng(1)
    points = rng.uniform(-20, 120, (300, 2))
    corners = np.array([*L_SHAPE.vertices, L_SHAPE.vertices[0]])
    outline = np.vstack([a + np.linspace(0, 1, 2001)[:, None] * (b - a) for a, b in itertools.pairwise(corners)])
    nearest = np.array([np.hypot(*(outline - p).T).min() for p in points])
    assert np.abs(L_SHAPE.inside(points)) == pytest.approx(nearest, abs=0.03)


def test_edges_that_cross_are_found():
    assert SQUARE.crossing is None
    assert L_SHAPE.crossing is None
    assert Polygon([(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]).crossing == (0, 2)


def test_a_region_is_one_of_its_areas_less_all_that_are_cut_out():
    region = Region((SQUARE, Disc((150.0, 50.0), 60.0)), (HOLE,))
    assert region.at((75.0, 50.0)) == pytest.approx(15.0)
    assert region.at((95.0, 50.0)) == pytest.approx(5.0)
    assert region.at((52.0, 50.0)) == pytest.approx(-8.0)
    assert region.at((300.0, 50.0)) == pytest.approx(-90.0)


def test_without_areas_a_region_is_everywhere():
    assert Region().at((1e6, 0.0)) == math.inf
    assert Region(exclude=(HOLE,)).at((1000.0, 50.0)) == pytest.approx(940.0)


def test_clearance_changes_no_faster_than_the_point():
    region = Region((SQUARE, L_SHAPE), (HOLE,))
    rng = np.random.default_rng(2)
    a, b = rng.uniform(-50, 150, (2, 500, 2))
    assert (np.abs(region.clearance(a) - region.clearance(b)) <= np.hypot(*(a - b).T) + 1e-9).all()


def test_a_way_through_a_hole_ends_at_its_edge():
    region = Region((SQUARE,), (HOLE,))
    assert region.leaves((10.0, 50.0), (90.0, 50.0)) == pytest.approx((40.0, 50.0), abs=0.6)
    assert region.leaves((10.0, 10.0), (90.0, 10.0)) is None
    assert region.leaves((10.0, 10.0), (90.0, 10.0), keep=11.0) == pytest.approx((10.0, 10.0))
    assert region.leaves((10.0, 10.0), (10.0, 10.0)) is None


def test_a_short_cut_through_a_notch_is_seen():
    assert Region((L_SHAPE,)).leaves((90.0, 20.0), (20.0, 90.0)) is not None


def test_room_is_found_near_by_and_else_where_there_is_most():
    region = Region((SQUARE,))
    place, room = region.roomiest((5.0, 50.0), 20.0)
    assert room >= 20.0 and math.dist(place, (5.0, 50.0)) < 18.0
    assert region.roomiest((50.0, 50.0), 20.0)[0] == (50.0, 50.0)
    assert region.roomiest((5.0, 50.0), 80.0)[1] == pytest.approx(50.0, abs=1.5)


def test_an_overlap_is_what_lies_within_all_of_its_areas():
    both = Overlap((SQUARE, Disc((100.0, 50.0), 30.0)))
    assert at(both, (90.0, 50.0), (105.0, 50.0), (50.0, 50.0)) == pytest.approx([10.0, -5.0, -20.0])
    assert both.box == ((70.0, 20.0), (100.0, 80.0))
    apart = Overlap((SQUARE, Disc((300.0, 50.0), 30.0)))
    assert Region((apart,)).at((150.0, 50.0)) < 0
