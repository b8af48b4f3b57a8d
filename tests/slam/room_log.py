"""A drive round the made-up room as files: a CARMEN log with drifting odometry, and the true relations beside it."""

from math import pi

import numpy as np

from tests.slam.logs.carmen_text import robotlaser
from tests.slam.room import ANGLES, RANGE_MAX, measured
from uvf.maths.se2_arrays import composed, inverted, steps

READINGS, PERIOD, BEGIN = 80, 0.3, 500.0
FAN = (0.0, 2 * pi, ANGLES[1], RANGE_MAX)


def true_way(n=READINGS):
    """(n, 3) world_from_base: once round on an ellipse."""
    angle = np.linspace(0.0, 1.9 * pi, n)
    x, y = 1.1 * np.cos(angle) - 0.4, 0.7 * np.sin(angle) + 0.2
    return np.column_stack((x, y, np.unwrap(np.arctan2(0.7 * np.cos(angle), -1.1 * np.sin(angle)))))


def stamps(n=READINGS):
    return BEGIN + PERIOD * np.arange(n)


def write_room_log(folder, seed=1):
    """Writes room.clf and room.relations; returns the log's path. The odometry turns 2 % too far."""
    rng = np.random.default_rng(seed)
    truth, odometry = true_way(), [np.zeros(3)]
    for step in steps(truth):
        odometry.append(composed(odometry[-1], step * (1.0, 1.0, 1.02)))
    ranges = [np.where((r := measured(pose, rng)) > 0.0, r, RANGE_MAX + 0.1).round(3) for pose in truth]
    lines = [robotlaser(t, pose, r, pose, fan=FAN) for t, pose, r in zip(stamps(), np.array(odometry).tolist(), ranges, strict=True)]
    path = folder / "room.clf"
    path.write_text("\n".join(lines) + "\n")
    relations = []
    for i, j in [(i, i + 3) for i in range(0, READINGS - 4, 3)] + [(0, READINGS - 1), (2, READINGS - 3)]:
        x, y, yaw = composed(inverted(truth[i]), truth[j])
        relations.append(f"{stamps()[i]:.6f} {stamps()[j]:.6f} {x} {y} 0 0 0 {yaw}")
    path.with_suffix(".relations").write_text("\n".join(relations) + "\n")
    return path
