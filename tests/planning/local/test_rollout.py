"""Features of rollouts against a second computation in plain numpy, by the definitions."""

import numpy as np
import pytest

from tests.planning.local.grounds import BODY, DT, LIMITS, ground, situation
from uvf.planning.costmap.headings import heading_bin
from uvf.planning.local import rollout
from uvf.planning.local.planner import State
from uvf.planning.local.rollout import FEATURES, Others, roll_out

STEPS = 40
BOX = (0.6, -0.3, 1.0, 0.4)
PATH = np.column_stack((np.linspace(-1.0, 3.0, 41), np.linspace(0.0, 0.4, 41)))
MOVING = np.array(((1.5, 1.5, -0.4, -0.8, 0.3), (-1.0, 2.0, 0.5, -0.7, 0.2)))
OTHERS = Others(MOVING, BODY.sides(), BODY.circumscribed_radius, heed=1.5, growth=0.1, doubt=(0.1, 0.25))


def poses(state, commands, limits=LIMITS):
    """(n, 6) x, y, yaw, speed, turn rate, speed to the left after each step."""
    x, y, yaw, v, w, side = state
    rows = []
    for wanted, turn, across in commands:
        v = v + np.clip(np.clip(wanted, LIMITS.min_speed, LIMITS.max_speed) - v, -LIMITS.acceleration * DT, LIMITS.acceleration * DT)
        most = min(LIMITS.max_turn_rate, LIMITS.lateral_acceleration / max(abs(v), 1e-3))
        w = w + np.clip(np.clip(turn, -most, most) - w, -LIMITS.angular_acceleration * DT, LIMITS.angular_acceleration * DT)
        most = LIMITS.acceleration * DT
        side = side + np.clip(np.clip(across, -limits.side_speed, limits.side_speed) - side, -most, most)
        c, s = np.cos(yaw + w * DT / 2), np.sin(yaw + w * DT / 2)
        x, y, yaw = x + (v * c - side * s) * DT, y + (v * s + side * c) * DT, yaw + w * DT
        rows.append((x, y, yaw, v, w, side))
    return np.array(rows)


def outline_gap(row, disc, radius):
    """Distance [m] from the outline to a disc, as the largest of those to its sides and to the circle about it."""
    c, s = np.cos(row[2]), np.sin(row[2])
    dx, dy = disc[0] - row[0], disc[1] - row[1]
    return max(abs(c * dx + s * dy) - 0.25, abs(c * dy - s * dx) - 0.2, np.hypot(dx, dy) - np.hypot(0.25, 0.2)) - radius


def expected(now, commands, limits=LIMITS):
    """(FEATURES,) by the definitions in ``rollout``, one pose after the other."""
    g = now.grids
    x0, y0, resolution = g.frame
    rows, n = poses(now.state, commands, limits), len(commands)
    sums = dict.fromkeys(("cost", "to_go", "off", "back", "turn", "near", "fast", "close"), 0.0)
    worst, collided, to_go = 0.0, 0.0, 0.0
    for i, row in enumerate(rows):
        r, c = int((row[1] - y0) // resolution), int((row[0] - x0) // resolution)
        bit = np.uint64(1) << np.uint64(heading_bin(row[2]))
        share = np.hypot(row[3], row[5]) / LIMITS.max_speed
        if g.blocked[r, c] & bit:
            collided = 1.0 - i / n
        elif g.close[r, c] & bit:
            sums["close"] += 0.3 + abs(share)
        u, v = (row[0] - x0) / resolution - 0.5, (row[1] - y0) / resolution - 0.5
        a, b = int(u), int(v)
        patch = g.to_go[b : b + 2, a : a + 2].astype(float)
        to_go = float(np.array((1 - (v - b), v - b)) @ patch @ np.array((1 - (u - a), u - a)))
        ahead = (i + 1) * DT
        gaps = [outline_gap(row, disc[:2] + ahead * disc[2:4], disc[4] + OTHERS.growth * ahead) for disc in MOVING]
        if min(gaps) <= 0.0:
            collided = max(collided, 1.0 - i / n)
        if min(gaps) < OTHERS.heed:
            nearness = np.exp(-max(min(gaps), 0.0) / (OTHERS.doubt[0] + OTHERS.doubt[1] * ahead))
            sums["near"] = max(sums["near"], nearness)
        if collided:
            sums["to_go"] += (n - i) * to_go
            break
        value = float(g.values[r, c])
        worst = max(worst, value)
        sums["cost"] += value
        sums["fast"] += value * share**2
        sums["off"] += g.off_path[r, c]
        sums["to_go"] += to_go
        sums["turn"] += abs(row[4])
        sums["back"] += (max(-row[3], 0.0) + rollout.SIDEWAYS * abs(row[5])) * DT
    out = np.zeros(FEATURES)
    out[rollout.COLLIDED], out[rollout.COST], out[rollout.WORST] = collided, sums["cost"] / (252 * n), worst
    out[rollout.TO_GO], out[rollout.MEAN_TO_GO], out[rollout.OFF_PATH] = to_go, sums["to_go"] / n, sums["off"] / n
    out[rollout.REVERSED], out[rollout.TURNED], out[rollout.NEAR] = sums["back"], sums["turn"] / n, sums["near"]
    out[rollout.FAST], out[rollout.CLOSE] = sums["fast"] / (252 * n), sums["close"] / n
    return out


def rolled(now, commands, others=OTHERS, limits=LIMITS):
    out = np.empty((len(commands), FEATURES), dtype=np.float32)
    roll_out(now.grids, now.state, commands, (DT, limits), others, out)
    return out


@pytest.mark.parametrize("limits", [LIMITS, LIMITS._replace(side_speed=0.6)])
def test_features_are_those_of_their_definitions(limits):
    state = State(-0.6, 0.05, 0.1, 0.6, 0.2)
    now = situation(ground(BOX), state, PATH)
    rng = np.random.default_rng(7)
    commands = rng.normal((0.7, 0.0, 0.0), (0.8, 1.2, 0.5), (60, 1, 3)) + rng.normal(0.0, 0.3, (60, STEPS, 3))
    commands = commands.astype(np.float32)
    found = rolled(now, commands, limits=limits)
    wanted = np.array([expected(now, row, limits) for row in commands.astype(float)])
    assert (wanted[:, rollout.COLLIDED] > 0.0).sum() > 5 and (wanted[:, rollout.COLLIDED] == 0.0).sum() > 5
    assert (wanted[:, rollout.REVERSED] > 0.0).sum() > 5 and (wanted[:, rollout.NEAR] > 0.3).sum() > 5
    found, wanted = np.delete(found, rollout.ASIDE, axis=1), np.delete(wanted, rollout.ASIDE, axis=1)
    same = np.isclose(found, wanted, rtol=1e-3, atol=1e-3).all(axis=1)
    assert same.mean() >= 0.95, found[~same] - wanted[~same]  # a pose on a cell's very border may fall to either side


def test_a_vehicle_that_skids_slides_out_of_its_curve():
    """On a circle the way across is the sideslip times speed, turn rate and time; the way that it was driven along stays the same."""
    state = State(0.0, 0.0, 0.0, 1.0, 1.0)
    now = situation(ground(), state, PATH)
    turn = np.tile(np.float32((1.0, 1.0, 0.0)), (1, STEPS, 1))
    t = np.linspace(0.0, STEPS * DT, 20001)
    ahead, aside = 1.0, -0.1 * 1.0 * 1.0
    x = np.trapezoid(ahead * np.cos(t) - aside * np.sin(t), t)
    y = np.trapezoid(ahead * np.sin(t) + aside * np.cos(t), t)
    disc = np.array(((x, y, 0.0, 0.0, 1e-3),))  # where the vehicle ends
    others = OTHERS._replace(obstacles=disc, growth=0.0, sides=np.array([(np.cos(a), np.sin(a), 0.02) for a in np.arange(0.0, 6.28, 0.1)]))
    touched = []
    for sideslip in (0.1, 0.0):
        out = np.empty((1, FEATURES), dtype=np.float32)
        roll_out(now.grids, now.state, turn, (DT, LIMITS._replace(sideslip=sideslip)), others, out)
        touched.append(out[0, rollout.COLLIDED])
    assert 0.0 < touched[0] < 0.1
    assert touched[1] == 0.0


@pytest.mark.parametrize("side", [0.5, -0.5])
def test_going_sideways_over_unseen_ground_counts_more(side):
    state, limits = State(0.0, 0.0, 0.0, 0.0, 0.0, side), LIMITS._replace(side_speed=0.5)
    now = situation(ground(), state, PATH)
    across = np.tile(np.float32((0.0, 0.0, side)), (1, STEPS, 1))
    nobody = OTHERS._replace(obstacles=np.zeros((0, 5)))
    known = rolled(now, across, nobody, limits)[0, rollout.REVERSED]
    assert known == pytest.approx(rollout.SIDEWAYS * 0.5 * STEPS * DT, rel=1e-4)
    unseen = type(now)(now.state, now.grids._replace(seen=np.zeros_like(now.grids.seen)), now.path)
    assert rolled(unseen, across, nobody, limits)[0, rollout.REVERSED] == pytest.approx(rollout.UNSEEN * known)


def test_reversing_over_unseen_ground_counts_more():
    state = State(0.0, 0.0, 0.0, -0.5, 0.0)
    now = situation(ground(), state, PATH)
    back = np.tile(np.float32((-0.5, 0.0, 0.0)), (1, STEPS, 1))
    known = rolled(now, back)[0, rollout.REVERSED]
    unseen = type(now)(now.state, now.grids._replace(seen=np.zeros_like(now.grids.seen)), now.path)
    assert rolled(unseen, back)[0, rollout.REVERSED] == pytest.approx(rollout.UNSEEN * known)


def test_a_vehicle_that_touches_from_the_start_may_get_out():
    state = State(0.5, 0.0, 0.0, 0.0, 0.0)  # its front is in the box
    now = situation(ground(BOX), state, PATH)
    commands = np.stack([np.tile(np.float32((v, 0.0, 0.0)), (STEPS, 1)) for v in (-0.5, 0.0)])
    nobody = OTHERS._replace(obstacles=np.zeros((0, 5)))
    found = rolled(now, commands, nobody)
    assert (found[:, rollout.COLLIDED] == 0.0).all()
    assert found[0, rollout.CLOSE] < found[1, rollout.CLOSE]
