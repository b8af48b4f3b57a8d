"""One kernel that drives many candidate command sequences ahead and says what each would meet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.headings import HEADINGS, STEP
from uvf.planning.local.planner import Limits, State
from uvf.planning.local.window import Grids

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]


class Others(NamedTuple):
    """Obstacles that move, and the outline that must not touch them."""

    obstacles: Floats
    """(m, 5) x, y [m], vx, vy [m/s], radius [m], in the window's frame."""
    sides: Floats
    """(n, 3) of the footprint, as ``RobotFootprint.sides`` has them."""
    circumscribed_radius: float  # m, of the footprint
    heed: float  # m from the outline, within which an obstacle matters
    growth: float  # m/s by which an obstacle is taken to be wider the farther ahead one looks


FEATURES = 11
COLLIDED, COST, WORST, TO_GO, MEAN_TO_GO, OFF_PATH, REVERSED, TURNED, NEAR, FAST, CLOSE = range(FEATURES)
"""Columns of what a rollout finds: share of the horizon [0..1] that comes after the first contact (0: none); mean cost [0..1]; largest
cost [0..254]; way to go at the end [m]; its mean [m]; mean distance from the path [m]; distance driven backwards [m]; mean turn rate
[rad/s]; mean nearness to moving obstacles [0..1, 1 = contact]; mean cost times the square of the share of the largest speed [0..1];
share of the horizon within the soft margin of an obstacle, weighed by 0.3 and the share of the largest speed."""


@compiled
def _sample(field: Floats32, x: float, y: float) -> float:
    """Bilinear, at (x, y) in cells from the corner of cell [0, 0]; at the border the nearest cell's."""
    rows, columns = field.shape
    x, y = min(max(x - 0.5, 0.0), columns - 1.000001), min(max(y - 0.5, 0.0), rows - 1.000001)
    c, r = int(x), int(y)
    u, v = x - c, y - r
    below = field[r, c] * (1.0 - u) + field[r, c + 1] * u
    above = field[r + 1, c] * (1.0 - u) + field[r + 1, c + 1] * u
    sampled: float = below * (1.0 - v) + above * v
    return sampled


@compiled
def _turned(cosine: float, sine: float, angle: float) -> tuple[float, float]:
    """Cosine and sine of a heading turned by a small angle [rad], by their series to the fifth power."""
    square = angle * angle
    c = 1.0 - square * (0.5 - square / 24.0)
    s = angle * (1.0 - square * (1.0 / 6.0 - square / 120.0))
    return cosine * c - sine * s, sine * c + cosine * s


@compiled
def _gap(sides: Floats, x: float, y: float, cosine: float, sine: float) -> float:
    """Distance [m] from a point, relative to the vehicle's centre, to its outline, below 0 inside; at corners no more than the true one."""
    ahead, left = cosine * x + sine * y, cosine * y - sine * x
    gap = -np.inf
    for k in range(sides.shape[0]):
        gap = max(gap, sides[k, 0] * ahead + sides[k, 1] * left - sides[k, 2])
    return gap


@compiled
def _is_blocked(grids: Grids, x: float, y: float, yaw: float) -> bool:
    """Whether the footprint touches an obstacle at a pose."""
    r, c = int(np.floor((y - grids.frame[1]) / grids.frame[2])), int(np.floor((x - grids.frame[0]) / grids.frame[2]))
    if not (0 <= r < grids.values.shape[0] and 0 <= c < grids.values.shape[1]):
        return False
    heading = int(np.floor(yaw / STEP + 0.5)) & (HEADINGS - 1)
    return bool((grids.blocked[r, c] >> np.uint64(heading)) & np.uint64(1))


@compiled
def roll_out(
    grids: Grids,
    state: State,
    commands: Floats32,
    step: tuple[float, Limits],
    others: Others,
    out: Floats32,
) -> None:
    """Fills ``out`` (k, FEATURES) for the commands (k, n, 2) of speed [m/s] and turn rate [rad/s], each held for a step.

    state: x, y, yaw, speed, turn rate in the window's frame; step: (duration [s], limits: the vehicle follows commands as fast as they
    allow). After a contact a rollout stands still; a vehicle
    that touches something from the start may get out of it.
    """
    dt, limits = step
    obstacles, heed = others.obstacles, others.heed
    x0, y0, resolution = grids.frame
    rows, columns = grids.values.shape
    horizon = commands.shape[1]
    dv, dw = limits.acceleration * dt, limits.angular_acceleration * dt
    for k in range(commands.shape[0]):
        x, y, yaw, speed, turn = state
        cost = worst = mean_to_go = off_path = back = turned = near = collided = fast = close = 0.0
        to_go, cosine, sine = 0.0, np.cos(yaw), np.sin(yaw)
        inside = _is_blocked(grids, x, y, yaw)
        for i in range(horizon):
            wanted = min(max(float(commands[k, i, 0]), limits.min_speed), limits.max_speed)
            speed += min(max(wanted - speed, -dv), dv)
            most = min(limits.max_turn_rate, limits.lateral_acceleration / max(abs(speed), 1e-3))
            wanted = min(max(float(commands[k, i, 1]), -most), most)
            turn += min(max(wanted - turn, -dw), dw)
            half = 0.5 * turn * dt
            cosine, sine = _turned(cosine, sine, half)
            x += speed * dt * cosine
            y += speed * dt * sine
            cosine, sine = _turned(cosine, sine, half)
            yaw += turn * dt
            in_x, in_y = (x - x0) / resolution, (y - y0) / resolution
            r, c = int(np.floor(in_y)), int(np.floor(in_x))
            value, beside = 0, 0.0
            if 0 <= r < rows and 0 <= c < columns:
                value, beside = int(grids.values[r, c]), float(grids.off_path[r, c])
                heading = int(np.floor(yaw / STEP + 0.5)) & (HEADINGS - 1)
                if (grids.blocked[r, c] >> np.uint64(heading)) & np.uint64(1):
                    if inside:  # it was there from the start: the sooner it is out the better
                        close += 1.3
                    else:
                        collided = 1.0 - i / horizon
                else:
                    inside = False
                    if (grids.close[r, c] >> np.uint64(heading)) & np.uint64(1):
                        close += 0.3 + abs(speed) / limits.max_speed
            to_go = _sample(grids.to_go, in_x, in_y)
            if obstacles.shape[0] > 0:
                ahead, closest = (i + 1) * dt, heed
                for m in range(obstacles.shape[0]):
                    dx, dy = obstacles[m, 0] + ahead * obstacles[m, 2] - x, obstacles[m, 1] + ahead * obstacles[m, 3] - y
                    reach = others.circumscribed_radius + obstacles[m, 4] + others.growth * ahead + closest
                    if dx * dx + dy * dy < reach * reach:
                        closest = min(closest, _gap(others.sides, dx, dy, cosine, sine) - obstacles[m, 4] - others.growth * ahead)
                if closest <= 0.0:
                    collided = max(collided, 1.0 - i / horizon)
                near += (heed - max(closest, 0.0)) / heed
            if collided > 0.0:
                left = horizon - i
                mean_to_go += left * to_go
                break
            cost += value
            fast += value * (speed / limits.max_speed) ** 2
            worst = max(worst, value)
            mean_to_go += to_go
            off_path += beside
            back += max(-speed, 0.0) * dt
            turned += abs(turn)
        out[k, COLLIDED], out[k, COST], out[k, WORST] = collided, cost / (252.0 * horizon), worst
        out[k, TO_GO], out[k, MEAN_TO_GO], out[k, OFF_PATH] = to_go, mean_to_go / horizon, off_path / horizon
        out[k, REVERSED], out[k, TURNED], out[k, NEAR] = back, turned / horizon, near / horizon
        out[k, FAST], out[k, CLOSE] = fast / (252.0 * horizon), close / horizon
