"""Plans on a map: round walls, not through them; and a reason when there is none."""

from dataclasses import replace

import numpy as np
import pytest

from schemas.limits import LENGTHS
from tests.services.planner.plans import room
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.global_planner import MOST_CELLS, GlobalPlanner, PlannedBody, PlannedPath
from uvf.planning.navigation.failures import Failure
from uvf.planning.smoothing import length

RADIUS = 0.15
BODY = PlannedBody(RobotFootprint.circle(RADIUS), Inflation(0.35, 6.0), 5.0)


def house(door=True):
    """4 x 3 m in two rooms; the door is in the upper part of the wall between them."""
    cells = room(4.0, 3.0)
    cells[:, 40:42] = 100
    if door:
        cells[42:54, 40:42] = 0
    return cells


def navigator(cells):
    made = GlobalPlanner(BODY)
    made.see(cells, (0.05, (0.0, 0.0)))
    return made


def test_goes_through_the_door():
    made = navigator(house())
    path = made.plan((0.6, 0.6), (3.4, 0.6)).path
    crossing = path[np.argmin(np.abs(path[:, 0] - 2.05))]
    assert 2.1 < crossing[1] < 2.7
    assert all(made.costs.clearance[made.costs.cell(x, y)] >= RADIUS for x, y in path)
    assert path[0] == pytest.approx((0.6, 0.6))
    assert path[-1] == pytest.approx((3.4, 0.6))


def test_the_path_is_not_much_longer_than_the_shortest_one():
    path = navigator(house()).plan((0.6, 0.6), (3.4, 0.6)).path
    assert length(path) < 1.15 * (np.hypot(1.45, 1.7) * 2)


@pytest.mark.parametrize(
    ("goal", "reason"),
    [
        ((3.4, 0.6), "no way leads to the goal"),
        ((9.0, 1.0), "the goal lies outside the map"),
        ((2.05, 1.0), "the goal lies in an obstacle"),
        ((0.02, 1.0), "the goal lies on ground not seen yet"),
        ((0.17, 1.0), "the goal is 0.08 m from an obstacle, 0.15 m are needed"),
    ],
)
def test_an_impossible_goal_is_refused_with_the_reason(goal, reason):
    assert navigator(house(door=False)).refusal((0.6, 0.6), goal) == reason


def test_on_a_map_of_too_many_cells_nobody_drives_until_there_is_a_smaller_one():
    made = navigator(house())
    made.see(np.zeros((MOST_CELLS // 2000 + 1, 2000), dtype=np.int8), (0.05, (0.0, 0.0)))
    why = f"the map is too large to plan on: {MOST_CELLS + 2000} cells, {MOST_CELLS} at most"
    assert made.refusal((0.6, 0.6), (3.4, 0.6)) == why
    assert (
        made.plan((0.6, 0.6), (3.4, 0.6)) == made.plan((0.6, 0.6), (3.4, 0.6), allow_unknown=True) == PlannedPath(None, why, Failure.NO_MAP)
    )
    assert made.ways((0.6, 0.6)) is None
    made.see(house(), (0.05, (0.0, 0.0)))
    assert made.refusal((0.6, 0.6), (3.4, 0.6)) == ""


@pytest.mark.parametrize("planner", ["astar", "jump_points"])
def test_a_goal_too_far_for_a_message_of_the_path_is_refused(planner):
    made = GlobalPlanner(replace(BODY, planner=planner))
    made.see(np.zeros((3, 1100), dtype=np.int8), (10.0, (0.0, 0.0)))
    near, far = (9_900.0, 15.0), (10_500.0, 15.0)
    assert made.refusal((5.0, 15.0), near) == ""
    assert len(made.plan((5.0, 15.0), near).path) < LENGTHS["foxglove.PosesInFrame.poses"]
    why = "the goal is too far to plan: 10.5 km of way, 10.0 km at most"
    assert made.refusal((5.0, 15.0), far) == why
    assert made.plan((5.0, 15.0), far) == PlannedPath(None, why, Failure.GOAL_TOO_FAR)


def test_a_possible_goal_is_not_refused():
    assert navigator(house()).refusal((0.6, 0.6), (3.4, 0.6)) == ""


def test_nothing_is_planned_without_a_map():
    made = GlobalPlanner(BODY)
    assert made.plan((0.0, 0.0), (1.0, 1.0)).reason == "there is no map yet"
    assert made.refusal((0.0, 0.0), (1.0, 1.0)) == "there is no map yet"


def test_only_a_bold_plan_crosses_unknown_ground():
    cells = room(4.0, 2.0)
    cells[:, 30:50] = -1
    made = navigator(cells)
    assert made.plan((0.6, 1.0), (3.4, 1.0)).path is None
    assert made.plan((0.6, 1.0), (3.4, 1.0), allow_unknown=True).path is not None


def test_a_bold_plan_goes_as_near_as_the_map_reaches():
    cells = np.full((40, 40), -1, dtype=np.int8)
    cells[10:30, 10:30] = 0
    path = navigator(cells).plan((1.0, 1.0), (9.0, 1.0), allow_unknown=True).path
    assert path[-1] == pytest.approx((1.975, 1.025), abs=0.03)


def test_starts_from_a_place_too_near_a_wall():
    path = navigator(room(2.0, 2.0)).plan((0.2, 1.0), (1.5, 1.0)).path
    assert path[0] == pytest.approx((0.2, 1.0))
