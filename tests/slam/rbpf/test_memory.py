"""The particles' maps take no more memory than they may, however far a vehicle goes and however wide its lidar sees."""

import tracemalloc

import numpy as np
import pytest

from benchmarks.slam.evaluation.driven import Wear, drive, route
from benchmarks.slam.evaluation.open_country import scattered
from uvf.slam.methods import make_method, method_params
from uvf.slam.reading import Beams

WIDE = Beams((0.2, 0.0), np.radians(np.arange(-180.0, 180.0, 1.0)), 0.3, 80.0)
MEGABYTE = 1e6


@pytest.fixture(scope="module")
def driven():
    """100 m among trees, cars and sheds."""
    road = np.array(((0.0, 0.0), (70.0, 0.0), (70.0, 30.0)))
    return drive(route(road)[::6], scattered(road, 120.0, np.random.default_rng(1)), WIDE, Wear(), 1)


def mapped(driven, readings=None, **params):
    method = make_method("rbpf", method_params("rbpf", {"linearUpdate": 2.0} | params, "test"))
    for reading in driven.log.readings[:readings]:
        method.add(reading)
    return method


def off_by(method, driven):
    """m at most."""
    poses = method.trajectory()
    return float(np.hypot(*(poses - driven.map_from_base[: len(poses)])[:, :2].T).max())


def test_a_lidar_that_sees_80_m_takes_no_more_than_a_gigabyte(driven):
    tracemalloc.start()
    method = mapped(driven, readings=30)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1150 * MEGABYTE
    assert off_by(method, driven) < 1.0


def test_maps_keep_within_the_memory_that_they_are_given_and_the_vehicle_is_tracked_all_the_same(driven):
    method = mapped(driven, particles=4, mapMemory=10.0)
    assert method.tiles.tiles <= method.tiles.capacity and method.surfaces.tiles <= method.surfaces.capacity
    held = sum(pool.tiles * pool.kind.size for pool in (method.tiles, method.surfaces))
    assert held < 10 * MEGABYTE
    assert off_by(method, driven) < 1.0


def test_a_reach_that_would_not_fit_is_noted_once_with_the_parameter_that_mends_it(driven):
    note, *others = mapped(driven, particles=4, mapMemory=10.0).notes
    assert "10 MB of mapMemory" in note and "28 m" in note
    assert note not in others
    assert mapped(driven, readings=3, particles=2).notes == []
