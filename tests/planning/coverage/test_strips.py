import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.planning.coverage.shapes import HOLE, SQUARE, comb, raster_share
from uvf.planning.coverage.field import make_field
from uvf.planning.coverage.strips import StripRules, pieces_within, swaths


def lengths(lines):
    return np.hypot(*(lines[:, 2:] - lines[:, :2]).T)


def pieces(field, low, high, gap=0.0, least=1e-7, each=0.0):
    edges = field.edges
    out, events = np.empty((2 * len(edges) + 2, 3)), np.empty((4 * len(edges) + 2, 3))
    count, missed = pieces_within(edges, (low, high), np.array((gap, least, each)), events, out)
    return out[:count], missed


def clipped(field, low, high):
    """The same with shapely: what each part of the field in the strip spans, joined where they overlap."""
    part = field.shape.intersection(shapely.box(-1e6, low, 1e6, high))
    spans = sorted((p.bounds[0], p.bounds[2]) for p in shapely.get_parts(part) if p.area > 1e-6)
    joined = []
    for begin, end in spans:
        if joined and begin <= joined[-1][1] + 1e-6:
            joined[-1][1] = max(joined[-1][1], end)
        else:
            joined.append([begin, end])
    return np.array(joined).reshape(-1, 2), part.area


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000), st.floats(-50.0, 250.0), st.floats(1.0, 60.0))
def test_pieces_in_a_strip_are_those_of_a_clipped_polygon(seed, low, height):
    field = comb(np.random.default_rng(seed))
    found, missed = pieces(field, low, low + height)
    expected, area = clipped(field, low, low + height)
    assert found[:, :2] == pytest.approx(expected, abs=1e-4)
    assert found[:, 2].sum() == pytest.approx(area, abs=1e-3)
    assert missed < 1e-3


def test_level_edges_on_the_border_of_a_strip_belong_to_the_side_of_the_field():
    field = make_field(SQUARE, [HOLE])
    assert pieces(field, 40.0, 60.0)[0][:, :2].tolist() == [[0.0, 300.0]]
    assert pieces(field, 60.0, 130.0)[0][:, :2].tolist() == [[0.0, 100.0], [160.0, 300.0]]
    assert pieces(field, 130.0, 200.0)[0][:, :2].tolist() == [[0.0, 300.0]]
    assert len(pieces(field, 200.0, 210.0)[0]) == 0
    assert len(pieces(field, -10.0, 0.0)[0]) == 0


def test_a_slanted_end_is_cut_off_where_less_than_the_height_left_out_is_there():
    triangle = make_field(np.array([[0.0, 0.0], [100.0, 0.0], [0.0, 10.0]]))
    found, missed = pieces(triangle, 0.0, 10.0, least=2.0)
    assert found[0, :2] == pytest.approx([0.0, 80.0])
    assert missed == pytest.approx(20.0 * 2.0 / 2)
    assert found[0, 2] + missed == pytest.approx(500.0)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.0, 3.1), st.floats(7.0, 50.0))
def test_every_point_of_the_field_lies_in_a_swath(seed, direction, width):
    field = comb(np.random.default_rng(seed))
    assert raster_share(field, swaths(field.edges, direction, StripRules(width)), width, 2.0) == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_directions_along_and_across_edges_cover_all(seed):
    """Edges across the swaths are as good as upright: their slopes are as large as numbers can be."""
    field = comb(np.random.default_rng(seed))
    for x0, y0, x1, y1 in field.edges:
        for turned in (0.0, np.pi / 2):
            lines = swaths(field.edges, np.arctan2(y1 - y0, x1 - x0) + turned, StripRules(15.0, 100.0, 4.0, 0.996))
            assert raster_share(field, lines, 15.0, 3.0) > 0.99


def test_swaths_of_a_square_are_no_longer_than_need_be_and_follow_its_direction():
    field = make_field(SQUARE)
    lines = swaths(field.edges, 0.0, StripRules(20.0))
    assert len(lines) == 10
    assert lengths(lines).sum() == pytest.approx(field.area / 20.0)
    assert np.unique(lines[:, 1]) == pytest.approx(np.arange(10.0, 200.0, 20.0))


def test_leaving_a_little_out_saves_more_length_than_area():
    field = comb(np.random.default_rng(4))
    whole = lengths(swaths(field.edges, 0.3, StripRules(20.0))).sum()
    lines = swaths(field.edges, 0.3, StripRules(20.0, share=0.995))
    assert raster_share(field, lines, 20.0) >= 0.994
    assert lengths(lines).sum() < 0.98 * whole


def test_a_step_of_the_border_lies_between_strips():
    """Even strips, 20 m each, would all go along the long lower part up to y = 60; strips that end at the step need not."""
    step = make_field(np.array([[0, 0], [300, 0], [300, 50], [100, 50], [100, 110], [0, 110]]))
    lines = swaths(step.edges, 0.0, StripRules(20.0))
    assert (lengths(lines) > 200.0).sum() == 3
    assert lengths(lines).sum() == pytest.approx(3 * 300 + 3 * 100)


def test_more_strips_than_anybody_needs_are_refused():
    with pytest.raises(ValueError, match="wider spacing"):
        swaths(make_field(SQUARE).edges, 0.0, StripRules(0.001))
