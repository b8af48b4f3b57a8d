"""An aircraft's lidar and range finder see the world, ground vehicles and other aircraft."""

import msgspec
import numpy as np
import pytest

from schemas.messages import NavState
from services.sim_air.contact.surroundings import Around
from services.sim_air.engine.states import AircraftMotion
from services.sim_air.environment.ground import GroundSurface
from services.sim_air.rangers import Rangers
from tests.services.sim_air.shapes import MILVUS_TREE
from uvf.maths.bvh import build as tree_over
from uvf.maths.rotations import IDENTITY, from_euler
from uvf.maths.solids import box
from uvf.models.shapes.scene import scene
from uvf.models.shapes.solid import Solid
from uvf.models.vehicle.sensors import Lidar, Mount, RangeFinder, Sensors
from uvf.runtime.messages.convert import quaternion, vector

WALL = Solid("wall", "box", (1.0, 400.0, 50.0), np.array((100.5, 0.0, 25.0)))
FORWARD = Lidar(Mount(), hz=10.0, beams=9, angle_min=-0.4, angle_increment=0.1, range_min=0.5, range_max=150.0)
DOWN = RangeFinder(mount=Mount(rpy=(0.0, np.pi / 2, 0.0)), hz=20.0, range_min=0.2, range_max=120.0, frame="altimeter", latency=0.02)
AWAY = np.array((-500.0, 0.0, 40.0))


def motion(position, roll=0.0):
    return AircraftMotion(np.array(position), np.zeros(3), from_euler(roll, 0.0, 0.0), np.zeros(3), np.zeros(3), 25.0)


def read(at=(0.0, 0.0, 40.0), other=AWAY, van=(-500.0, 0.0, 0.0), t=0.1, roll=0.0):
    shapes = {"a": MILVUS_TREE, "b": MILVUS_TREE, "van": tree_over(box((4.0, 2.0, 2.0), (0.0, 0.0, 1.0)))}
    around = Around([WALL], GroundSurface(scene([WALL])), shapes, {}.__getitem__)
    sensors = Sensors(lidar=FORWARD, rangefinders=[msgspec.structs.replace(DOWN, latency=0.0)])
    rangers = Rangers("a", sensors, around.still, lambda name: np.random.default_rng(1))
    truth = {"van": NavState(position=vector(np.array(van)), orientation=quaternion(IDENTITY))}
    around.look(t, truth, None, {"a": motion(at, roll), "b": motion(other)})
    return rangers.read(t, motion(at, roll), lambda: around.others("a"))


def test_the_forward_lidar_sees_the_wall_ahead():
    scan = read()["scan"]
    assert scan.ranges[4] == pytest.approx(100.0)
    assert scan.ranges[8] == pytest.approx(100.0 / np.cos(0.4))
    assert scan.frame_id == "a/lidar"


def test_the_forward_lidar_sees_another_aircraft_before_the_wall():
    assert read(other=np.array((50.0, 0.0, 40.0)))["scan"].ranges[4] == pytest.approx(50.0, abs=1.5)


def test_the_range_finder_sees_the_ground_and_a_van_that_is_under_it():
    (height,) = read()["range"]
    assert (height.range, height.frame_id) == (pytest.approx(40.0), "a/altimeter")
    (above,) = read(van=(0.0, 0.0, 0.0))["range"]
    assert above.range == pytest.approx(38.0)
    (slant,) = read(roll=0.3)["range"]
    assert slant.range == pytest.approx(40.0 / np.cos(0.3))


def test_each_reads_at_its_own_rate():
    assert set(read(t=0.05)) == {"range"}
    assert set(read(t=0.02)) == set()


def test_its_own_shape_is_not_seen():
    assert read()["range"][0].range > 39.0
