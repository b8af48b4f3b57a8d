"""Aircraft among ground vehicles: they are seen, stood before and pushed by."""

import numpy as np
import pytest
import yaml

from schemas import topics
from schemas.messages import Contact, LaserScan, NavState
from services.sim_air.build import build as build_air
from services.sim_ground.build import build
from services.sim_ground.guest import Course
from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from tests.services.sim_ground.ride import Driver
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import IDENTITY
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.shapes.solid import Solid
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.time.lockstep import Lockstep

BODY = load_vehicle(ROOT / "vehicles", "burger").ground
PLACED = BodyPlacement(BODY, ROOT / "vehicles" / "burger" / BODY.urdf, (0.0, 0.0, 0.0))


def driven_towards_milvus(tmp_path, script, until):
    """A burger 1.9 m before the nose of a Milvus that stands, facing it; scans, contacts and truth of the burger."""
    vehicles = {
        "burger": {"model": "burger", "system_id": 2, "start": {"x": 0.0, "y": 0.0, "yaw": 0.0}},
        "bird": {"model": "milvus", "system_id": 1, "start": {"x": 2.5, "y": 0.0, "yaw": np.pi}},
    }
    path = tmp_path / "meet.yaml"
    path.write_text(yaml.safe_dump({"about": "test", "world": "empty", "vehicles": vehicles}))
    site = load_scenario(path)
    lockstep = Lockstep([*build(site), *build_air(site), ServiceInstance(Driver, lambda: Driver(script), "burger")])
    kept = {}
    for topic, kind in ((topics.SCAN, LaserScan), (topics.CONTACT, Contact), (topics.TRUTH, NavState)):
        told = kept.setdefault(topic.key, [])
        lockstep.bus.subscribe(topic.at("burger"), topic.qos, lambda s, told=told, kind=kind: told.append(kind.FromString(s.payload)))
    lockstep.run(until)
    lockstep.close()
    return (kept[topic.key] for topic in (topics.SCAN, topics.CONTACT, topics.TRUTH))


def test_the_lidar_sees_an_aircraft_that_stands_there(tmp_path):
    scans, _, _ = driven_towards_milvus(tmp_path, lambda t: Twist(0.0, 0.0), 1.0)
    ranges = np.array(scans[-1].ranges)
    assert 1.5 < ranges[ranges > 0].min() < 2.4  # the nose wheel; the world is empty


def test_driving_into_an_aircraft_ends_there_and_is_felt(tmp_path):
    _, contacts, truth = driven_towards_milvus(tmp_path, lambda t: Twist(0.2, 0.0), 14.0)
    assert {c.other for c in contacts if c.touching} == {"bird"}
    assert 1.0 < truth[-1].position.x < 2.3


def test_an_aircraft_that_flies_into_a_vehicle_pushes_it_away():
    world = BulletWorld([], {"burger": PLACED})
    world.let_in("bird", Solid("bird", "box", (1.0, 2.0, 0.3), np.zeros(3)))
    touched = []
    for n in range(100):
        t = n / 100
        where = np.array((-4.0 + 8.0 * t, 0.0, 0.25))
        world.guide({"bird": Course(t, where, np.array((8.0, 0.0, 0.0)), IDENTITY)})
        world.advance({}, 0.01, t)
        touched += [touch.other for touch in world.touches("burger")]
    moved = world.state("burger").position
    world.close()
    assert moved[0] > 0.5
    assert "bird" in touched


def test_nobody_is_hit_by_an_aircraft_that_has_not_been_told_of():
    world = BulletWorld([], {"burger": PLACED})
    world.let_in("bird", Solid("bird", "box", (1.0, 2.0, 0.3), np.zeros(3)))
    world.advance({}, 0.5)
    assert world.state("burger").position == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    assert world.touches("burger") == []
    world.close()
