"""Beam by beam against PyBullet's rays, an independent implementation, from 1000 random poses.

Where both cannot agree, and by how much, is PyBullet's way with convex solids; ``benchmarks/sensors/ray_casting/worlds.py`` states it.
"""

from functools import partial

import numpy as np
import pytest

from benchmarks.sensors.ray_casting.worlds import Twin, grazing, low_places, mixed, random_scans, world
from uvf.maths.bvh import build
from uvf.maths.raycast import Rays, Scene, cast
from uvf.maths.solids import BOX, TRIANGLE, joined

MAX_RANGE = 20.0  # m
ENGINE_ERROR = 3e-3  # m, of PyBullet's rays to convex solids


@pytest.fixture
def engine():
    """A world of the benchmark, ended after the test."""
    made = []

    def make(world):
        made.append(world())
        return made[-1]

    yield make
    for twin in made:
        twin.close()


def scans(twin, area, tilt):
    rays = random_scans(twin, np.random.default_rng(12), np.array(area), tilt)
    assert len(rays.directions) == 36_000
    return rays


def agreement(twin, rays):
    """Own distances, PyBullet's, and which beams graze no edge."""
    scene = twin.scene()
    own, bullet = cast(scene, [], rays, MAX_RANGE), twin.cast(rays, MAX_RANGE)
    return own, bullet, ~grazing(scene, rays, own, MAX_RANGE)


@pytest.mark.parametrize(
    ("make", "area", "tilt"),
    [(mixed, ((-3, -3, -3), (3, 3, 3)), np.pi), (partial(world, "house"), low_places("house"), 0.1)],
    ids=["mixed", "house"],
)
def test_what_grazes_no_edge_is_met_by_both_at_one_distance(engine, make, area, tilt):
    twin = engine(make)
    own, bullet, clear = agreement(twin, scans(twin, area, tilt))
    assert np.array_equal(np.isinf(own[clear]), np.isinf(bullet[clear]))
    met = clear & np.isfinite(own)
    difference = np.abs(own[met] - bullet[met])
    assert met.sum() > 8_000
    assert clear.mean() > 0.85
    assert np.median(difference) < 1e-12
    assert np.quantile(difference, 0.999) < ENGINE_ERROR


def test_triangles_are_met_at_the_same_distance_to_rounding(engine):
    twin = engine(mixed)
    rays = scans(twin, ((-3, -3, -3), (3, 3, 3)), np.pi)
    own, bullet, clear = agreement(twin, rays)
    triangles = [part for part in twin.parts if part.kinds[0] == TRIANGLE]
    met = clear & np.isfinite(own) & (cast(Scene(build(joined(triangles))), [], rays, MAX_RANGE) == own)
    assert met.sum() > 2_000
    assert np.quantile(np.abs(own[met] - bullet[met]), 0.999) < 1e-12
    assert np.abs(own[met] - bullet[met]).max() < 1e-4


def test_a_box_met_head_on_is_met_at_the_same_distance_to_rounding(engine):
    twin = engine(Twin)
    twin.box(np.array((1.0, 2.0, 3.0)), (4.0, 0.0, 0.0))
    assert twin.parts[0].kinds[0] == BOX
    y, z = (part.ravel() for part in np.meshgrid(np.linspace(-0.9, 0.9, 20), np.linspace(-1.4, 1.4, 20)))
    rays = Rays(np.column_stack((np.zeros(400), y, z)), np.tile((1.0, 0.0, 0.0), (400, 1)))
    own, bullet, _ = agreement(twin, rays)
    assert own == pytest.approx(np.full(400, 3.5), abs=1e-12)
    assert bullet == pytest.approx(own, abs=1e-9)
