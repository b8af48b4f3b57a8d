"""Compiled Dubins paths: against OMPL's lengths, against the formulas in Python, and where they might fail."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from launch.commands.testing import data_folder
from uvf.maths.curves.dubins import dubins_paths
from uvf.maths.curves.dubins_words import WORDS, dubins_length, dubins_lengths, dubins_segments, dubins_word
from uvf.maths.curves.segments import MOST, end_of, sampled

DATA = data_folder()
angles = st.floats(-30.0, 30.0)
places = st.floats(-300.0, 300.0)
configurations = st.tuples(places, places, angles)
special = st.sampled_from([0.0, 1.0, 2.0, -2.0, 4.0, math.sqrt(2), 100.0, -100.0])
quarters = st.sampled_from([k * math.pi / 2 for k in range(-5, 6)])
lattice = st.tuples(special, special, quarters)


def path(start, end, radius):
    out = np.zeros((MOST, 2))
    return dubins_segments(start, end, radius, out), out


def off(start, segments, end):
    x, y, heading = end_of(start, segments)
    return max(math.dist((x, y), end[:2]), abs(math.remainder(heading - end[2], math.tau)))


@pytest.mark.skipif(DATA is None, reason="no data folder: OMPL's Dubins lengths left out (set UVF_DATA)")
def test_batch_lengths_are_those_of_ompl():
    rows = np.loadtxt(DATA / "dubins" / "dubins_ompl.csv", delimiter=",", skiprows=1)
    assert len(rows) == 5000
    for radius in np.unique(rows[:, 0]):
        these = rows[rows[:, 0] == radius]
        lengths, words = dubins_lengths(these[:, 1:4], these[:, 4:7], radius)
        assert np.abs(lengths - these[:, 7]).max() / radius < 1e-6
        assert set(words) == set(range(6))


@settings(max_examples=300, deadline=None)
@given(start=configurations, end=configurations, radius=st.floats(0.01, 120.0))
def test_the_shortest_of_the_formulas_in_python_and_it_leads_to_the_goal(start, end, radius):
    length, segments = path(start, end, radius)
    assert length == pytest.approx(min(p.length for p in dubins_paths(start, end, radius)), abs=1e-7 * radius)
    assert (segments[:, 0] >= 0).all() and np.abs(segments[:, 1]).max() <= 1 / radius * (1 + 1e-12)
    assert off(start, segments, end) < 1e-9


@settings(max_examples=300, deadline=None)
@given(start=lattice, end=lattice)
def test_touching_circles_and_right_angles_are_no_trap(start, end):
    length, segments = path(start, end, 1.0)
    assert off(start, segments, end) < 1e-9
    words = [sum(dubins_word(k, start, end, 1.0)) for k in range(6)]
    assert length == pytest.approx(min(words), abs=1e-12)
    # A goal a hair further on costs a hair more, when the curve leads there without another loop.
    beyond = (end[0] + 1e-7 * math.cos(end[2]), end[1] + 1e-7 * math.sin(end[2]), end[2])
    assert path(start, beyond, 1.0)[0] <= length + 1.1e-7


@pytest.mark.parametrize(
    ("end", "length"),
    [
        ((0.0, 0.0, 0.0), 0.0),
        ((0.0, 0.0, math.tau * 3), 0.0),
        ((5.0, 0.0, 0.0), 5.0),
        ((0.0, 2.0, math.pi), math.pi),
        ((0.0, 2.0, -math.pi), math.pi),
        ((1.0, 1.0, math.pi / 2), math.pi / 2),
        ((2.0, 2.0, 0.0), math.pi),
        ((1e6, 0.0, 0.0), 1e6),
    ],
)
def test_lengths_that_are_known(end, length):
    assert dubins_length((0.0, 0.0, 0.0), end, 1.0) == pytest.approx(length, abs=1e-9)


@settings(max_examples=100, deadline=None)
@given(end=st.tuples(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), angles), radius=st.sampled_from([1e-3, 1.0, 1e5]))
def test_far_goals_and_tiny_radii(end, radius):
    length, segments = path((3.0, -7.0, 2.0), end, radius)
    assert off((3.0, -7.0, 2.0), segments, end) < 1e-14 * length + 1e-9
    assert math.dist((3.0, -7.0), end[:2]) <= length * (1 + 1e-12) < math.dist((3.0, -7.0), end[:2]) + 4 * math.pi * radius + 1e-3


def test_samples_lie_on_the_path_and_both_ends_are_there():
    start, end = (1.0, 2.0, 3.0), (4.0, -9.0, 11.0)
    length, segments = path(start, end, 2.0)
    found = sampled(start, segments, np.linspace(0.0, length, 4001))
    assert tuple(found[0, :3]) == start
    assert found[-1, :2] == pytest.approx(end[:2], abs=1e-9)
    assert np.hypot(*np.diff(found[:, :2], axis=0).T) == pytest.approx(length / 4000, rel=1e-6)
    assert (np.abs(np.diff(found[:, 2])) <= length / 4000 / 2.0 + 1e-12).all()
    assert (found[:, 3] == 1.0).all()


def test_all_words_are_named():
    rng = np.random.default_rng(3)
    ends = np.column_stack((rng.uniform(-3, 3, (600, 2)), rng.uniform(-4, 4, 600)))
    _, words = dubins_lengths(np.zeros((600, 3)), ends, 1.0)
    assert {WORDS[w] for w in words} == {"LSL", "RSR", "LSR", "RSL", "LRL", "RLR"}
    for word, end in zip(words[:50], ends[:50].tolist(), strict=True):
        assert WORDS[word] in {p.word for p in dubins_paths((0.0, 0.0, 0.0), tuple(end), 1.0)}


def test_nothing_in_nothing_out():
    lengths, words = dubins_lengths(np.empty((0, 3)), np.empty((0, 3)), 1.0)
    assert lengths.shape == words.shape == (0,)


@pytest.mark.parametrize(
    ("starts", "goals", "radius", "why"),
    [
        (np.zeros((2, 3)), np.zeros((2, 3)), 0.0, "radius of 0 m"),
        (np.zeros((2, 3)), np.zeros((2, 3)), math.nan, "radius of nan m"),
        (np.zeros((2, 2)), np.zeros((2, 3)), 1.0, "starts: an array of shape"),
        (np.zeros((2, 3)), np.zeros((3, 3)), 1.0, "2 starts and 3 goals"),
        (np.zeros((2, 3)), np.full((2, 3), np.inf), 1.0, "goals: row 0 is not finite"),
    ],
)
def test_what_makes_no_sense_is_refused(starts, goals, radius, why):
    with pytest.raises(ValueError, match=why):
        dubins_lengths(starts, goals, radius)
