"""A mission whose vehicle goes on with the session of an earlier mapping."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from schemas.messages import FrameTransform, LaserScan, Vector3
from services.slam.build import build
from tests.runtime.stepping import stepped
from tests.slam.localization.places import ROOM, ellipse, readings
from uvf.maths.se2 import Pose2, compose
from uvf.models.mission.file import Maps
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import occupancy_cells, planar_pose, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.slam.graph.method import GraphSlam
from uvf.slam.maps.session import MappingSession

EARLIER, NOW = ellipse(40), ellipse(6, begin=2.0, end=2.5)
"""Ways in the world, which is the room's frame."""


@pytest.fixture(scope="module")
def session():
    slam = GraphSlam()
    for reading in readings(ROOM, EARLIER):
        slam.add(reading)
    return slam.session()


def site_with(tmp_path, maps):
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    burger = site.members["burger"]
    start = msgspec.structs.replace(burger.entry.start, x=float(NOW[0, 0]), y=float(NOW[0, 1]), yaw=float(NOW[0, 2]))
    changed = replace(burger, entry=msgspec.structs.replace(burger.entry, start=start, maps=maps))
    return replace(site, mission_path=tmp_path / "mission.yaml", members={"burger": changed})


def frame(t, parent, child, pose):
    turn = planar_pose(*pose).orientation
    names = {"parent_frame_id": f"burger/{parent}", "child_frame_id": f"burger/{child}"}
    return FrameTransform(timestamp=stamp(t), translation=Vector3(x=pose[0], y=pose[1]), rotation=turn, **names)


def drive(mapping, way):
    frames, said = FrameBuffer(), []
    frames.add(frame(0.0, "base_footprint", "lidar", (0.0, 0.0, 0.0)), is_static=True)
    for reading in readings(ROOM, way, seed=5):
        frames.add(frame(reading.t, "odom", "base_footprint", reading.odom_from_base))
        scan = LaserScan(timestamp=stamp(reading.t), frame_id="burger/lidar", end_angle=np.radians(359), ranges=reading.ranges)
        said.append(stepped(mapping, reading.t, scan=scan, frames=frames))
    return said


def test_the_earlier_map_is_there_at_once_and_grows_on(session, tmp_path):
    session.save(tmp_path / "room.npz")
    at = tuple(EARLIER[0].tolist())
    mapping = build(site_with(tmp_path, Maps(continues="room.npz", known_at=at)))[1].make()
    said = drive(mapping, NOW)
    world_from_map = Pose2(*NOW[0].tolist())
    for outputs, true in zip(said, NOW, strict=True):
        fix = outputs["fix"]
        place = compose(world_from_map, Pose2(fix.x, fix.y, fix.yaw))
        assert np.hypot(place.x - true[0], place.y - true[1]) < 0.05
    cells = occupancy_cells(said[0]["map"])
    assert np.count_nonzero((cells >= 0) & (cells < 25)) * 0.05**2 > 15.0
    assert len(MappingSession.decoded(said[0]["session"].data, "").keyframes) >= len(session.keyframes)


def test_what_cannot_be_gone_on_with_is_one_line(session, tmp_path):
    session.save(tmp_path / "room.npz")
    replace(session, keyframes=(), edges=type(session.edges)(*(a[:0] for a in vars(session.edges).values()))).save(tmp_path / "empty.npz")
    last = session.keyframes[-1]
    away = replace(last, map_from_base=Pose2(5e5, 4e5, 0.0))
    replace(session, keyframes=(*session.keyframes[:-1], away)).save(tmp_path / "wide.npz")
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04 no zip")
    for maps, words in (
        (Maps(continues="none.npz"), "no such file"),
        (Maps(continues="broken.npz"), "not a session"),
        (Maps(continues="empty.npz"), "nothing to go on with"),
        (Maps(continues="wide.npz"), "look for a jump in the odometry"),
        (Maps(continues="room.npz", known="house", localize="start"), "leave one of them out"),
    ):
        with pytest.raises(BadInput, match=words) as refused:
            build(site_with(tmp_path, maps))
        assert "\n" not in str(refused.value)
