"""What the check of worlds remarks on boxes that lean."""

import numpy as np
import pytest

from launch.worlds.leaning import notes
from tests.models.world.test_geometry import world_of
from uvf.models.scenario import ROOT
from uvf.models.world.file import Box, load_world

SLAB, STEEP = (2.0, 1.0, 0.1), "ramp: 20 deg, steeper than the 15 deg that a rover drives"


def said(rpy, size=SLAB):
    return list(notes(world_of(boxes=[Box("ramp", (2.0, 1.0, 0.2), size, rpy=rpy)])))


@pytest.mark.parametrize("rpy", [(0.0, -np.radians(20), 0.0), (np.radians(20), 0.0, 1.0)])
def test_a_ramp_too_steep_to_drive_is_remarked(rpy):
    assert said(rpy) == [STEEP]


@pytest.mark.parametrize("rpy", [(0.0, 0.2618, 0.0), (0.0, 0.0, 1.0), (0.0, 1.3, 0.0), (3.1416, 0.0, 0.0)])
def test_what_can_be_driven_on_and_what_is_no_ramp_is_not(rpy):
    assert said(rpy) == []


def test_a_post_that_leans_is_no_ramp():
    assert said((0.0, np.radians(20), 0.0), (0.1, 0.1, 2.0)) == []


def test_a_whole_number_looks_like_degrees():
    assert said((0.0, -2.0, 0.0)) == ["ramp: pitch -2 is in radians (-115 deg); if degrees are meant: -2 deg = -0.03491"]


@pytest.mark.parametrize("name", sorted(p.parent.name for p in (ROOT / "worlds").glob("*/world.yaml")))
def test_of_the_worlds_that_come_along_nothing_is_remarked(name):
    assert list(notes(load_world(ROOT / "worlds", name))) == []
