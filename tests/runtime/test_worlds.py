"""The worlds that come along: what they promise of rooms, passages and ramps holds."""

import numpy as np
import pytest

from uvf.maths.rotations import to_euler
from uvf.models.scenario import ROOT
from uvf.models.world.file import load_world
from uvf.models.world.geometry import floor_plan, reachable_floor, solids

BURGER, WIDE = 0.115, 0.35
PLACES = {
    "empty": ((0.0, 0.0), [(20.0, 20.0), (-20.0, -20.0)]),
    "house": ((2.2, 1.3), [(5.5, 1.7), (10.0, 2.5), (9.0, 4.3), (3.0, 6.5), (6.5, 7.6), (9.6, 7.0)]),
    "watkins": ((1.0, 1.2), [(19.0, 1.2), (4.4, 8.6), (8.0, 13.4), (12.0, 9.0), (17.5, 5.0), (17.65, 13.0)]),
    "plaza": ((20.0, 10.0), [(29.5, 24.0), (33.0, 21.5), (8.6, 6.0), (10.4, 27.2)]),
    "world": ((17.0, 3.0), [(4.0, 15.0), (9.5, 18.0), (24.0, 6.5), (28.5, 19.0), (16.2, 6.0)]),
}
NARROW = {"house": (1.2, 2.2), "watkins": (17.65, 13.0)}
PLANS = {}


def reaches(world, place, radius):
    if world not in PLANS:
        PLANS[world] = floor_plan(load_world(ROOT / "worlds", world), 0.05)
    plan = PLANS[world]
    return reachable_floor(plan, *PLACES[world][0], radius)[plan.cell(*place)]


@pytest.mark.parametrize(("world", "place"), [(w, p) for w, (_, places) in PLACES.items() for p in places])
def test_the_burger_gets_into_every_part_of_every_world(world, place):
    assert reaches(world, place, BURGER)


@pytest.mark.parametrize("world", NARROW)
def test_a_narrow_passage_lets_the_burger_through_and_a_wide_robot_not(world):
    assert reaches(world, NARROW[world], BURGER)
    assert not reaches(world, NARROW[world], WIDE)


@pytest.mark.parametrize(("world", "count"), [("plaza", 4), ("world", 1)])
def test_ramps_rise_by_at_most_eight_degrees_from_the_ground(world, count):
    ramps = [s for s in solids(load_world(ROOT / "worlds", world)) if s.shape == "box" and abs(to_euler(s.orientation)[1]) > 0.01]
    assert len(ramps) == count
    assert all(abs(to_euler(s.orientation)[1]) <= np.radians(8.001) for s in ramps)


@pytest.mark.parametrize("world", ["plaza", "world"])
def test_somebody_walks_at_a_human_pace(world):
    moving = [s for s in solids(load_world(ROOT / "worlds", world)) if s.path is not None]
    assert moving
    for solid in moving:
        speeds = [np.hypot(*solid.path.velocity(t)[:2]) for t in np.linspace(0.0, 60.0, 600)]
        assert 0.5 < max(speeds) < 1.6
