"""The lidar: against the physics engine's own rays, and its limits, noise and mounting."""

import msgspec
import numpy as np
import pybullet
import pytest

from services.sim_ground.world import BulletWorld
from tests.services.sim_ground.ground_scene import WALL_AHEAD, body_at, post, scene_of
from uvf.models.scenario import ROOT
from uvf.models.shapes.scene import scene
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensors import Mount
from uvf.models.world.file import load_world
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import solids
from uvf.sensors.range_sensors import LidarModel

LDS = load_vehicle(ROOT / "vehicles", "burger").sensors.lidar
QUIET = msgspec.structs.replace(LDS, noise=0.0, mount=Mount((0.0, 0.0, 0.182)))


def scan(lidar=QUIET, body=None, others=(), world=WALL_AHEAD):
    return LidarModel(lidar, world, np.random.default_rng(0)).scan(body or body_at(), others)


def test_agrees_with_the_engines_rays_in_the_house():
    house = load_world(ROOT / "worlds", "house")
    things = solids(house)
    engine, far = BulletWorld(things, {}), msgspec.structs.replace(QUIET, range_min=0.0, range_max=15.0)
    footing, model, rng = Footing(house), LidarModel(far, scene(things), np.random.default_rng(0)), np.random.default_rng(5)
    places = [p for p in rng.uniform((0.2, 0.2), (11.8, 8.8), (60, 2)) if footing.at(*p).room > 0.12][:40]
    angles = np.radians(np.arange(360))
    errors = []
    for place in places:
        start = np.column_stack((np.tile(place, (len(angles), 1)), np.full(len(angles), 0.182)))
        end = start + 15.0 * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(len(angles))))
        hits = pybullet.rayTestBatch(start.tolist(), end.tolist(), physicsClientId=engine.engine.client)
        theirs = np.array([15.0 * hit[2] for hit in hits])
        errors.extend(np.abs(model.scan(body_at(*place), []) - theirs))
    engine.close()
    assert len(errors) > 10_000
    assert np.mean(np.array(errors) < 0.005) > 0.995


def test_straight_ahead_is_the_first_beam_and_left_the_ninetieth():
    box_on_the_left = scene_of(((0.0, 2.0, 0.5), (1.0, 1.0, 1.0)))
    ranges = scan(world=box_on_the_left)
    assert ranges[90] == pytest.approx(1.5)
    assert ranges[0] == 0.0


def test_turning_the_robot_turns_the_scan_the_other_way():
    assert scan(body=body_at(yaw=np.radians(30)))[330] == pytest.approx(scan()[0])


def test_ranges_start_at_the_sensor_not_at_the_axle():
    behind = msgspec.structs.replace(QUIET, mount=Mount((-0.3, 0.0, 0.182)))
    assert scan(behind)[0] == pytest.approx(2.3)


def test_too_near_and_too_far_are_no_return():
    assert scan(body=body_at(1.9))[0] == 0.0
    assert scan(body=body_at(-2.0))[0] == 0.0


def test_another_vehicle_hides_the_wall():
    assert scan(others=[post(1.0, 0.0, 0.1)])[0] == pytest.approx(0.9)


def test_noise_has_the_sensors_sigma():
    noisy = LidarModel(msgspec.structs.replace(QUIET, noise=0.01), WALL_AHEAD, np.random.default_rng(1))
    ahead = [noisy.scan(body_at(), [])[0] for _ in range(400)]
    assert np.mean(ahead) == pytest.approx(2.0, abs=0.002)
    assert np.std(ahead) == pytest.approx(0.01, rel=0.15)


def test_upside_down_the_scan_runs_the_other_way():
    turned = msgspec.structs.replace(QUIET, mount=Mount((0.0, 0.0, 0.182), (np.pi, 0.0, 0.0)))
    left = scene_of(((0.0, 2.0, 0.5), (1.0, 1.0, 1.0)))
    assert scan(turned, world=left)[270] == pytest.approx(1.5)


def test_nose_down_it_sees_the_floor_where_the_ray_meets_it():
    pitch = np.radians(10.0)
    ranges = scan(body=body_at(pitch=pitch), world=scene_of(((50.0, 0.0, 1.0), (1.0, 1.0, 1.0))))
    assert ranges[0] == pytest.approx(0.182 * np.cos(pitch) / np.sin(pitch))
    assert ranges[180] == 0.0


def test_what_is_lower_than_the_scanner_is_not_seen():
    assert scan(world=scene_of(((2.5, 0.0, 0.05), (1.0, 20.0, 0.1))))[0] == 0.0
