"""The controller among scans: what moves leaves no marks and does not brake it, what stands or crawls stops it; limits by need."""

import numpy as np
import pytest

from tests.planning.local.grounds import BODY, LIMITS
from tests.planning.moving.scans import DT, Lidar
from uvf.maths.kinematics import Twist, move
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.inflation import LETHAL
from uvf.planning.costmap.obstacle_layer import ObstacleLayer
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import STOP, Limits

FAST = Limits(-2.0, 2.0, 3.0, 4.0, 10.0, 3.5)
HERE = Pose2(0.0, 0.0, 0.0)
PATH = np.column_stack((np.linspace(0.0, 4.0, 41), np.zeros(41)))
WALLS = [(0.0, 8.0), (np.pi / 2, 6.0), (np.pi, 7.0), (-np.pi / 2, 6.0)]


def watching(discs_at, seconds, *, stops_for_fast=False):
    """A controller that stands and has seen discs move for some time."""
    settings = ControllerSettings(size=18.0, evasion=FAST, stops_for_fast=stops_for_fast)
    controller = LocalController(BODY, LIMITS, Mppi(LIMITS, BODY, MppiSettings(), 1), settings)
    lidar, rng = Lidar(), np.random.default_rng(0)
    for k in range(round(seconds / DT) + 1):
        ranges = lidar.ranges(np.zeros(3), discs_at(k * DT), WALLS, rng)
        controller.see(k * DT, HERE, (0.0, 0.0), lidar.points((0.0, 0.0, 0.0), ranges), ranges)
    return controller


def test_what_moves_leaves_no_marks_where_it_is_and_was():
    controller = watching(lambda t: np.array(((2.5, -1.5 + t, 0.4),)), 1.0)
    near = controller.layer.lethal_near((2.5, -1.0), 1.2)
    assert not len(near)
    standing = watching(lambda t: np.array(((2.5, -0.5, 0.4),)), 1.0)
    assert len(standing.layer.lethal_near((2.5, -0.5), 0.6)) > 5


@pytest.mark.parametrize(
    ("speed", "stops_for_fast", "stops"), [(0.0, False, True), (0.25, False, True), (1.2, False, False), (1.2, True, True)]
)
def test_the_stop_heeds_what_stands_or_crawls_and_what_is_quicker_where_it_is_to(speed, stops_for_fast, stops):
    controller = watching(lambda t: np.array(((0.95, speed * (t - 1.0), 0.3),)), 1.0, stops_for_fast=stops_for_fast)
    command = controller.made_safe(Twist(1.4, 0.0), Twist(1.4, 0.0))
    assert (command[0] < 1.4) == stops


def test_more_is_driven_only_while_something_moves_near_by():
    far = watching(lambda t: np.array(((7.2, -2.0 + t, 0.4),)), 1.0)
    near = watching(lambda t: np.array(((1.0 - t, 4.5, 0.4),)), 1.0)
    found = {}
    for name, controller in (("far", far), ("near", near)):
        velocity = Twist(1.4, 0.0)
        for _ in range(8):
            result = controller.drive(HERE, velocity, PATH)
            velocity = result.velocity
        found[name] = velocity.linear
    assert len(far.moving.moving()) == len(near.moving.moving()) == 1
    assert found["far"] <= LIMITS.max_speed + 1e-9 < found["near"]


@pytest.mark.parametrize("centre", [(1.2, 0.9), (3.0, 3.0), (-1.02, 1.0), (9.0, 0.0), (-40.0, 1.0)])
def test_a_disc_is_freed_cell_by_cell(centre):
    layer = ObstacleLayer(4.0, 0.05)
    layer.recentre((1.0, 1.0))
    layer.cells[:] = LETHAL
    layer.free_disc(centre, 0.4)
    n = len(layer.cells)
    at = (np.arange(n) + 0.5) * 0.05
    away = np.hypot((at + layer.origin[1] - centre[1])[:, None], at + layer.origin[0] - centre[0])
    assert np.array_equal(layer.cells != LETHAL, away <= 0.4)


@pytest.mark.parametrize("stops_for_fast", [False, True])
def test_who_holds_stands_until_something_comes_at_it(stops_for_fast):
    calm = watching(lambda t: np.zeros((0, 3)), 0.2)
    assert calm.hold(HERE, STOP) == STOP
    threatened = watching(lambda t: np.array(((4.5 - 1.5 * t, 0.1, 0.4),)), 1.0, stops_for_fast=stops_for_fast)
    velocity, pose = STOP, HERE
    for _ in range(40):
        velocity = threatened.hold(pose, velocity)
        pose = move(pose, velocity, 0.05)
    assert np.hypot(pose[0], pose[1]) > 0.4
