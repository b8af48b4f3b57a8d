"""Vehicles that wait for each other in a circle: the first by name drives, but not at those who come first for other reasons."""

from types import SimpleNamespace

import numpy as np
import pytest

from services.planner.giving_way import GivingWay
from uvf.maths.se2 import Pose2
from uvf.planning.navigation.directive import Action, Directive
from uvf.planning.navigation.right_of_way import Traveller

NARROW = SimpleNamespace(map_clearance=lambda path, team: np.where(path[:, 0] < 0.8, 2.0, 0.3))
EAST = np.column_stack((np.linspace(0.0, 4.0, 41), np.zeros(41)))


def coming(name, x):
    """Towards the vehicle, from ``x`` [m]."""
    return Traveller(name, np.column_stack((np.linspace(x, -4.0, 60), np.zeros(60))), 0.2)


def team(*travellers, waiting=None):
    return SimpleNamespace(travellers=list(travellers), waiting=waiting or {}, discs=np.zeros((0, 3)))


def heed(name, others):
    way = GivingWay(name, 0.2, NARROW)
    directive = Directive(1, Action.FOLLOW, path=EAST)
    return way.heed(directive, Pose2(0.0, 0.0, 0.0), others).until, way.waits_for


@pytest.mark.parametrize(("name", "other", "waits"), [("anne", "carl", ""), ("carl", "anne", "anne")])
def test_of_two_that_wait_for_each_other_one_drives(name, other, waits):
    inside = coming(other, 1.5)
    assert heed(name, team(inside))[1] == other
    assert heed(name, team(inside, waiting={other: name}))[1] == waits


def test_who_drives_out_of_a_circle_still_waits_for_others():
    until, waits_for = heed("anne", team(coming("carl", 1.5), coming("zeno", 1.6), waiting={"carl": "anne"}))
    assert waits_for == "zeno" and until is not None
