"""The stop against a plain simulation: what it lets through can brake as promised without touching anything."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvf.maths.kinematics import Twist
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local.swept_stop import safe_share

JACKAL = RobotFootprint.polygon(np.array(((-0.254, -0.216), (0.254, -0.216), (0.254, 0.216), (-0.254, 0.216))))
ROUND = RobotFootprint.circle(0.3)
BRAKE = (0.1, 4.0, 10.0)  # s, m/s^2, rad/s^2
MARGIN = 0.02  # m


def is_touched(points, pose, footprint):
    """Whether a point is inside the outline at a pose (x, y, yaw); points and pose in one frame."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    seen = (points - np.array(pose[:2])) @ np.array(((c, -s), (s, c)))
    if footprint.round:
        return bool((np.hypot(seen[:, 0], seen[:, 1]) < footprint.inscribed_radius).any())
    sides = footprint.sides()
    return bool((seen @ sides[:, :2].T < sides[:, 2]).all(axis=1).any())


def braked(points, command, footprint):
    """Whether a vehicle that drives on for the reaction time, then brakes both rates together along its arc, touches nothing."""
    pose, (v, w, side), dt = np.zeros(3), command, 0.002
    slowing = max(np.hypot(v, side) / BRAKE[1], abs(w) / BRAKE[2])
    for k in range(round((BRAKE[0] + slowing) / dt)):
        left = 1.0 if k * dt < BRAKE[0] or slowing == 0.0 else max(1.0 - (k * dt - BRAKE[0]) / slowing, 0.0)
        c, s = np.cos(pose[2]), np.sin(pose[2])
        pose = pose + left * dt * np.array((v * c - side * s, v * s + side * c, w))
        if is_touched(points, pose, footprint):
            return False
    return True


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)), min_size=1, max_size=12),
    st.builds(Twist, st.floats(-2.0, 2.0), st.floats(-3.0, 3.0), st.sampled_from((0.0, 0.8, -1.5))),
    st.sampled_from((JACKAL, ROUND)),
)
def test_what_passes_can_brake_without_a_touch(places, command, footprint):
    points = np.array(places)
    if is_touched(points, np.zeros(3), footprint.padded(MARGIN)):
        return
    share = safe_share(points, command, footprint, MARGIN, BRAKE)
    assert 0.0 <= share <= 1.0
    assert braked(points, Twist(*(share * part for part in command)), footprint)


@pytest.mark.parametrize("footprint", [JACKAL, ROUND])
def test_a_vehicle_at_full_speed_before_a_wall_never_touches_it(footprint):
    """Closed loop at 20 Hz, the stop alone against a driver who wants to go on: it comes near and stays off."""
    wall = np.column_stack((np.full(81, 2.0), np.linspace(-2.0, 2.0, 81)))
    x, v = 0.0, 2.0
    for _ in range(200):
        share = safe_share(wall - np.array((x, 0.0)), Twist(2.0, 0.0), footprint, MARGIN, BRAKE)
        wanted = 2.0 * share
        v = max(wanted, v - BRAKE[1] * 0.05)
        x += v * 0.05
    reach = 0.254 if footprint is JACKAL else 0.3
    assert 2.0 - x - reach >= 0.0
    assert 2.0 - x - reach < 0.4


def test_nothing_near_lets_all_through_and_turning_counts_the_corners():
    assert safe_share(np.zeros((0, 2)), Twist(2.0, 1.0), JACKAL, MARGIN, BRAKE) == 1.0
    assert safe_share(np.array(((50.0, 0.0),)), Twist(2.0, 0.0), JACKAL, MARGIN, BRAKE) == 1.0
    beside = np.array(((0.0, 0.26),))  # a corner passes here in a turn
    assert safe_share(beside, Twist(0.0, 2.0), JACKAL, MARGIN, BRAKE) < 1.0
    assert safe_share(beside, Twist(0.0, 2.0), RobotFootprint.circle(0.2), MARGIN, BRAKE) == 1.0


def test_who_touches_already_may_only_move_away():
    ahead = np.array(((0.25, 0.0),))
    assert safe_share(ahead, Twist(0.5, 0.0), JACKAL, MARGIN, BRAKE) == 0.0
    assert safe_share(ahead, Twist(-0.5, 0.0), JACKAL, MARGIN, BRAKE) > 0.0
