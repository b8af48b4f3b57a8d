import numpy as np
import pytest

from tests.planning.coverage.shapes import HOLE, SQUARE
from uvf.planning.coverage.field import join_fields, make_field


@pytest.mark.parametrize("outline", [SQUARE, SQUARE[::-1], np.repeat(SQUARE, 3, axis=0), np.vstack((SQUARE, SQUARE[:1]))])
def test_either_way_round_and_repeated_corners_are_the_same_field(outline):
    field = make_field(outline, [HOLE[::-1]])
    assert field.area == pytest.approx(300 * 200 - 60 * 70)
    assert field.hole_count == 1
    ((ring, holes),) = field.parts
    signed = [float(r[:, 0] @ np.roll(r[:, 1], -1) - r[:, 1] @ np.roll(r[:, 0], -1)) for r in (ring, *holes)]
    assert signed[0] > 0 > signed[1]


def test_collinear_corners_do_no_harm():
    assert make_field(np.insert(SQUARE, 1, [150.0, 0.0], axis=0)).area == pytest.approx(60_000)


def test_a_ring_that_crosses_itself_is_taken_by_what_it_encloses_and_says_so():
    bow = make_field(SQUARE[[0, 2, 1, 3]])
    assert bow.area == pytest.approx(30_000)
    assert len(bow.parts) == 2
    assert "outline" in bow.notes[0] and "150" in bow.notes[0]


def test_holes_may_touch_split_overlap_or_miss_the_field():
    split = make_field(SQUARE, [np.array([[100, -1], [110, -1], [110, 201], [100, 201]])])
    assert split.area == pytest.approx(60_000 - 2_000) and len(split.parts) == 2 and "splits" in split.notes[0]
    touching = make_field(SQUARE, [np.array([[0, 100], [40, 80], [40, 120]])])
    assert touching.area == pytest.approx(60_000 - 800)
    twice = make_field(SQUARE, [HOLE, HOLE + 10.0])
    assert twice.area == pytest.approx(60_000 - (2 * 4_200 - 50 * 60))
    assert "outside" in make_field(SQUARE, [HOLE + 900.0]).notes[0]


@pytest.mark.parametrize(
    ("outline", "holes", "why"),
    [
        (np.zeros((0, 2)), [], "0 different corners"),
        (SQUARE[:2], [], "2 different corners"),
        (np.zeros((9, 2)), [], "1 different corners"),
        (np.array([[0, 0], [1, 1], [2, 2], [7, 7]]), [], "on a line"),
        (np.array([[0, 0], [1, np.nan], [2, 0]]), [], "corner 1 of the outline"),
        (np.array([[0, 0], [np.inf, 1], [2, 0]]), [], "corner 1 of the outline"),
        (np.arange(12.0).reshape(4, 3), [], r"shape \(4, 3\)"),
        (np.array([[0, 0], [1e9, 0], [0, 1e9]]), [], "local frame"),
        (SQUARE, [SQUARE * 2 - 50], "leave nothing"),
        (SQUARE, [HOLE, np.zeros((3, 2))], "hole 1"),
    ],
)
def test_what_is_no_field_is_refused_in_one_line(outline, holes, why):
    with pytest.raises(ValueError, match=why) as error:
        make_field(outline, holes)
    assert "\n" not in str(error.value)


def test_what_is_left_inside_a_border_is_nothing_where_it_is_wider_than_the_field():
    assert make_field(SQUARE).shrunk(50.0).area == pytest.approx(200 * 100)
    assert make_field(SQUARE).shrunk(101.0) is None


def test_fields_joined_overlap_once():
    assert join_fields([make_field(SQUARE), make_field(SQUARE + np.array((150.0, 0.0)))]).area == pytest.approx(90_000)
    with pytest.raises(ValueError, match="at least one"):
        join_fields([])
