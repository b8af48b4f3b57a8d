"""What the robot touches, beside the clearance in closed form."""

import numpy as np
import pytest

from benchmarks.planning.barn.contacts import Contacts
from benchmarks.planning.barn.jackal import JACKAL
from benchmarks.planning.barn.movers import Track, movers_of
from benchmarks.planning.barn.scanning import clearance_to_boxes, clearance_to_discs
from benchmarks.planning.barn.worlds import World
from tests.benchmarks.planning.barn.made_up import START, ahead, world

HALF = (JACKAL.half_length, JACKAL.half_width)
NOTHING = np.zeros((0, 3))


@pytest.fixture
def contacts():
    made = []

    def of(world):
        made.append(Contacts(world, JACKAL))
        return made[-1]

    yield of
    for each in made:
        each.close()


def test_it_touches_where_the_closed_form_has_no_clearance_and_nowhere_else(contacts):
    rng = np.random.default_rng(5)
    discs = np.column_stack((rng.uniform(-4, 4, (60, 2)), rng.uniform(0.03, 0.2, 60)))
    boxes = np.array([(0.0, 4.5, 8.0, 0.5), (-4.5, 0.0, 0.5, 8.0)])
    engine = contacts(World("mixed", START, (0.0, 0.0), discs, boxes))
    seen = []
    for pose in np.column_stack((rng.uniform(-4, 4, (400, 2)), rng.uniform(-4, 4, 400))):
        clearance = min(clearance_to_discs(pose, HALF, discs), clearance_to_boxes(pose, HALF, boxes))
        if abs(clearance) > 2e-3:
            assert engine.touches(pose, NOTHING) == (clearance < 0.0)
            seen.append(clearance < 0.0)
    assert 50 < sum(seen) < 350


@pytest.mark.parametrize(("forward", "touches"), [(0.254 + 0.075 + 0.002, False), (0.254 + 0.075 - 0.002, True)])
def test_the_nose_touches_a_cylinder_of_barn_within_two_millimetres(contacts, forward, touches):
    assert contacts(world(discs=[(forward, 0.0, 0.075)])).touches(np.array(START), NOTHING) == touches


def test_a_world_of_as_many_cylinders_as_any_is_one_body(contacts):
    grid = [(0.15 * i, 2.0 + 0.15 * k, 0.075) for i in range(20) for k in range(20)]
    engine = contacts(world(discs=grid))
    assert not engine.touches(np.array(START), NOTHING)
    assert engine.touches(np.array((*ahead(0.0, 2.0), START.yaw + 1.0)), NOTHING)


def test_a_moving_disc_touches_where_it_is_and_no_longer_where_it_was(contacts):
    movers = movers_of([Track(0.5, 10.0, np.array([(0.0, 0.0, 0.0), (10.0, 10.0, 0.0)]))])
    engine = contacts(World("moving", START, (9.0, 9.0), NOTHING, movers=movers))
    for x, touches in ((9.0, False), (0.7, True), (0.8, False), (0.7, True), (50.0, False)):
        assert engine.touches(np.zeros(3), np.array([(x, 0.0, 0.5)])) == touches
    assert engine.touches(np.array((50.0, 0.3, 1.0)), np.array([(50.0, 0.0, 0.5)]))
    assert not engine.touches(np.array((0.7, 0.0, 0.0)), np.array([(50.0, 0.0, 0.5)]))


def test_a_disc_that_comes_from_far_in_one_step_is_felt(contacts):
    engine = contacts(world(movers=movers_of([Track(0.5, 1.0, np.array([(0.0, 9.0, 0.0), (1.0, 9.0, 1.0)]))])))
    assert not engine.touches(np.zeros(3), np.array([(9.0, 0.0, 0.5)]))
    assert engine.touches(np.zeros(3), np.array([(0.0, 0.0, 0.5)]))


def test_in_an_empty_world_nothing_is_touched(contacts):
    assert not contacts(world()).touches(np.array(START), NOTHING)
