"""The tree of frames is whole: what a ground vehicle says anywhere can be drawn in the world."""

import pytest

from schemas import topics
from schemas.messages import FrameTransform, FrameTransforms
from services.autopilot.ground.build import hosts
from services.planner.build import build as build_planner
from services.sim_camera.build import build as build_camera
from services.sim_ground.build import build as build_simulator
from services.slam.build import build as build_slam
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.time.lockstep import Lockstep

VEHICLE = "burger"


@pytest.fixture(scope="module")
def said():
    """The first messages of every topic of the demo's ground vehicle, topic name -> message."""
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    run = Lockstep([host for build in (build_simulator, build_camera, build_slam, build_planner, hosts) for host in build(site)])
    found = {}

    def keep(name, topic):
        return lambda sample: found.setdefault(name, topic.message.FromString(sample.payload))

    for name, topic in topics.TOPICS.items():
        if topic.per_vehicle:
            run.bus.subscribe(topic.by("*").at(VEHICLE), topic.qos, keep(name, topic))
    run.run(2.0)
    run.close()
    return found


def parents(said):
    """Child frame -> its parents."""
    single = [m for m in said.values() if isinstance(m, FrameTransform)]
    several = [t for m in said.values() if isinstance(m, FrameTransforms) for t in m.transforms]
    found = {}
    for transform in single + several:
        found.setdefault(transform.child_frame_id, set()).add(transform.parent_frame_id)
    return found


def frames(said):
    """All frames that messages refer to, with the topic."""
    return {(name, getattr(m, field)) for name, m in said.items() for field in ("frame_id", "body_frame_id") if hasattr(m, field)}


def test_every_frame_of_every_message_leads_to_the_world(said):
    above = parents(said)
    assert {name for name, _ in frames(said)} >= {"IMU", "SCAN", "IMAGE", "CAMERA_INFO", "ODOMETRY", "POSE", "PATH", "MAP"}
    for name, frame in frames(said):
        way = [frame]
        while way[-1] != "world":
            assert way[-1] in above and len(way) < 10, f"{name}: no way from {way} to the world"
            way.append(next(iter(above[way[-1]])))


def test_no_frame_has_two_parents(said):
    assert all(len(found) == 1 for found in parents(said).values())
