"""A range finder: one beam, along its mount, to what stands there or moves there."""

from typing import NamedTuple

import msgspec
import numpy as np
import pytest

from uvf.maths.bvh import build
from uvf.maths.raycast import MovingBody, Scene
from uvf.maths.rotations import from_euler
from uvf.maths.solids import box
from uvf.models.vehicle.sensors import Mount, RangeFinder, _check_rangers
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.sensors.range_sensors import RangeModel

ROOF = Scene(build(box((10.0, 10.0, 4.0), (0.0, 0.0, 2.0))), 0.0)  # its top at 4 m
DOWN = RangeFinder(mount=Mount(rpy=(0.0, np.pi / 2, 0.0)), hz=20.0, range_min=0.2, range_max=120.0)


class Pose(NamedTuple):
    position: np.ndarray
    world_from_body: np.ndarray


def measured(x=0.0, z=60.0, roll=0.0, pitch=0.0, sensor=DOWN, others=()):
    pose = Pose(np.array((x, 0.0, z)), from_euler(roll, pitch, 0.0))
    return RangeModel(sensor, ROOF, np.random.default_rng(1)).range(pose, others)


def test_looking_down_it_tells_the_height_above_a_roof_and_above_the_ground():
    assert measured(z=60.0) == pytest.approx(56.0)
    assert measured(x=20.0, z=60.0) == pytest.approx(60.0)


def test_in_a_bank_it_looks_aside():
    assert measured(x=40.0, z=60.0, roll=0.5) == pytest.approx(60.0 / np.cos(0.5))


def test_out_of_reach_there_is_no_return():
    assert measured(x=20.0, z=130.0) == 0.0
    assert measured(z=4.1) == 0.0


def test_another_vehicle_is_met_where_it_is():
    van = MovingBody(build(box((2.0, 2.0, 2.0), (0.0, 0.0, 0.0))), np.array((20.0, 0.0, 1.0)))
    assert measured(x=20.5, z=50.0, others=[van]) == pytest.approx(48.0)
    assert measured(x=23.0, z=50.0, others=[van]) == pytest.approx(50.0)


def test_its_noise_has_the_stated_sigma():
    noisy = RangeModel(msgspec.structs.replace(DOWN, noise=0.05), ROOF, np.random.default_rng(1))
    pose = Pose(np.array((20.0, 0.0, 60.0)), from_euler(0.0, 0.0, 0.0))
    assert np.std([noisy.range(pose, ()) for _ in range(4000)]) == pytest.approx(0.05, rel=0.05)


def test_two_of_one_frame_are_refused():
    with pytest.raises(BadInput, match="second range finder"):
        _check_rangers("range finder", [DOWN, DOWN], FileLocation("vehicle.yaml"))
