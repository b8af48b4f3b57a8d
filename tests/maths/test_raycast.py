"""Rays against known distances, against a march along the ray, and under rotation of the whole scene."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths.raycast import cast, rectangles

NONE = np.zeros((0, 3))
NO_BOX = np.zeros((0, 6))
UNIT_BOX = rectangles(np.array([[3.0, 0.0, 1.0, 0.5, 0.0]]))
EAST, NORTH, WEST = 0.0, np.pi / 2, np.pi


def one(origin, angle, boxes=NO_BOX, circles=NONE):
    return cast(np.array(origin, dtype=float), np.array([angle]), boxes, circles)[0]


def test_the_near_face_of_a_box_is_met():
    assert one((0, 0), EAST, UNIT_BOX) == pytest.approx(2.0)


def test_a_ray_that_misses_or_looks_away_has_no_return():
    assert np.isinf(cast(np.zeros(2), np.array([NORTH, WEST, 0.5]), UNIT_BOX, NONE)).all()


def test_a_ray_along_a_face_but_beside_it_misses():
    assert one((0.0, 0.51), EAST, UNIT_BOX) == np.inf


def test_from_inside_a_box_the_wall_is_seen():
    assert one((3.0, 0.0), NORTH, UNIT_BOX) == pytest.approx(0.5)


def test_a_turned_box_shows_its_corner():
    turned = rectangles(np.array([[3.0, 0.0, 1.0, 1.0, np.pi / 4]]))
    assert one((0, 0), EAST, turned) == pytest.approx(3.0 - np.sqrt(2))


def test_a_circle_is_met_at_its_rim_from_outside_and_inside():
    circle = np.array([[0.0, 2.0, 0.5]])
    assert one((0, 0), NORTH, circles=circle) == pytest.approx(1.5)
    assert one((0, 2.0), EAST, circles=circle) == pytest.approx(0.5)


def test_the_nearest_of_several_counts():
    assert one((0, 0), EAST, UNIT_BOX, np.array([[1.0, 0.0, 0.25], [1.5, 0.0, 0.25]])) == pytest.approx(0.75)


def inside_any(point, boxes, circles):
    for x, y, half_x, half_y, c, s in boxes:
        dx, dy = point[0] - x, point[1] - y
        if abs(c * dx + s * dy) <= half_x and abs(c * dy - s * dx) <= half_y:
            return True
    return any(np.hypot(point[0] - x, point[1] - y) <= r for x, y, r in circles)


def march(origin, angle, scene, step, far):
    direction = np.array((np.cos(angle), np.sin(angle)))
    return next((d for d in np.arange(0.0, far, step) if inside_any(origin + d * direction, *scene)), np.inf)


def scene_of(seed):
    rng = np.random.default_rng(seed)
    boxes = np.column_stack((rng.uniform(-4, 4, (5, 2)), rng.uniform(0.2, 1.0, (5, 2)), rng.uniform(-3, 3, 5)))
    return rng, boxes, np.column_stack((rng.uniform(-4, 4, (4, 2)), rng.uniform(0.1, 0.8, 4)))


def test_agrees_with_marching_along_the_rays():
    rng, rows, circles = scene_of(3)
    scene = (rectangles(rows), circles)
    origin = next(p for p in rng.uniform(-4, 4, (50, 2)) if not inside_any(p, *scene))
    angles = rng.uniform(-np.pi, np.pi, 60)
    exact = cast(origin, angles, *scene)
    marched = np.array([march(origin, a, scene, 0.005, 12.0) for a in angles])
    assert (np.isinf(exact) == np.isinf(marched)).mean() > 0.97
    both = np.isfinite(exact) & np.isfinite(marched)
    assert both.sum() > 20
    assert np.quantile(np.abs(exact[both] - marched[both]), 0.95) <= 0.005


@given(st.integers(0, 50), st.floats(-3, 3), st.floats(-5, 5), st.floats(-5, 5))
def test_moving_and_turning_the_whole_scene_changes_nothing(seed, turn, x, y):
    rng, rows, circles = scene_of(seed)
    origin, angles = rng.uniform(-4, 4, 2), rng.uniform(-np.pi, np.pi, 16)
    rotation = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
    shift = np.array((x, y))
    moved_rows = np.column_stack((rows[:, :2] @ rotation.T + shift, rows[:, 2:4], rows[:, 4] + turn))
    moved_circles = np.column_stack((circles[:, :2] @ rotation.T + shift, circles[:, 2]))
    before = cast(origin, angles, rectangles(rows), circles)
    after = cast(rotation @ origin + shift, angles + turn, rectangles(moved_rows), moved_circles)
    grazing = np.isinf(before) != np.isinf(after)
    assert grazing.sum() <= 1
    assert after[~grazing] == pytest.approx(before[~grazing], abs=1e-6)
