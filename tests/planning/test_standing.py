"""Where the vehicle itself stands: its lidar has not seen that ground, or the map ends there, and it drives off all the same."""

import numpy as np
import pytest

from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import INSCRIBED, Inflation
from uvf.planning.costmap.own_ground import leads_away, widened, with_own_ground
from uvf.planning.exploration import Explorer
from uvf.planning.frontiers import FrontierWeights
from uvf.planning.global_planner import OUTSIDE, UNMAPPED, GlobalPlanner, PlannedBody

RESOLUTION = 0.05
RADIUS = 0.25  # m
LOOK = 2.0  # m that the lidars here see
INFLATION = Inflation(0.35, 6.0)
TASTE = FrontierWeights(least_size=4, view=0.4, worth=0.5)
HERE = (0.0, 0.0)


def body(radius=RADIUS, sensor_offset=0.0):
    return PlannedBody(RobotFootprint.circle(radius), INFLATION, 2.0, sensor_offset)


MOUNTS = {  # x, y [m], yaw, field of view [deg]
    "corner ahead": (0.13, 0.13, 0.0, 180.0),
    "corner behind": (-0.13, -0.13, 180.0, 180.0),
    "corner, 270 deg": (0.13, -0.13, -45.0, 270.0),
    "ahead, looking backwards": (0.13, 0.0, 180.0, 180.0),
    "centre, 60 deg": (0.0, 0.0, 0.0, 60.0),
    "ahead, 60 deg to the left": (0.2, 0.1, 90.0, 60.0),
    "centre, 20 deg askew": (0.0, 0.0, 45.0, 20.0),
    "beyond the vehicle's edge": (0.4, 0.1, 0.0, 180.0),
}


def first_map(mount):
    """(cells, frame) of what one sweep in the open sees from the mount; the grid ends where what is known ends."""
    x, y, yaw, view = mount
    rows, columns = np.indices((160, 160))
    dx, dy = (columns + 0.5) * RESOLUTION - 4.0 - x, (rows + 0.5) * RESOLUTION - 4.0 - y
    aside = np.abs((np.degrees(np.arctan2(dy, dx)) - yaw + 180.0) % 360.0 - 180.0)
    seen = (np.hypot(dx, dy) < LOOK) & (aside <= view / 2.0)
    row, column = np.nonzero(seen)
    cells = np.where(seen, 0, -1).astype(np.int8)[row.min() : row.max() + 1, column.min() : column.max() + 1]
    return cells, (RESOLUTION, (column.min() * RESOLUTION - 4.0, row.min() * RESOLUTION - 4.0))


def planner(mount):
    made = GlobalPlanner(body(RADIUS, float(np.hypot(mount[0], mount[1]))))
    made.see(*first_map(mount))
    return made


@pytest.mark.parametrize("mount", MOUNTS.values(), ids=MOUNTS.keys())
def test_exploring_begins_with_the_first_sweep_wherever_the_lidar_is(mount):
    made = planner(mount)
    made.stand(HERE)
    assert made.shut_in(HERE) == ""
    explorer = Explorer(TASTE)
    goal = explorer.choose(0.0, made.costs, made.ways(HERE))
    assert goal is not None and explorer.explored < 0.9
    yaw = np.radians(mount[2])
    seen = (mount[0] + np.cos(yaw), mount[1] + np.sin(yaw))
    assert made.refusal(HERE, seen) == ""
    assert made.plan(HERE, seen).path[-1] == pytest.approx(seen)


def test_a_map_that_ends_at_the_vehicle_is_widened_once_by_unknown_ground():
    made = planner((0.3, 0.0, 0.0, 180.0))
    before = made.costs
    assert not before.holds(before.cell(*HERE))
    assert made.stand(HERE) and not made.stand(HERE)
    known = np.argwhere(before.free)
    now = np.array([made.costs.cell(x, y) for x, y in before.points(known)])
    assert made.costs.holds(made.costs.cell(*HERE))
    assert made.costs.free.sum() == len(known) and made.costs.free[tuple(now.T)].all()


def test_a_map_far_from_the_vehicle_stays_as_it_is_and_the_reason_is_said():
    made = planner((0.3, 0.0, 0.0, 180.0))
    far = (-1e11, 3.0)
    assert not made.stand(far)
    assert made.shut_in(far) == made.refusal(far, (1.0, 0.0)) == made.plan(far, (1.0, 0.0)).reason == OUTSIDE
    assert widened(np.zeros((4, 4), dtype=np.int8), (0.05, (0.0, 0.0)), 0.1, (0.4, 0.1)) is None


def test_unmapped_ground_that_is_wider_than_the_vehicle_shuts_it_in():
    cells = np.full((80, 80), -1, dtype=np.int8)
    cells[:, 50:] = 0
    made = GlobalPlanner(body())
    made.see(cells, (RESOLUTION, (0.0, 0.0)))
    assert made.shut_in((1.0, 2.0)) == made.refusal((1.0, 2.0), (3.0, 2.0)) == made.plan((1.0, 2.0), (3.0, 2.0)).reason == UNMAPPED
    assert made.shut_in((2.3, 2.0)) == ""


def test_obstacles_all_round_shut_it_in():
    cells = np.zeros((80, 80), dtype=np.int8)
    cells[30:51, [30, 50]] = cells[[30, 50], 30:51] = 100
    for radius, why in ((0.45, "drive it out by hand"), (0.7, "0.48 m from an obstacle, 0.70 m are needed")):
        made = GlobalPlanner(body(radius))
        made.see(cells, (RESOLUTION, (0.0, 0.0)))
        assert why in made.shut_in((2.02, 2.02))
        assert made.shut_in((0.8, 0.8)) == ""


def test_only_ground_below_the_vehicle_is_taken_for_free_and_none_that_an_obstacle_is_near():
    cells = np.full((40, 40), -1, dtype=np.int8)
    cells[:, 22] = 100
    costs = make_costmap(cells, (RESOLUTION, (0.0, 0.0)), RobotFootprint.circle(RADIUS), INFLATION)
    opened = with_own_ground(costs, (20, 15), RADIUS, INFLATION)
    row, column = np.nonzero(opened.values < INSCRIBED)
    assert len(row) and np.hypot(row - 20, column - 15).max() <= RADIUS / RESOLUTION
    assert opened.clearance[row, column].min() >= RADIUS
    assert (costs.values >= INSCRIBED).all() and costs.unknown[20, 15]  # as it was
    assert not leads_away(opened, (20, 15), RADIUS)


def test_where_the_way_is_known_unseen_cells_below_the_vehicle_stay_shut():
    cells = np.zeros((40, 40), dtype=np.int8)
    cells[19, 20] = -1
    made = GlobalPlanner(body())
    made.see(cells, (RESOLUTION, (0.0, 0.0)))
    assert np.isinf(made.ways((1.02, 1.02)).cost[19, 20])
