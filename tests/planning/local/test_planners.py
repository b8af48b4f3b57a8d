"""Each local planner reaches the goal in small worlds without contact, within what the vehicle can do."""

from itertools import pairwise

import numpy as np
import pytest

from tests.planning.local.grounds import BODY, DT, LIMITS, drive, gap, ground
from uvf.planning.local.planners import LOCAL_PLANNERS, make_local_planner

GOAL = (3.0, 0.2)
WORLDS = {
    "nothing in the way": (),
    "a box in the way": ((-0.4, -0.4, 0.4, 0.5),),
    "a wide gap between walls": ((-0.1, -4.0, 0.1, -0.5), (-0.1, 1.3, 0.1, 4.0)),
    "a gap between walls": ((-0.1, -4.0, 0.1, -0.1), (-0.1, 0.9, 0.1, 4.0)),
}
WIDE = ("dwa", "trajectory_rollout")
"""They score the worst cost on the way, and turn on the spot before a gap whose middle is dear."""


ALL = [(name, world) for name in LOCAL_PLANNERS for world in WORLDS if world != "a gap between walls" or name not in WIDE]


@pytest.mark.parametrize(("name", "world"), ALL)
def test_it_reaches_the_goal_without_contact(name, world):
    boxes = WORLDS[world]
    states = drive(make_local_planner(name, LIMITS, BODY, 1), ground(*boxes), GOAL)
    assert np.hypot(states[-1].x - GOAL[0], states[-1].y - GOAL[1]) < 0.15, f"{name} ends at {states[-1]}"
    assert all(gap(box, state) > 0.0 for box in boxes for state in states)


@pytest.mark.parametrize("name", LOCAL_PLANNERS)
def test_it_asks_for_what_the_vehicle_may_do(name):
    states = drive(make_local_planner(name, LIMITS, BODY, 1), ground((-0.4, -0.4, 0.4, 0.5)), GOAL, seconds=4.0)
    for before, after in pairwise(states):
        assert LIMITS.min_speed - 1e-9 <= after.speed <= LIMITS.max_speed + 1e-9
        assert abs(after.speed - before.speed) <= LIMITS.acceleration * DT + 1e-9
        assert abs(after.speed * after.turn_rate) <= LIMITS.lateral_acceleration + 1e-6


def test_an_unknown_name_is_refused_with_the_nearest():
    with pytest.raises(ValueError, match="mppi"):
        make_local_planner("mpi", LIMITS, BODY)
