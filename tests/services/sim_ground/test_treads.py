"""The friction of treads by the loads of their contacts, however many of these the engine keeps of one wheel."""

from math import inf

import numpy as np
import pytest

from services.sim_ground.body import BodyPose, LinkPose
from services.sim_ground.touching import EngineContact
from services.sim_ground.treads import Rolling, Treads

IDENTITY = np.array((1.0, 0.0, 0.0, 0.0))
SIDEWAYS = Rolling(
    BodyPose((0.0, 0.0, 0.05), (0.0, 0.0, 0.0, 1.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.0)),
    [LinkPose(np.array((0.0, 0.0, 0.05)), IDENTITY)],
    [0.0],
)


def contact(load, x=0.0, normal=(0.0, 0.0, 1.0), link=7):
    return EngineContact(0, link, (x, 0.0, 0.0), normal, 0.0, load)


def push(contacts):
    """The force (3,) on one wheel that slides to the left, once its tread has given way, and where it acts."""
    treads = Treads([7], np.array(((0.0, 1.0, 0.0),)), np.array(((1.0, 1.0),)), [True], [0.0], inf)
    for _ in range(200):
        pushes = treads.pushes(contacts, SIDEWAYS, (1.0, 1.0), 0.005)
    ((_, force, place),) = pushes
    return force, place


def test_the_load_of_one_wheel_counts_whole_at_however_many_places_it_is_told():
    force, place = push([contact(100.0)])
    assert force == pytest.approx((0.0, -100.0, 0.0), abs=1.0) and place == (0.0, 0.0, 0.0)
    shared, there = push([contact(50.0, -0.002), contact(30.0, 0.0), contact(20.0, 0.005)])
    assert shared == pytest.approx(force, abs=1e-6) and there == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_on_an_edge_it_holds_by_what_bears_it_on_both_sides():
    force, _ = push([contact(50.0), contact(50.0, normal=(-0.6, 0.0, 0.8))])
    assert np.linalg.norm(force) == pytest.approx(100.0, rel=0.02)


def test_what_does_not_bear_holds_nothing():
    treads = Treads([7], np.array(((0.0, 1.0, 0.0),)), np.array(((1.0, 1.0),)), [True], [0.0], inf)
    assert treads.pushes([contact(0.0), contact(9.0, link=8)], SIDEWAYS, (1.0, 1.0), 0.005) == []
