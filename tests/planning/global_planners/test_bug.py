"""Boundaries come back to where they began; Bug 1 and Bug 2 keep to their rules, and end."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.planning.global_planners.worlds import flood
from uvf.planning.global_planners.boundary import ACROSS, DOWN, next_side, straight
from uvf.planning.global_planners.bug import bug1, bug2

GRIDS = given(seed=st.integers(0, 10**6), share=st.floats(0.0, 0.6), rows=st.integers(1, 14), columns=st.integers(1, 14))
OFTEN = settings(max_examples=200, deadline=None, derandomize=True)


def sides(free):
    """All free cells with an impassable one beside, and in which direction."""
    beyond = np.pad(free, 1)
    return [(r, c, d) for r, c in np.argwhere(free).tolist() for d in range(4) if not beyond[r + 1 + DOWN[d], c + 1 + ACROSS[d]]]


@GRIDS
@OFTEN
def test_each_side_follows_one_other(seed, share, rows, columns):
    free = np.random.default_rng(seed).random((rows, columns)) >= share
    every = sides(free)
    following = [next_side(free, side)[0] for side in every]
    assert sorted(following) == sorted(every)
    for side, (r, c, _) in zip(every, following, strict=True):
        assert abs(side[0] - r) <= 1 and abs(side[1] - c) <= 1


@given(a=st.tuples(st.integers(0, 40), st.integers(0, 40)), b=st.tuples(st.integers(0, 40), st.integers(0, 40)))
@OFTEN
def test_straight_lines_step_to_cells_beside_and_nearer_and_stay_near_the_line(a, b):
    line = straight(a, b)
    assert tuple(line[0]) == a and tuple(line[-1]) == b
    assert (np.abs(np.diff(line, axis=0)).sum(axis=1) == 1).all()
    assert (np.diff(np.hypot(*(line - b).T)) < 0).all()
    along = np.subtract(b, a) / max(np.hypot(*np.subtract(b, a)), 1.0)
    assert (np.abs((line - a) @ (-along[1], along[0])) <= 0.71).all()


@GRIDS
@OFTEN
@pytest.mark.parametrize("bug", [bug1, bug2])
def test_bugs_come_to_every_goal_that_can_be_come_to(bug, seed, share, rows, columns):
    free = np.random.default_rng(seed).random((rows, columns)) >= share
    cells = np.argwhere(free)
    if not len(cells):
        return
    start = tuple(cells[seed % len(cells)].tolist())
    reached, bound = flood(free, start), 0
    for goal in map(tuple, cells.tolist()):
        way, found = bug(free, start, goal)
        assert found == reached[goal]
        assert tuple(way[0]) == start and free[way[:, 0], way[:, 1]].all()
        assert not found or tuple(way[-1]) == goal
        assert (np.abs(np.diff(way, axis=0)).sum(axis=1) == 1).all()
        bound = max(bound, len(way))
    if bug is bug1:  # the straight way, and each boundary one and a half times (with what is passed at its corners)
        assert bound <= rows + columns + 1.5 * 3 * len(sides(free)) + 1


def wall(rows=21, columns=41):
    free = np.ones((rows, columns), dtype=bool)
    free[5:16, 20] = False
    return free


def test_bug1_goes_round_once_and_leaves_from_the_nearest_place():
    free, start, goal = wall(), (9, 5), (9, 35)
    way, found = bug1(free, start, goal)
    assert found
    beside = {(r, c) for r in range(4, 17) for c in (19, 21)} | {(4, 20), (16, 20)}
    assert beside <= set(map(tuple, way.tolist()))
    assert tuple(way[-15]) == (9, 21)  # right behind the wall, and straight on from there
    # To the wall, once round, the shorter way to its far side (down 5, across 2, up 5), to the goal.
    assert len(way) - 1 == 14 + 2 * (12 + 2) + (5 + 2 + 5) + 14


def test_bug2_leaves_where_it_meets_the_line_again():
    way, found = bug2(wall(), (9, 5), (9, 35))
    assert found and tuple(way[-15]) == (9, 21)
    assert len(way) - 1 == 14 + (7 + 2 + 7) + 14  # with the wall on the right


def test_bug2_is_shut_in_by_a_ring_only():
    free = wall()
    free[5, 20:31] = free[15, 20:31] = free[5:16, 30] = False
    for bug in (bug1, bug2):
        assert not bug(free, (9, 5), (9, 25))[1]
        assert not bug(free, (9, 25), (9, 5))[1]
        assert bug(free, (9, 5), (9, 35))[1]


@pytest.mark.parametrize("bug", [bug1, bug2])
def test_a_long_labyrinth(bug):
    free = np.ones((201, 201), dtype=bool)
    for k, row in enumerate(range(1, 200, 2)):
        free[row, slice(1, None) if k % 2 else slice(0, -1)] = False
    way, found = bug(free, (0, 0), (200, 0))
    assert found and len(way) > 20_000
