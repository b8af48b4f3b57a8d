"""The sonar: the nearest thing in its cone, wherever in it."""

import msgspec
import numpy as np
import pytest

from tests.services.sim_ground.ground_scene import WALL_AHEAD, body_at, post
from uvf.models.vehicle.sensors import Mount, Sonar
from uvf.sensors.range_sensors import RangeModel

SONAR = Sonar(mount=Mount((0.1, 0.0, 0.1)), hz=10.0, fov=0.5, range_min=0.05, range_max=4.0)


def distance(sonar=SONAR, body=None, others=()):
    return RangeModel(sonar, WALL_AHEAD, np.random.default_rng(0)).range(body or body_at(), others)


def test_a_wall_ahead_is_as_far_as_it_is_from_the_mount():
    assert distance() == pytest.approx(1.9, abs=1e-3)


def test_a_post_at_the_edge_of_the_cone_answers_and_one_beside_it_does_not():
    def post_at(angle):
        return distance(others=[post(0.1 + np.cos(angle), np.sin(angle), 0.01)])

    assert post_at(0.24) == pytest.approx(0.99, abs=0.01)
    assert post_at(0.30) == pytest.approx(1.9, abs=1e-3)


def test_a_slanted_wall_answers_where_it_is_nearest():
    assert distance(body=body_at(yaw=0.2)) == pytest.approx(2.0 - 0.1 * np.cos(0.2), abs=1e-3)


def test_beyond_its_reach_there_is_no_return():
    assert distance(body=body_at(-3.0)) == 0.0
    assert distance(body=body_at(yaw=np.pi)) == 0.0


def test_noise_has_the_sensors_sigma():
    model = RangeModel(msgspec.structs.replace(SONAR, noise=0.02), WALL_AHEAD, np.random.default_rng(1))
    read = [model.range(body_at(), []) for _ in range(1000)]
    assert np.mean(read) == pytest.approx(1.9, abs=0.003)
    assert np.std(read) == pytest.approx(0.02, rel=0.1)
