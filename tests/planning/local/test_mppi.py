"""MPPI drives round, waits, backs out and evades; the same seed drives the same way."""

import numpy as np
import pytest

from tests.planning.local.grounds import (
    BODY,
    DT,
    INFLATION,
    LIMITS,
    ORIGIN,
    RESOLUTION,
    SIDE,
    START,
    disc_gap,
    drive,
    gap,
    ground,
    moved,
    path_to,
    situation,
)
from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import STOP, Limits, State

FAST = Limits(-2.0, 2.0, 3.0, 4.0, 10.0, 3.5)


def mppi(limits=LIMITS, seed=3):
    return Mppi(limits, BODY, MppiSettings(), seed)


def test_it_drives_round_a_box_with_room_to_spare_and_not_slowly():
    box = (-0.5, -0.6, 0.3, 0.5)
    states = drive(mppi(), ground(box), (3.0, 0.0))
    assert (len(states) - 1) * DT < 9.0
    assert min(gap(box, state) for state in states) > 0.05


def test_it_backs_out_of_a_dead_end():
    """The way out is too narrow to turn in."""
    walls = ((-0.4, 0.3, 1.0, 0.5), (-0.4, -0.5, 1.0, -0.3), (0.8, -0.5, 1.0, 0.5))
    states = drive(mppi(), ground(*walls), (-2.0, 1.5), start=State(0.4, 0.0, 0.0, 0.0, 0.0))
    assert np.hypot(states[-1].x + 2.0, states[-1].y - 1.5) < 0.15
    assert any(state.speed < -0.1 for state in states)
    assert all(gap(wall, state) > 0.0 for wall in walls for state in states)


def test_it_stops_where_the_way_is_shut_and_says_so_when_it_touches():
    shut = ground((0.0, -4.0, 0.2, 4.0))
    path = np.column_stack((np.linspace(-1.0, 2.0, 31), np.zeros(31)))
    planner, state = mppi(), State(-0.6, 0.0, 0.0, 0.0, 0.0)
    for _ in range(40):
        command = planner.command(situation(shut, state, path))
        assert command is None or command[0] < 1.4
        assert command is None or state.x + 0.25 + max(command[0], 0.0) * DT < 0.0


@pytest.mark.parametrize(("speed", "direction"), [(0.8, 1.0), (1.5, -1.0)])
def test_it_evades_a_disc_that_crosses_its_way(speed, direction):
    """The disc would meet it in the middle, were it to drive on."""

    def disc_at(t):
        meeting = 2.6  # s, when a vehicle that drives on is in the middle
        return np.array(((0.0, direction * speed * (t - meeting), 0.0, direction * speed, 0.4),))

    states = drive(mppi(FAST), ground(), (3.0, 0.0), obstacles_at=disc_at)
    assert np.hypot(states[-1].x - 3.0, states[-1].y) < 0.15
    assert min(disc_gap(disc_at(k * DT)[0, (0, 1, 4)], state) for k, state in enumerate(states)) > 0.1


def test_a_standing_vehicle_makes_way_for_a_disc_that_comes_at_it():
    def disc_at(t):
        return np.array(((3.0 - 1.2 * t, 0.0, -1.2, 0.0, 0.4),))

    start = State(-0.5, 0.0, 0.0, 0.0, 0.0)
    states = drive(mppi(FAST), ground(), (3.0, 0.0), start=start, obstacles_at=disc_at, seconds=8.0)
    assert min(disc_gap(disc_at(k * DT)[0, (0, 1, 4)], state) for k, state in enumerate(states)) > 0.05


def test_the_same_seed_drives_the_same_way():
    costs = ground((-0.4, -0.4, 0.4, 0.5))
    runs = [drive(mppi(seed=5), costs, (3.0, 0.0), seconds=2.0) for _ in range(2)]
    assert runs[0] == runs[1]


def test_limits_of_the_moment_count():
    costs, state = ground(), State(-3.0, 0.0, 0.0, 1.4, 0.0)
    now = situation(costs, state, path_to(costs, state, (3.0, 0.0)))
    free = type(now)(now.state, now.grids, now.path, now.obstacles, FAST)
    planner, faster = mppi(), mppi()
    for _ in range(10):
        usual, more = planner.command(now), faster.command(free)
    assert usual[0] <= LIMITS.max_speed and more[0] > 1.6


def test_it_keeps_off_ground_that_nothing_has_seen_where_there_is_other():
    """The path leads along the edge of what is known; whatever stands beside it nobody knows."""

    def half_known(first):
        cells = np.zeros((SIDE, SIDE), dtype=np.int8)
        cells[round((first - ORIGIN[1]) / RESOLUTION) :] = -1
        return make_costmap(cells, (RESOLUTION, ORIGIN), BODY, INFLATION)

    def over_unseen(first):
        path, state, worst = np.column_stack((np.linspace(-3.0, 3.0, 61), np.zeros(61))), START, []
        planner, costs = mppi(), half_known(first)
        for _ in range(100):
            state = moved(state, planner.command(situation(costs, state, path)) or STOP)
            worst.append(state.y + 0.2 * np.cos(state.yaw) + 0.25 * abs(np.sin(state.yaw)) - first)
        return np.mean(np.array(worst[20:]) > 0.05), state.x

    share, reached = over_unseen(0.1)
    assert share < 0.3
    assert reached > 2.0
    assert over_unseen(-1.0)[1] > 1.0  # where all is unknown it drives on
