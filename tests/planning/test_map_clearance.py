"""How far a path is from the obstacles of a map: those that stay, not the team's vehicles that the map shows while they stand."""

import numpy as np

from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.obstacle_layer import ObstacleLayer
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.planning.navigation.global_routes import AROUND, GlobalRoutes

CELL, ORIGIN = 0.05, (-1.0, 2.0)
PATH = np.column_stack((np.linspace(0.0, 3.0, 31), np.full(31, 3.5)))
NOBODY = np.zeros((0, 2))


def routes(*discs):
    """Over a room of 5 x 3 m in whose map discs (x, y, radius) [m] are taken."""
    cells = np.zeros((60, 100), dtype=np.int8)
    y, x = (np.indices(cells.shape) + 0.5) * CELL + np.array(ORIGIN)[::-1, None, None]
    for cx, cy, radius in discs:
        cells[np.hypot(x - cx, y - cy) <= radius] = 100
    body = PlannedBody(RobotFootprint.circle(0.1), Inflation(0.3, 5.0))
    over = GlobalRoutes(GlobalPlanner(body), ObstacleLayer(8.0, CELL), HiddenObstacles(8.0, CELL, 30.0))
    over.take(cells, (CELL, ORIGIN))
    return over


def test_clearance_is_the_distance_to_what_is_drawn():
    found = routes((1.5, 4.1, 0.2)).map_clearance(PATH, NOBODY)
    true = np.hypot(PATH[:, 0] - 1.5, 0.6) - 0.2
    near = true < AROUND
    assert np.abs(found - true)[near].max() < 1.5 * CELL
    assert (found[~near] > AROUND - 2 * CELL).all()


def test_a_vehicle_of_the_team_that_the_map_shows_is_no_obstacle_but_the_wall_beside_it_is():
    over = routes((3.0, 3.5, 0.1), (1.5, 3.8, 0.1))
    assert over.map_clearance(PATH, NOBODY)[-1] < 0.0
    found = over.map_clearance(PATH, np.array(((3.0, 3.5, 0.2),)))
    assert found[-1] > 1.0
    assert found[15] < 0.3


def test_beside_the_map_nothing_is_near():
    far = PATH + np.array((100.0, 0.0))
    assert np.isinf(routes((1.5, 4.1, 0.2)).map_clearance(far, NOBODY)).all()
