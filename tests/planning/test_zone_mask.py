"""Masks over a map: what they say at points, and what nobody drives on."""

import numpy as np
import pytest

from uvf.maths.se2 import Pose2
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.obstacle_layer import ObstacleLayer
from uvf.planning.costmap.zone_mask import ZoneMask
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.planning.navigation.failures import Failure
from uvf.planning.navigation.global_routes import GlobalRoutes
from uvf.planning.navigation.navigator import NavigationGoal

VALUES = np.array(((0, 100, 0), (50, 0, 7)), dtype=np.int8)
MASK = ZoneMask(VALUES, (0.5, (1.0, -2.0)))


def test_a_value_is_that_of_the_cell_and_nothing_is_marked_outside():
    points = np.array(((1.6, -1.9), (1.1, -1.4), (2.4, -1.1), (0.9, -1.9), (2.6, -1.9), (1.1, -0.9), (1e9, 0.0)))
    assert MASK.at(points).tolist() == [100, 50, 7, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("place", "reach", "found"), [((1.5, -1.5), 1.0, 2), ((1.75, -1.75), 0.1, 1), ((9.0, 9.0), 1.0, 0), ((1.5, -1.5), 50.0, 2)]
)
def test_what_is_kept_out_of_near_a_place(place, reach, found):
    near = MASK.kept_out_near(place, reach)
    assert len(near) == found
    assert (MASK.at(near) >= 50).all()


def room():
    cells = np.full((60, 80), 100, dtype=np.int8)
    cells[1:-1, 1:-1] = 0
    return cells


@pytest.mark.parametrize("turn", [0.0, np.pi / 2, 2.0])
def test_paths_keep_out_of_what_is_drawn_in_another_frame(turn):
    mask_from_map = Pose2(10.0, -3.0, turn)
    values = np.zeros((400, 400), dtype=np.int8)
    mask = ZoneMask(values, (0.05, (0.0, -13.0)))
    centres = mask.frame[1] + (np.indices(values.shape)[::-1].reshape(2, -1).T + 0.5) * 0.05
    in_map = (centres - mask_from_map[:2]) @ np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
    zone = (np.abs(in_map[:, 0] - 2.0) < 0.3) & (in_map[:, 1] < 2.0)
    values[zone.reshape(values.shape)] = 100
    routes = GlobalRoutes(
        GlobalPlanner(PlannedBody(RobotFootprint.circle(0.1), Inflation(0.3, 5.0))),
        ObstacleLayer(8.0, 0.05),
        HiddenObstacles(8.0, 0.05, 30.0),
    )
    routes.take(room(), (0.05, (0.0, 0.0)))
    goal = NavigationGoal(3.5, 1.0)
    straight = routes.plan(Pose2(0.5, 1.0, 0.0), goal).path
    assert straight[:, 1].max() < 1.3
    routes.keep_out(mask, mask_from_map)
    round_it = routes.plan(Pose2(0.5, 1.0, 0.0), goal).path
    inside = (np.abs(round_it[:, 0] - 2.0) < 0.3) & (round_it[:, 1] < 2.0)
    assert not inside.any()
    assert round_it[:, 1].max() > 2.0
    assert routes.plan(Pose2(0.5, 1.0, 0.0), NavigationGoal(2.0, 1.0)).failure == Failure.GOAL_OCCUPIED
