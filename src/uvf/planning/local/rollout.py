"""One kernel that drives many candidate command sequences ahead and says what each would meet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.headings import HEADINGS, STEP
from uvf.planning.local.planner import Limits, State, fastest_turn
from uvf.planning.local.window import Bits, Grids

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Motion = tuple[float, float, float, float, float, float, float, float]
"""x, y [m], yaw [rad], speed [m/s], turn rate [rad/s], cosine and sine of yaw, speed to the left [m/s]."""

UNSEEN = 4.0
SIDEWAYS = 0.1
APART = 3.0  # cells on either side between which the way to go is compared
STEEPEST = 40.0  # fall of the way to go beyond which one side of it lies where no way leads
LAST = 0.5  # m


class Others(NamedTuple):
    """Obstacles that move, and the outline that must not touch them."""

    obstacles: Floats
    """(m, 5) x, y [m], vx, vy [m/s], radius [m], in the window's frame."""
    sides: Floats
    """(n, 3) of the footprint, as ``RobotFootprint.sides`` has them."""
    circumscribed_radius: float  # m, of the footprint
    heed: float = 0.5  # m from the outline, within which an obstacle matters
    growth: float = 0.0  # m/s by which an obstacle is taken to be wider the farther ahead one looks
    doubt: tuple[float, float] = (0.1, 0.25)
    """m, m/s: distance over which nearness falls to 1/e, now, and by how much more the farther ahead one looks."""


FEATURES = 12
COLLIDED, COST, WORST, TO_GO, MEAN_TO_GO, OFF_PATH, REVERSED, TURNED, NEAR, FAST, CLOSE, ASIDE = range(FEATURES)
"""Columns of what a rollout finds: share of the horizon [0..1] that comes after the first contact (0: none); mean cost [0..1]; largest
cost [0..254]; way to go at the end [m]; its mean [m]; mean distance from the path [m]; distance driven backwards and ``SIDEWAYS`` as
much of that to the sides [m], ``UNSEEN`` times as much over unknown ground; mean turn rate [rad/s]; greatest nearness to moving
obstacles [0..1, 1 = contact, exponential]; mean cost times the square of the share of the largest speed [0..1]; share of the horizon
within the soft margin of an obstacle, weighed by 0.3 and the share of the largest speed; angle [rad] at the end between the heading
and the way on, less on the last half metre."""


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
def _heading_bit(bits: Bits, r: int, c: int, yaw: float) -> bool:
    """The bit of a heading [rad] in a cell."""
    heading = int(np.floor(yaw / STEP + 0.5)) & (HEADINGS - 1)
    return bool((bits[r, c] >> np.uint64(heading)) & np.uint64(1))


@compiled
def _cell_at(grids: Grids, across: float, up: float) -> tuple[int, int]:
    """Row and column of a place in cells from the corner of cell [0, 0]; (-1, -1) outside the window."""
    rows, columns = grids.values.shape
    return (int(up), int(across)) if 0.0 <= across < columns and 0.0 <= up < rows else (-1, -1)


@compiled
def _cell(grids: Grids, x: float, y: float) -> tuple[int, int]:
    """Row and column of a place [m] in the window; (-1, -1) where it lies outside."""
    return _cell_at(grids, (x - grids.frame[0]) / grids.frame[2], (y - grids.frame[1]) / grids.frame[2])


@compiled
def _is_blocked(grids: Grids, x: float, y: float, yaw: float) -> bool:
    """Whether the footprint touches an obstacle at a pose."""
    r, c = _cell(grids, x, y)
    return r >= 0 and _heading_bit(grids.blocked, r, c, yaw)


@compiled
def _driven(motion: Motion, command: Floats32, dt: float, limits: Limits) -> Motion:
    """The motion a step later, with the command (3,) followed as fast as the limits allow."""
    x, y, yaw, speed, turn, cosine, sine, side = motion
    wanted = min(max(float(command[0]), limits.min_speed), limits.max_speed)
    speed += min(max(wanted - speed, -limits.acceleration * dt), limits.acceleration * dt)
    most = fastest_turn(limits, speed)
    wanted = min(max(float(command[1]), -most), most)
    turn += min(max(wanted - turn, -limits.angular_acceleration * dt), limits.angular_acceleration * dt)
    if limits.turning_radius > 0.0:
        turn = min(max(turn, -most), most)
    if limits.side_speed > 0.0:
        wanted = min(max(float(command[2]), -limits.side_speed), limits.side_speed)
        side += min(max(wanted - side, -limits.acceleration * dt), limits.acceleration * dt)
    half = 0.5 * turn * dt
    cosine, sine = _turned(cosine, sine, half)
    ahead, aside = speed * dt, (side - limits.sideslip * speed * turn) * dt
    x += ahead * cosine - aside * sine
    y += ahead * sine + aside * cosine
    cosine, sine = _turned(cosine, sine, half)
    return x, y, yaw + turn * dt, speed, turn, cosine, sine, side


@compiled
def _predicted(state: State, horizon: int, step: tuple[float, Limits], others: Others) -> tuple[Floats, NDArray[np.int64]]:
    """(horizon, m, 3) x, y, radius [m] of the obstacles that the vehicle may come near, step by step, and how many they are."""
    dt, limits = step
    obstacles = others.obstacles
    discs = np.empty((horizon, obstacles.shape[0], 3))
    counts = np.zeros(horizon, dtype=np.int64)
    fastest = max(abs(limits.min_speed), abs(limits.max_speed), abs(state.speed)) + limits.side_speed
    for i in range(horizon):
        ahead = (i + 1) * dt
        for m in range(obstacles.shape[0]):
            x, y = obstacles[m, 0] + ahead * obstacles[m, 2], obstacles[m, 1] + ahead * obstacles[m, 3]
            radius = obstacles[m, 4] + others.growth * ahead
            reach = others.circumscribed_radius + radius + others.heed + fastest * ahead
            if (x - state.x) ** 2 + (y - state.y) ** 2 < reach * reach:
                discs[i, counts[i], 0], discs[i, counts[i], 1], discs[i, counts[i], 2] = x, y, radius
                counts[i] += 1
    return discs, counts


@compiled
def _closest(discs: Floats, count: int, others: Others, motion: Motion, most: float) -> float:
    """Distance [m] from the outline to the nearest of the discs, ``most`` at most, which is not below 0; at corners no more than that."""
    x, y, _, _, _, cosine, sine, _ = motion
    closest = most
    for m in range(count):
        dx, dy = discs[m, 0] - x, discs[m, 1] - y
        reach, square = others.circumscribed_radius + discs[m, 2] + closest, dx * dx + dy * dy
        if square < reach * reach:
            gap = max(_gap(others.sides, dx, dy, cosine, sine), np.sqrt(square) - others.circumscribed_radius)
            closest = min(closest, gap - discs[m, 2])
    return closest


@compiled
def _aside(grids: Grids, motion: Motion, to_go: float) -> float:
    """Angle [rad] between the heading and the direction in which the way to go falls, less where little of it is left."""
    x, y, _, _, _, cosine, sine, _ = motion
    x, y = (x - grids.frame[0]) / grids.frame[2], (y - grids.frame[1]) / grids.frame[2]
    ahead = _sample(grids.to_go, x - APART, y) - _sample(grids.to_go, x + APART, y)
    left = _sample(grids.to_go, x, y - APART) - _sample(grids.to_go, x, y + APART)
    steep = np.hypot(ahead, left)
    if not 0.0 < steep < STEEPEST * APART * grids.frame[2]:
        return 0.0
    angle: float = np.arccos(min(max((ahead * cosine + left * sine) / steep, -1.0), 1.0))
    return angle * min(to_go / LAST, 1.0)


@compiled
def _backed(grids: Grids, motion: Motion, radius: float, dt: float) -> float:
    """What a step counts as driven backwards [m]: more where the ground at its end is unknown; radius: [m], of its outline."""
    x, y, _, speed, _, cosine, sine, side = motion
    back = 0.0
    if speed < 0.0:
        r, c = _cell(grids, x - radius * cosine, y - radius * sine)
        back -= speed * dt * (1.0 if r >= 0 and grids.seen[r, c] else UNSEEN)
    if side != 0.0:
        far = radius if side > 0.0 else -radius
        r, c = _cell(grids, x - far * sine, y + far * cosine)
        back += SIDEWAYS * abs(side) * dt * (1.0 if r >= 0 and grids.seen[r, c] else UNSEEN)
    return back


@compiled
def _roll(
    grids: Grids,
    state: State,
    commands: Floats32,
    step: tuple[float, Limits],
    moving: tuple[Others, Floats, NDArray[np.int64]],
    out: Floats32,
) -> None:
    """One rollout: fills ``out`` (FEATURES,) for commands (n, 3), among discs as ``_predicted`` gives them."""
    dt, limits = step
    others, discs, counts = moving
    x0, y0, per_metre = grids.frame[0], grids.frame[1], 1.0 / grids.frame[2]
    horizon = commands.shape[0]
    cost = worst = mean_to_go = off_path = back = turned = collided = fast = close = to_go = 0.0
    apart = np.inf  # least distance to what moves, in units of the doubt about where it is
    motion = state.x, state.y, state.yaw, state.speed, state.turn_rate, np.cos(state.yaw), np.sin(state.yaw), state.side
    slowness = 1.0 / limits.max_speed
    inside = _is_blocked(grids, state.x, state.y, state.yaw)
    for i in range(horizon):
        motion = _driven(motion, commands[i], dt, limits)
        x, y, yaw, speed, turn, _, _, side = motion
        share = (speed if side == 0.0 else np.hypot(speed, side)) * slowness
        across, up = (x - x0) * per_metre, (y - y0) * per_metre
        r, c = _cell_at(grids, across, up)
        if r >= 0:
            if not _heading_bit(grids.blocked, r, c, yaw):
                inside = False
                close += 0.3 + abs(share) if _heading_bit(grids.close, r, c, yaw) else 0.0
            elif inside:  # it was there from the start: the sooner it is out the better
                close += 1.3
            else:
                collided = 1.0 - i / horizon
        to_go = _sample(grids.to_go, across, up)
        if counts[i] > 0:
            doubt = others.doubt[0] + others.doubt[1] * (i + 1) * dt
            closest = _closest(discs[i], counts[i], others, motion, min(others.heed, apart * doubt))
            if closest <= 0.0:
                collided = max(collided, 1.0 - i / horizon)
            if closest < others.heed:
                apart = min(apart, max(closest, 0.0) / doubt)
        if collided > 0.0:
            mean_to_go += (horizon - i) * to_go
            break
        if r >= 0:
            value = float(grids.values[r, c])
            cost, fast, worst = cost + value, fast + value * share * share, max(worst, value)
            off_path += grids.off_path[r, c]
        mean_to_go += to_go
        turned += abs(turn)
        if speed < 0.0 or side != 0.0:
            back += _backed(grids, motion, others.circumscribed_radius, dt)
    out[COLLIDED], out[COST], out[WORST] = collided, cost / (252.0 * horizon), worst
    out[TO_GO], out[MEAN_TO_GO], out[OFF_PATH] = to_go, mean_to_go / horizon, off_path / horizon
    out[REVERSED], out[TURNED], out[NEAR] = back, turned / horizon, np.exp(-apart)
    out[FAST], out[CLOSE] = fast / (252.0 * horizon), close / horizon
    out[ASIDE] = _aside(grids, motion, to_go)


@compiled
def roll_out(grids: Grids, state: State, commands: Floats32, step: tuple[float, Limits], others: Others, out: Floats32) -> None:
    """Fills ``out`` (k, FEATURES) for commands (k, n, 3) of speed [m/s], turn rate [rad/s] and speed to the left [m/s], each held a step.

    state: pose and velocity in the window's frame; step: (duration [s], limits: the vehicle follows commands as fast as they
    allow). After a contact a rollout stands still; a vehicle that touches something from the start may get out of it.
    """
    discs, counts = _predicted(state, commands.shape[1], step, others)
    for k in range(commands.shape[0]):
        _roll(grids, state, commands[k], step, (others, discs, counts), out[k])
