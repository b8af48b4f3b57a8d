"""Room in an airspace against the signed distances of its areas."""

import math

import numpy as np
import pytest

from uvf.maths.zones import Disc, Polygon
from uvf.planning.flight.airspace import Airspace, Prism, space_of
from uvf.planning.flight.clearance import ClearanceMargins, is_clear_way, outside, room
from uvf.planning.flight.edges import PIECES, Agility, edge, needed

STAR = Polygon([(0, 0), (100, 20), (40, 40), (60, 120), (10, 60), (-80, 70), (-20, 30)])


def test_distances_are_those_of_the_areas():
    space = space_of(Airspace((Prism(STAR), Prism(Disc((50.0, -60.0), 30.0)))))
    points = np.random.default_rng(0).uniform(-200, 200, (500, 2))
    for i, area in enumerate((STAR, Disc((50.0, -60.0), 30.0))):
        found = [outside(space.obstacles, i, x, y, math.inf) for x, y in points]
        assert found == pytest.approx(-area.inside(points))


def test_room_is_never_more_than_there_is():
    space, margins = space_of(Airspace((Prism(STAR, 20.0, 80.0),), floor=0.0, ceiling=150.0)), ClearanceMargins(5.0, 4.0)
    rng = np.random.default_rng(1)
    for x, y, height in rng.uniform((-150, -100, 0), (150, 200, 150), (1000, 3)):
        free = room(space, margins, (x, y, height), 0.2)
        if free <= 0:
            continue
        for angle, slope in rng.uniform((0, -0.2), (math.tau, 0.2), (5, 2)):
            s = free * 0.999
            at = (x + s * math.cos(angle), y + s * math.sin(angle), height + slope * s)
            assert room(space, margins, at, 0.2) >= 0.0


def test_a_way_over_the_top_is_clear_and_through_it_is_not():
    space, margins = space_of(Airspace((Prism(STAR, 0.0, 80.0),))), ClearanceMargins(5.0, 4.0)
    line = np.array([(400.0, 0.0)])
    assert is_clear_way(space, margins, (-200.0, 30.0, 90.0, 0.0), line, 0.0)
    assert not is_clear_way(space, margins, (-200.0, 30.0, 80.0, 0.0), line, 0.0)
    assert is_clear_way(space, margins, (-200.0, 30.0, 60.0, 0.0), line, 0.3)
    assert not is_clear_way(space, margins, (-200.0, 30.0, 60.0, 0.0), line, 0.1)


@pytest.mark.parametrize("rise", [0.0, 5.0, 20.0, 45.0, 300.0, -5.0, -45.0, -300.0])
def test_edges_are_long_enough_and_lead_to_their_end(rise):
    from uvf.maths.curves.segments import end_of

    agility, rng, out = Agility(40.0, 0.2, 0.1), np.random.default_rng(2), np.zeros((PIECES, 2))
    for x, y, course in rng.uniform((-300, -300, -4), (300, 300, 4), (200, 3)):
        start, end = (1.0, 2.0, 100.0, 0.5), (x, y, 100.0 + rise, course)
        length = edge(agility, start, end, out)
        assert length >= needed(agility, rise) - 1e-6 and length == pytest.approx(out[:, 0].sum())
        assert np.abs(out[:, 1]).max() <= 1 / 40.0 + 1e-12 and out[:, 0].min() >= 0
        x1, y1, course1 = end_of((1.0, 2.0, 0.5), out)
        assert (x1, y1) == pytest.approx((x, y), abs=1e-6)
        assert math.remainder(course1 - course, math.tau) == pytest.approx(0.0, abs=1e-8)
