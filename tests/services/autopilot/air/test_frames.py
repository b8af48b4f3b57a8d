"""Whatever the aircraft's messages are in, a display can carry to the world."""

import pytest

from schemas import topics
from schemas.messages import FrameTransform, FrameTransforms
from services.autopilot.air.build import hosts
from services.sim_air.build import build as build_sim
from services.sim_camera.build import build as build_camera
from tests.services.autopilot.air.test_flight import site
from uvf.runtime.time.lockstep import Lockstep


@pytest.fixture(scope="module")
def sent():
    """Every message about the aircraft in a second of flight."""
    made = site()
    lockstep = Lockstep([*build_sim(made), *build_camera(made), *hosts(made)])
    types = {t.at("milvus"): t.message for t in (*topics.TOPICS.values(), topics.EVENTS.by("autopilot"))}
    seen = []
    for key, message in types.items():
        lockstep.bus.subscribe(key, topics.POSE.qos, lambda sample, m=message: seen.append(m.FromString(sample.payload)))
    lockstep.run(1.0)
    lockstep.close()
    return seen


def parents(sent):
    single = [m for m in sent if isinstance(m, FrameTransform)]
    several = [f for m in sent if isinstance(m, FrameTransforms) for f in m.transforms]
    return {f.child_frame_id: f.parent_frame_id for f in (*single, *several)}


def test_every_frame_of_the_aircraft_reaches_the_world(sent):
    tree = parents(sent)
    named = {m.frame_id for m in sent if hasattr(m, "frame_id")}
    assert {"milvus/imu", "milvus/camera_optical", "world"} <= named
    for frame in named:
        while frame in tree:
            frame = tree[frame]
        assert frame == "world"


def test_the_bodys_frame_is_where_the_pose_is(sent):
    pose = [m for m in sent if isinstance(m, topics.POSE.message)][-1]
    body = [m for m in sent if isinstance(m, FrameTransform)][-1]
    assert (body.translation, body.rotation, body.timestamp) == (pose.pose.position, pose.pose.orientation, pose.timestamp)
