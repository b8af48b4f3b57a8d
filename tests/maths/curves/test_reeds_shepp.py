"""Reeds-Shepp paths: against OMPL's lengths, and what every path must hold."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from launch.commands.testing import data_folder
from uvf.maths.curves.dubins_words import dubins_length
from uvf.maths.curves.reeds_shepp import reeds_shepp_path, reeds_shepp_paths
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_length, reeds_shepp_lengths

DATA = data_folder()
angles = st.floats(-30.0, 30.0)
places = st.floats(-8.0, 8.0)
configurations = st.tuples(places, places, angles)
special = st.sampled_from([0.0, 1.0, 2.0, -2.0, 4.0, math.sqrt(2), 100.0, -100.0])
quarters = st.sampled_from([k * math.pi / 2 for k in range(-5, 6)])
lattice = st.tuples(special, special, quarters)
HOME = (0.0, 0.0, 0.0)


def off(path, end):
    x, y, heading = path.end
    return max(math.dist((x, y), end[:2]), abs(math.remainder(heading - end[2], math.tau)))


@pytest.mark.skipif(DATA is None, reason="no data folder: OMPL's Reeds-Shepp lengths left out (set UVF_DATA)")
def test_lengths_are_those_of_ompl():
    rows = np.loadtxt(DATA / "dubins" / "reeds_shepp_ompl.csv", delimiter=",", skiprows=1)
    assert len(rows) == 5000
    for radius in np.unique(rows[:, 0]):
        these = rows[rows[:, 0] == radius]
        lengths = reeds_shepp_lengths(these[:, 1:4], these[:, 4:7], radius)
        assert np.abs(lengths - these[:, 7]).max() / radius < 1e-6


@settings(max_examples=200, deadline=None)
@given(start=configurations, end=configurations, radius=st.floats(0.01, 10.0))
def test_every_word_leads_to_the_goal_and_none_is_shorter(start, end, radius):
    shortest, words = reeds_shepp_path(start, end, radius), reeds_shepp_paths(start, end, radius)
    assert len(words) >= 8
    assert max(off(path, end) for path in words) < 1e-9
    assert shortest.length == pytest.approx(min(path.length for path in words), abs=1e-10)
    assert shortest.length == pytest.approx(reeds_shepp_length(start, end, radius), abs=1e-10)
    assert shortest.length >= math.dist(start[:2], end[:2]) - 1e-9


@settings(max_examples=200, deadline=None)
@given(start=configurations, end=configurations)
def test_there_and_back_are_as_long_and_no_longer_than_dubins(start, end):
    there, back = reeds_shepp_path(start, end, 1.0), reeds_shepp_path(end, start, 1.0)
    assert there.length == pytest.approx(back.length, abs=1e-7)
    assert there.length <= dubins_length(start, end, 1.0) + 1e-9


@settings(max_examples=200, deadline=None)
@given(start=lattice, end=lattice)
def test_touching_circles_and_right_angles_are_no_trap(start, end):
    """A goal a hair away costs the cube root of a hair more, no less."""
    path = reeds_shepp_path(start, end, 1.0)
    assert off(path, end) < 1e-9
    for angle in (0.3, 2.0, 4.0):
        near = (end[0] + 1e-9 * math.cos(angle), end[1] + 1e-9 * math.sin(angle), end[2] + 1e-9)
        assert reeds_shepp_length(start, near, 1.0) == pytest.approx(path.length, abs=0.02)


@settings(max_examples=200, deadline=None)
@given(start=configurations, middle=configurations, end=configurations)
def test_a_detour_is_no_shorter(start, middle, end):
    detour = reeds_shepp_length(start, middle, 1.0) + reeds_shepp_length(middle, end, 1.0)
    assert reeds_shepp_length(start, end, 1.0) <= detour + 1e-8


@pytest.mark.parametrize(
    ("end", "length", "word"),
    [
        ((0.0, 0.0, 0.0), 0.0, ""),
        ((0.0, 0.0, 7 * math.tau), 0.0, ""),
        ((5.0, 0.0, 0.0), 5.0, "S+"),
        ((-5.0, 0.0, 0.0), 5.0, "S-"),
        ((0.0, 0.0, math.pi), math.pi, None),
        ((1.0, 1.0, math.pi / 2), math.pi / 2, "L+"),
        ((-1.0, -1.0, math.pi / 2), math.pi / 2, "R-"),
    ],
)
def test_paths_that_are_known(end, length, word):
    path = reeds_shepp_path(HOME, end, 1.0)
    assert path.length == pytest.approx(length, abs=1e-9)
    assert word is None or path.word == word


def test_all_five_families_are_the_shortest_somewhere():
    rng = np.random.default_rng(5)
    ends = np.column_stack((rng.uniform(-6, 6, (3000, 2)), rng.uniform(-math.pi, math.pi, 3000)))
    kinds = {"".join("CS"[turn == 0] for turn in reeds_shepp_path(HOME, tuple(end), 1.0).turns) for end in ends.tolist()}
    assert {"CSC", "CCC", "CCCC", "CCSC", "CSCC", "CCSCC"} <= kinds


@settings(max_examples=100, deadline=None)
@given(end=st.tuples(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), angles), radius=st.sampled_from([1e-3, 1.0, 1e5]))
def test_far_goals_and_tiny_radii(end, radius):
    path = reeds_shepp_path(HOME, end, radius)
    assert off(path, end) < 1e-14 * path.length + 1e-9
    assert path.length < math.dist((0.0, 0.0), end[:2]) + 2 * math.pi * radius + 1e-3


def test_samples_follow_the_heading_in_the_direction_of_travel():
    path = reeds_shepp_path((2.0, 1.0, 1.0), (2.2, 1.5, 1.5), 1.0)
    assert "+" in path.word and "-" in path.word
    found = path.at(np.linspace(0.0, path.length, 20_001))
    step = path.length / 20_000
    ahead = np.einsum("ij,ij->i", np.diff(found[:, :2], axis=0), np.column_stack((np.cos(found[1:, 2]), np.sin(found[1:, 2]))))
    same = found[1:, 3] == found[:-1, 3]
    assert ahead[same] == pytest.approx(found[1:, 3][same] * step, rel=1e-5)
    assert (np.abs(np.diff(found[:, 2])) <= step * (1 + 1e-9)).all()
    assert (~same).sum() == sum(a * b < 0 for a, b in zip(path.lengths, path.lengths[1:], strict=False))
    assert found[-1, :2] == pytest.approx((2.2, 1.5), abs=1e-9)


def test_before_the_start_and_beyond_the_end_is_the_end():
    path = reeds_shepp_path(HOME, (3.0, 1.0, 0.5), 1.0)
    found = path.at(np.array([-1.0, 0.0, path.length, path.length + 5.0]))
    assert found[0] == pytest.approx(found[1])
    assert found[2] == pytest.approx(found[3])
    still = reeds_shepp_path(HOME, HOME, 1.0)
    assert still.at(np.array([0.0, 1.0]))[:, :3] == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("call", "why"),
    [
        (lambda: reeds_shepp_path(HOME, HOME, -1.0), "radius of -1 m"),
        (lambda: reeds_shepp_path(HOME, (math.nan, 0.0, 0.0), 1.0), "end: .* is no configuration"),
        (lambda: reeds_shepp_path((0.0, 0.0), HOME, 1.0), "start: .* is no configuration"),
        (lambda: reeds_shepp_lengths(np.zeros(3), np.zeros(3), 1.0), "starts: an array of shape"),
        (lambda: reeds_shepp_path(HOME, (1.0, 0.0, 0.0), 1.0).at(np.array([1.0, 0.0])), "ascending"),
    ],
)
def test_what_makes_no_sense_is_refused(call, why):
    with pytest.raises(ValueError, match=why):
        call()
