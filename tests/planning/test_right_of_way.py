"""Two that meet at a door: one of them waits where the other can come by, and both decide alike."""

import numpy as np
import pytest

from uvf.planning.navigation.right_of_way import ROOM, Traveller, give_way, is_first_of_circle, that_meet
from uvf.planning.smoothing import first_part, from_place, length, resample

RADIUS = 0.125  # m
APART = 2 * RADIUS + ROOM


def path(*corners):
    return resample(np.array(corners, dtype=float))


def clearance(points):
    """A wall along x = 0 with a door of 0.5 m at y = 0."""
    return np.where(np.abs(points[:, 0]) < 0.3, 0.25, np.maximum(np.abs(points[:, 0]) - 0.05, 0.25))


def traveller(name, points, radius=RADIUS):
    return Traveller(name, points, radius)


def waits(own, *others):
    return give_way(own, clearance(own.path), others)


def meeting(mine, theirs, names=("a", "b")):
    """Who waits for whom when two come to the door from ``mine`` and ``theirs`` [m] before it."""
    first = traveller(names[0], path((-mine, 0.0), (3.0, 0.0)))
    second = traveller(names[1], path((theirs, 0.0), (-3.0, 0.0)))
    return [None if wait is None else wait.for_whom for wait in (waits(first, second), waits(second, first))]


@pytest.mark.parametrize(
    ("mine", "theirs", "expected"),
    [
        (1.0, 2.5, [None, "a"]),
        (2.5, 1.0, ["b", None]),
        (1.5, 1.6, [None, "a"]),
        (1.6, 1.5, [None, "a"]),
        (0.1, 0.9, [None, "a"]),
        (0.9, 0.1, ["b", None]),
    ],
    ids=["a is nearer", "b is nearer", "even", "even too", "a is in the door", "b is in the door"],
)
def test_exactly_one_waits_and_both_know_which(mine, theirs, expected):
    assert meeting(mine, theirs) == expected


def test_who_waits_does_so_off_the_way_of_the_other():
    own = traveller("b", path((3.0, 2.0), (1.0, 2.0), (1.0, 0.0), (-3.0, 0.0)))
    other = traveller("a", path((-1.0, 0.0), (3.0, 0.0)))
    place = first_part(own.path, waits(own, other).until)[-1]
    assert np.hypot(*(other.path - place).T).min() >= APART - 0.02
    assert place == pytest.approx((1.0, 0.4), abs=0.1)


def test_who_stands_in_the_way_already_stays():
    own = traveller("b", path((2.0, 0.0), (-3.0, 0.0)))
    assert waits(own, traveller("a", path((-0.8, 0.0), (3.0, 0.0)))).until == 0.0


@pytest.mark.parametrize(
    "other",
    [
        path((-0.6, 0.0), (3.0, 0.0)),
        path((-1.0, 2.0), (-1.0, -2.0)),
        path((2.0, 1.0), (3.0, 1.0)),
        np.zeros((0, 2)),
    ],
    ids=["drives ahead", "crosses before the door", "stays on its side", "stands"],
)
def test_nobody_waits_for_who_does_not_come_through(other):
    assert waits(traveller("b", path((-1.5, 0.0), (3.0, 0.0))), traveller("a", other)) is None


def test_a_passage_that_is_wide_enough_for_two_small_ones_is_not_for_a_small_and_a_large_one():
    """1 m wide."""
    mine, theirs = path((-1.5, 0.0), (3.0, 0.0)), path((1.0, 0.0), (-3.0, 0.0))
    for large, expected in ((0.2, None), (0.35, "a")):
        pair = traveller("b", mine), traveller("a", theirs, large)
        found = [give_way(a, np.where(np.abs(a.path[:, 0]) < 0.3, 0.5, 2.0), [b]) for a, b in (pair, pair[::-1])]
        assert [wait and wait.for_whom for wait in found] == [expected, None]


def test_it_waits_at_the_first_place_where_it_has_to():
    own = traveller("z", path((3.0, 2.0), (1.0, 2.0), (1.0, 0.0), (-3.0, 0.0)))
    small, large = (traveller(name, path((-1.0, 0.0), (3.0, 0.0)), radius) for name, radius in (("a", 0.1), ("b", 0.4)))
    waiting = [waits(own, small), waits(own, large), waits(own, small, large)]
    assert waiting[2] == min(waiting[:2]) == waiting[1]


def test_where_there_is_room_for_two_nobody_waits():
    own = traveller("b", path((-1.5, 0.0), (3.0, 0.0)))
    assert give_way(own, np.full(len(own.path), 0.5), [traveller("a", path((1.0, 0.0), (-3.0, 0.0)))]) is None


def test_a_path_is_cut_where_it_is_said():
    line = path((0.0, 0.0), (2.0, 0.0), (2.0, 1.0))
    assert length(first_part(line, 2.55)) == pytest.approx(2.55)
    assert first_part(line, 2.55)[-1] == pytest.approx((2.0, 0.55))
    assert len(first_part(line, 0.0)) == 1
    assert len(first_part(line, 99.0)) == len(line)
    rest, passed = from_place(line, (1.02, 0.1))
    assert passed == pytest.approx(1.0, abs=0.06)
    assert rest[0] == pytest.approx((1.02, 0.1))
    assert rest[-1] == pytest.approx((2.0, 1.0))
    assert from_place(np.zeros((0, 2)), (0.0, 0.0))[1] == 0.0


@pytest.mark.parametrize(
    ("own", "for_whom", "waiting", "drives"),
    [
        ("anne", "carl", {"carl": "anne"}, True),
        ("carl", "anne", {"anne": "carl"}, False),
        ("anne", "carl", {}, False),
        ("anne", "carl", {"carl": "bert"}, False),
        ("anne", "carl", {"carl": "bert", "bert": "anne"}, True),
        ("bert", "anne", {"anne": "carl", "carl": "bert"}, False),
        ("anne", "carl", {"carl": "bert", "bert": "carl"}, False),
    ],
)
def test_of_those_who_wait_for_each_other_the_first_by_name_drives(own, for_whom, waiting, drives):
    assert is_first_of_circle(own, for_whom, waiting) is drives


def test_who_comes_nowhere_near_makes_nobody_wait():
    rng = np.random.default_rng(4)
    waited = 0
    for _ in range(300):
        own, *others = (traveller(name, path(*rng.uniform(-3.0, 3.0, (3, 2)))) for name in "bacd")
        met = that_meet(own, others)
        waited += waits(own, *others) is not None
        assert waits(own, *met) == waits(own, *others)
        assert len(met) <= len(others)
    assert 30 < waited < 290


def test_who_has_no_way_left_meets_nobody():
    nowhere = traveller("b", np.zeros((0, 2)))
    assert that_meet(nowhere, [traveller("a", path((0.0, 0.0), (1.0, 0.0)))]) == []
    assert that_meet(traveller("a", path((0.0, 0.0), (1.0, 0.0))), [nowhere]) == []
