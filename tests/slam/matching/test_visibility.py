"""Surfaces in the free space of a sweep."""

from dataclasses import replace

import numpy as np
import pytest

from tests.slam.matching.test_cloud import MOUNTS
from tests.slam.matching.walls import ALL_ROUND, ROOM, seen
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.slam.matching.visibility import AGREES, THROUGH, rays_of, verdicts
from uvf.slam.reading import Beams

ACROSS = np.column_stack((np.full(20, 1.5), np.linspace(-1.0, 1.0, 20)))
EAST = np.column_stack((np.full(20, 4.0), np.linspace(-1.0, 1.0, 20)))


def looked_through(points, reading):
    """How many of the points (agree, are looked through)."""
    found = verdicts(points, IDENTITY, rays_of(reading))
    return int((found == AGREES).sum()), int((found == THROUGH).sum())


@pytest.mark.parametrize("name", ["in the middle", "clockwise", "half a circle", "sparse"])
def test_a_wall_in_the_free_space_counts_as_looked_through(name):
    agree, through = looked_through(ACROSS, seen(ROOM, beams=MOUNTS[name]))
    assert agree == 0
    assert through >= 18


@pytest.mark.parametrize("name", ["in the middle", "clockwise", "half a circle", "sparse"])
def test_the_wall_itself_agrees(name):
    agree, through = looked_through(EAST, seen(ROOM, beams=MOUNTS[name]))
    assert agree >= 16
    assert through == 0


def test_the_place_of_the_lidar_counts_not_that_of_the_base():
    beams = Beams((2.0, 0.0), ALL_ROUND.bearings, 0.1, 30.0)
    assert looked_through(EAST, seen(ROOM, beams=beams))[0] >= 18
    assert looked_through(ACROSS, seen(ROOM, beams=beams))[1] >= 18


def test_what_lies_behind_a_wall_is_not_judged():
    assert looked_through(EAST + np.array((2.0, 0.0)), seen(ROOM)) == (0, 0)


def test_beams_without_return_tell_nothing():
    reading = seen(ROOM)
    for silent in (np.nan, np.inf, 0.0, 99.0):
        assert looked_through(ACROSS, replace(reading, ranges=np.full(360, silent))) == (0, 0)


def test_what_is_outside_the_field_of_view_is_not_judged():
    assert looked_through(-ACROSS, seen(ROOM, beams=MOUNTS["half a circle"])) == (0, 0)


@pytest.mark.parametrize("n", [0, 1])
def test_a_lidar_of_one_beam_looks_through_nothing(n):
    beams = Beams((0.0, 0.0), np.zeros(n), 0.1, 30.0)
    assert looked_through(ACROSS, seen(ROOM, beams=beams)) == (0, 0)


def test_points_of_another_frame_are_taken_to_the_lidars():
    found = verdicts(np.zeros((1, 2)), Pose2(4.0, 0.5, 2.0), rays_of(seen(ROOM)))
    assert found.tolist() == [AGREES]


def test_beams_that_have_come_out_of_order_are_put_into_it():
    whole = seen(ROOM)
    order = np.random.default_rng(1).permutation(len(whole.ranges))
    mixed = replace(whole, ranges=whole.ranges[order], beams=replace(whole.beams, bearings=whole.beams.bearings[order]))
    for points in (ACROSS, EAST):
        assert looked_through(points, mixed) == looked_through(points, whole)
