"""What the lidar does not see: a pallet below it, a table's edge above it, what a sonar hears, and what has been touched."""

import numpy as np
import pytest

from uvf.maths.se2 import Pose2, transform
from uvf.planning.costmap.bumps import FREE, Bump, BumpSense
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import REMEMBERED, HiddenObstacles, unexplained
from uvf.planning.costmap.range_sights import cone_sight, depth_sight

EYE, HEIGHT, TOP, REACH = (0.1, 0.0), 0.2, 0.35, 3.0
BOX = RobotFootprint.polygon(np.array(((0.2, 0.15), (-0.2, 0.15), (-0.2, -0.15), (0.2, -0.15))))
HERE = Pose2(0.0, 0.0, 0.0)


def pictured(low, high, ahead, half=0.3, reach=3.0):
    """What a level depth camera sees of a floor and a front ``ahead`` [m], ``low`` to ``high`` [m] and ``half`` [m] to each side."""
    left, up = np.meshgrid(np.tan(np.linspace(-0.5, 0.5, 81)), np.tan(np.linspace(-0.5, 0.5, 61)))
    distance = np.where(up < -1e-6, HEIGHT / np.maximum(-up, 1e-6), 99.0)
    front = ahead - EYE[0]
    z = HEIGHT + up * front
    hit = (z >= low) & (z <= high) & (np.abs(left * front) <= half) & (front < distance)
    distance[hit] = front
    points = np.stack((EYE[0] + distance, left * distance, HEIGHT + up * distance), axis=2).reshape(-1, 3)
    return points[points[:, 0] < reach]


def obstacles(points, hidden=None):
    hidden = hidden or HiddenObstacles(8.0, 0.05, 30.0)
    hidden.see("depth camera", (1.0, 1.0), HERE, depth_sight((*EYE, HEIGHT), points, TOP, REACH))
    return hidden.points(1.0, (0.0, 0.0), 4.0)


@pytest.mark.parametrize(("low", "high"), [(0.0, 0.14), (0.3, 0.5), (0.0, 0.06)], ids=["pallet", "table's edge", "sill"])
def test_a_depth_camera_sees_what_is_in_the_way_of_the_body(low, high):
    found = obstacles(pictured(low, high, ahead=1.2))
    assert len(found) >= 8
    assert found[:, 0] == pytest.approx(1.2, abs=0.06)
    assert np.abs(found[:, 1]).max() < 0.36


@pytest.mark.parametrize(("low", "high"), [(0.4, 0.8), (0.0, 0.02)], ids=["above the vehicle", "a threshold"])
def test_what_it_passes_under_or_rolls_over_is_none(low, high):
    assert len(obstacles(pictured(low, high, ahead=1.2))) == 0


def test_a_single_wrong_pixel_is_none():
    assert len(obstacles(np.vstack((pictured(0.0, 0.0, ahead=9.0), (0.8, 0.0, 0.2))))) == 0


def test_ground_seen_free_clears_what_was_there_but_not_below_the_picture():
    hidden = HiddenObstacles(8.0, 0.05, 30.0)
    assert len(obstacles(pictured(0.0, 0.14, ahead=1.2), hidden)) > 0
    assert len(obstacles(pictured(0.0, 0.0, ahead=9.0), hidden)) == 0
    close = EYE[0] + HEIGHT / np.tan(0.5) - 0.1
    before = obstacles(pictured(0.0, 0.3, ahead=close), hidden)
    assert len(before) > 0
    assert len(obstacles(pictured(0.0, 0.0, ahead=9.0), hidden)) == len(before)


def profile_seen(slopes, pitch=0.0, height=HEIGHT):
    """What a depth camera pitched by ``pitch`` [rad, up] sees of ground that is level about it and has ``slopes`` [m, m] from there on."""
    left, up = np.meshgrid(np.tan(np.linspace(-0.5, 0.5, 81)), np.tan(np.linspace(-0.5, 0.5, 61) + pitch))
    x, z = np.arange(0.0, 20.0, 0.002), np.zeros(10_000)
    for ahead, rise in slopes:
        z += np.where(x > ahead, rise(x - ahead), 0.0)
    points = []
    for across, steep in zip(left.ravel(), up.ravel(), strict=True):
        below = np.flatnonzero(height + steep * x <= z)
        if len(below):
            forward = x[below[0]]
            points.append((EYE[0] + forward, across * forward, height + steep * forward))
    return np.array(points)


def cliff(depth):
    return lambda beyond: np.full_like(beyond, -depth)


DROPS = [(0.5, 0.1), *((ahead, depth) for ahead in (0.25, 0.5, 0.7) for depth in (0.2, 0.4, 2.5))]


@pytest.mark.parametrize(("ahead", "depth"), DROPS)
def test_the_edge_from_which_the_floor_drops_is_in_the_way(ahead, depth):
    found = obstacles(profile_seen([(ahead, cliff(depth))]))
    first_seen = HEIGHT / np.tan(0.5)
    assert len(found) >= 8
    assert found[:, 0].min() == pytest.approx(EYE[0] + max(ahead, first_seen), abs=0.06)


@pytest.mark.parametrize("slope", [-0.2, -0.12, 0.0], ids=["11 deg", "7 deg", "level"])
@pytest.mark.parametrize("ahead", [0.0, 0.4, 1.0, 2.0])
def test_a_ramp_that_leads_down_is_no_drop(ahead, slope):
    assert len(obstacles(profile_seen([(ahead, lambda beyond: slope * beyond)]))) == 0


def test_a_kerb_to_roll_down_is_no_drop_nor_floor_that_a_braking_vehicle_nods_to():
    assert len(obstacles(profile_seen([(0.6, cliff(0.03))]))) == 0
    assert len(obstacles(profile_seen([(0.0, lambda beyond: -0.05 * beyond)], pitch=-0.05))) == 0


def test_a_drop_too_far_to_tell_from_a_hidden_ramp_is_told_of_from_nearer():
    far, near = (obstacles(profile_seen([(ahead, cliff(0.4))])) for ahead in (1.6, 0.6))
    assert len(far) == 0
    assert len(near) > 0


@pytest.mark.parametrize("height", [0.0, -0.1])
def test_a_camera_on_the_floor_sees_no_farther_than_others(height):
    wall = np.column_stack((np.full(40, 5.0), np.linspace(-0.1, 0.1, 40), np.full(40, 0.2)))
    assert not depth_sight((*EYE, height), wall, TOP, REACH).hits.any()
    assert depth_sight((*EYE, height), wall - (3.0, 0.0, 0.0), TOP, REACH).hits.any()


def test_of_nothing_a_camera_tells_nothing():
    sight = depth_sight((*EYE, HEIGHT), np.zeros((0, 3)), TOP, REACH)
    assert sight.starts.shape == sight.ends.shape == (0, 2)


def test_a_sonar_marks_its_arc_only_where_the_lidar_does_not_explain_it():
    sight = cone_sight((0.1, 0.0), 0.0, 0.5, (1.0, 2.0))
    assert sight.hits.all()
    assert np.hypot(*(sight.ends - (0.1, 0.0)).T) == pytest.approx(1.0)
    post, aside = np.array(((1.05, 0.2),)), np.array(((0.1, 1.0),))
    assert not unexplained(sight, post).hits.any()
    assert unexplained(sight, aside).hits.all()


def test_a_silent_sonar_clears():
    hidden = HiddenObstacles(8.0, 0.05, 30.0)
    for distance, found in ((1.0, True), (0.0, False)):
        hidden.see("sonar", (1.0, 1.0), HERE, cone_sight((0.1, 0.0), 0.0, 0.5, (distance, 2.0)))
        assert (len(hidden.points(1.0, (0.0, 0.0), 4.0)) > 0) == found


def test_one_sensor_does_not_clear_what_another_has_marked():
    hidden = HiddenObstacles(8.0, 0.05, 30.0)
    before = len(obstacles(pictured(0.0, 0.14, ahead=1.2), hidden))
    hidden.see("sonar", (1.0, 1.0), HERE, cone_sight((0.1, 0.0), 0.0, 0.5, (0.0, 2.0)))
    assert len(hidden.points(1.0, (0.0, 0.0), 4.0)) == before > 0


def held_up(motion, sense=None, speeds=(1.0, 0.9, 0.5, 0.2, 0.0, 0.0)):
    """What comes of a touch that lasts while the motion falls to the shares ``speeds`` of what it was, in tenths of a second."""
    sense = sense or BumpSense(BOX, {})
    told = [sense.feel(0.1 * k, HERE, (share * motion[0], share * motion[1]), []) for k, share in enumerate(speeds)]
    assert [bump for bump in told if bump is not None] == [bump for bump in told[4:5] if bump is not None]
    return told[4] if len(told) > 4 else None


@pytest.mark.parametrize(
    ("motion", "bearing"), [((0.4, 0.0), 0.0), ((-0.2, 0.0), np.pi), ((0.4, 0.1), 0.0)], ids=["forwards", "backwards", "in a curve"]
)
def test_without_bumpers_the_side_that_led_was_touched(motion, bearing):
    bump = held_up(motion)
    middle = bump.points.mean(axis=0)
    assert abs(np.angle(np.exp(1j * (np.arctan2(middle[1], middle[0]) - bearing)))) < 0.3
    assert (np.abs(bump.points[:, 0]) > 0.2).all()
    assert bump.motion == motion


def test_turning_on_the_spot_the_corners_led():
    x, y = held_up((0.0, 1.0)).points.T
    assert (x * y > 0.0).any()
    assert (np.hypot(x, y) > 0.19).all()


def test_what_is_driven_over_is_no_obstacle():
    assert held_up((0.4, 0.0), speeds=(1.0, 0.8, 0.6, 0.6, 0.7, 0.8)) is None
    sense = BumpSense(BOX, {})
    assert held_up((0.4, 0.0), sense, speeds=(1.0, 0.6)) is None
    for k in range(6):
        sense.feel_nothing(0.2 + 0.1 * k)
    assert held_up((0.1, 0.0), sense, speeds=(1.0, 1.0, 1.0)) is None


def test_who_stands_has_not_touched_anything_by_itself():
    assert held_up((0.0, 0.0)) is None
    assert BumpSense(BOX, {}).feel(1.0, HERE, (0.0, 0.0), ["unheard of"]) is None


def test_a_bumper_tells_where_and_at_once():
    sense = BumpSense(BOX, {"rear": (2.3, 3.9), "left": (1.2, 1.9)})
    assert (sense.feel(1.0, HERE, (0.3, 0.0), ["rear"]).points[:, 0] < 0.0).all()
    assert (BumpSense(BOX, {"left": (1.2, 1.9)}).feel(1.0, HERE, (0.0, 0.0), ["left"]).points[:, 1] > 0.0).all()


def test_one_touch_is_told_of_once():
    sense, front = BumpSense(BOX, {"front": (-0.8, 0.8)}), ["front"]
    assert sense.feel(1.0, HERE, (0.3, 0.0), front) is not None
    off = Pose2(-0.1, 0.0, 0.0)
    assert sense.feel(1.1, off, (-0.2, 0.0), front) is None
    sense.feel_nothing(1.2)
    assert sense.feel(1.2 + FREE / 2, off, (-0.2, 0.0), front) is None
    sense.feel_nothing(2.0)
    sense.feel_nothing(3.0)
    assert sense.feel(3.1, off, (-0.2, 0.0), front) is not None


def test_a_touch_is_remembered_longer_than_what_is_seen_and_is_not_for_ever():
    hidden, at = HiddenObstacles(8.0, 0.05, 30.0), Pose2(2.0, 1.0, 0.5)
    points = np.array(((0.2, 0.0),))
    hidden.bump(0.0, Bump(at, (0.3, 0.0), points))
    hidden.clear(0.5, (0.0, 0.0))
    assert hidden.points(100.0, (2.0, 1.0), 1.0) == pytest.approx(transform(at, points))
    assert len(hidden.points(100.0, (-2.0, 1.0), 1.0)) == 0
    assert len(hidden.points(30.0 * REMEMBERED + 1.0, (2.0, 1.0), 1.0)) == 0
