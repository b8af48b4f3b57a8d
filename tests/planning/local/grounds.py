"""A small kinematic world: a vehicle that follows a local planner's velocities within its limits, over a known map."""

import numpy as np

from uvf.planning.costmap.costmap import make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation, cost_factors
from uvf.planning.local.planner import NOBODY, STOP, Limits, LocalSituation, State, within
from uvf.planning.local.window import WindowSettings, local_window
from uvf.planning.search.grid_search import GridSearch
from uvf.planning.smoothing import resample

DT = 0.05  # s
SIDE, RESOLUTION = 160, 0.05
ORIGIN = (-4.0, -4.0)
START = State(-3.0, 0.0, 0.0, 0.0, 0.0)
BODY = RobotFootprint.polygon(np.array(((-0.25, -0.2), (0.25, -0.2), (0.25, 0.2), (-0.25, 0.2))))
LIMITS = Limits(-0.5, 1.4, 2.0, 2.5, 6.0, 2.0)
INFLATION = Inflation(0.55, 4.0)
FACTORS = cost_factors(4.0, 1.0)


def ground(*boxes):
    """Costmap of 8 x 8 m about the origin with boxes x0, y0, x1, y1 [m]."""
    cells = np.zeros((SIDE, SIDE), dtype=np.int8)
    for x0, y0, x1, y1 in boxes:
        columns = slice(round((x0 - ORIGIN[0]) / RESOLUTION), round((x1 - ORIGIN[0]) / RESOLUTION))
        cells[round((y0 - ORIGIN[1]) / RESOLUTION) : round((y1 - ORIGIN[1]) / RESOLUTION), columns] = 100
    return make_costmap(cells, (RESOLUTION, ORIGIN), BODY, INFLATION)


def gap(box, state):
    """Distance [m] from the outline's sampled border to a box; 0 inside."""
    s = np.linspace(-1.0, 1.0, 41)
    border = np.concatenate([np.column_stack((0.25 * s, np.full(41, 0.2 * k))) for k in (-1, 1)])
    border = np.concatenate((border, *[np.column_stack((np.full(41, 0.25 * k), 0.2 * s)) for k in (-1, 1)]))
    c, n = np.cos(state.yaw), np.sin(state.yaw)
    places = border @ np.array(((c, n), (-n, c))) + np.array((state.x, state.y))
    low, high = np.array(box[:2]), np.array(box[2:])
    return float(np.hypot(*np.maximum(np.maximum(low - places, places - high), 0.0).T).min())


def disc_gap(disc, state):
    """Distance [m] from the outline to a disc (x, y, radius)."""
    dx, dy = disc[0] - state.x, disc[1] - state.y
    c, n = np.cos(state.yaw), np.sin(state.yaw)
    x, y = abs(c * dx + n * dy) - 0.25, abs(c * dy - n * dx) - 0.2
    return float(np.hypot(max(x, 0.0), max(y, 0.0)) + min(max(x, y), 0.0) - disc[2])


def path_to(costs, state, goal):
    """(n, 2) m, by A*."""
    found = GridSearch(costs.values, FACTORS).astar(costs.cell(state.x, state.y), costs.cell(*goal))
    points = costs.points(found.cells)
    points[0], points[-1] = (state.x, state.y), goal
    return resample(points)


def moved(state, command, limits=LIMITS):
    """The state ``DT`` later."""
    v, w, side = within(limits, state, command, DT)
    cosine, sine = np.cos(state.yaw + w * DT / 2), np.sin(state.yaw + w * DT / 2)
    x, y = state.x + (v * cosine - side * sine) * DT, state.y + (v * sine + side * cosine) * DT
    return State(x, y, state.yaw + w * DT, v, w, side)


def situation(costs, state, path, obstacles=NOBODY):
    """What a local planner is asked."""
    return LocalSituation(state, local_window(costs, (state.x, state.y), path, FACTORS, WindowSettings()), path, obstacles)


def drive(planner, costs, goal, *, start=START, seconds=20.0, obstacles_at=lambda t: NOBODY, limits=LIMITS):
    """States until the goal is within 0.15 m or the time is over; a planner that knows nothing free stops the vehicle."""
    states = [start]
    for k in range(round(seconds / DT)):
        state = states[-1]
        path = path_to(costs, state, goal)
        command = planner.command(situation(costs, state, path, obstacles_at(k * DT)))
        states.append(moved(state, command or STOP, limits))
        if np.hypot(states[-1].x - goal[0], states[-1].y - goal[1]) < 0.15:
            break
    return states
