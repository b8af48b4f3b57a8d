"""How far a path is from the obstacles of a map: those that stay, not the team's vehicles that the map shows while they stand."""

from dataclasses import replace

import numpy as np

from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.costmap.obstacle_layer import BeamObservation, ObstacleLayer
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.planning.navigation.global_routes import AROUND, GlobalRoutes

CELL, ORIGIN = 0.05, (-1.0, 2.0)
PATH = np.column_stack((np.linspace(0.0, 3.0, 31), np.full(31, 3.5)))
NOBODY = np.zeros((0, 3))


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


def test_vehicles_at_the_edge_of_what_is_looked_at_are_left_out_as_far_as_they_reach_into_it():
    over = routes((-0.9, 3.5, 0.15))
    assert over.map_clearance(PATH, NOBODY)[0] < 0.9
    for x, shown in ((-1.05, False), (-1.5, True), (-9.0, True)):
        found = over.map_clearance(PATH, np.array(((x, 3.5, 0.35),)))
        assert (found[0] < 0.9) == shown, x


def test_what_is_free_in_the_map_and_seen_free_changes_no_costs():
    over = routes((1.5, 4.1, 0.2))
    over.reset()
    assert over.look((1.0, 3.5))
    before = over._planner.costs
    seen = BeamObservation(1.0, 1.0, (1.0, 3.5), np.array(((2.0, 3.5),)), np.array((False,)))
    over._layer.observe(seen)
    assert not over.look((1.0, 3.5))
    assert over._planner.costs is before
    over._layer.observe(replace(seen, hits=np.array((True,))))
    assert over.look((1.0, 3.5))
    assert over._planner.costs is not before
