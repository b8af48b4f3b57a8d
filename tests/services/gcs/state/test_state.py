"""The model holds what was heard last, and how long ago."""

import dataclasses

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.messages import Clock, Event, FrameTransform, LaserScan, NavState, PoseInFrame, Vector3
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import LOST_AFTER, STALE_AFTER, link_of
from tests.services.gcs.fakes import Station
from tests.services.gcs.scripted import UAV, UGV, demo_site, uav_at, ugv_at
from uvf.models.vehicle.sensors import Mount
from uvf.runtime.messages.convert import planar_pose, stamp


def test_a_browser_shows_a_ground_vehicle_first():
    model = Model(demo_site())
    model.join(7)
    assert model.chosen_by(model.sessions[7]).name == UGV


def test_vehicles_are_where_they_say():
    station = Station()
    station.run(1.0)
    vehicles = station.model.vehicles
    assert vehicles[UGV].place.position == pytest.approx((*ugv_at(1.0)[:2], 0.0))
    assert vehicles[UAV].place.position == pytest.approx(uav_at(1.0)[0])


def test_truth_is_neither_a_place_nor_a_sign_of_life():
    model = Model(demo_site())
    model.hear(1.0, "truth", {UAV: NavState(position=Vector3(x=1.0))})
    assert model.vehicles[UAV].place is None
    assert model.vehicles[UAV].heard is None
    assert model.vehicles[UAV].true_place.position[0] == 1.0


def test_the_same_message_again_is_no_news():
    model, message = Model(demo_site()), NavState()
    model.hear(1.0, "nav", {UAV: message})
    model.hear(9.0, "nav", {UAV: message})
    assert model.vehicles[UAV].heard == 1.0


def test_a_dead_estimate_gives_way_to_a_living_one():
    model = Model(demo_site())
    model.hear(0.0, "nav", {UGV: NavState(position=Vector3(x=1.0))})
    model.hear(0.5, "pose", {UGV: PoseInFrame(pose=planar_pose(2.0, 0, 0))})
    assert model.vehicles[UGV].place.position[0] == 1.0
    model.hear(0.5 + STALE_AFTER, "pose", {UGV: PoseInFrame(pose=planar_pose(2.0, 0, 0))})
    assert model.vehicles[UGV].place.position[0] == 2.0


def test_a_vehicle_that_is_not_of_this_mission_is_left_out():
    model = Model(demo_site())
    model.hear(0.0, "nav", {"stranger": NavState()})
    assert "stranger" not in model.vehicles


def test_scan_points_lie_where_the_beams_hit():
    model = Model(demo_site())
    model.hear(0.0, "pose", {UGV: PoseInFrame(pose=planar_pose(3.0, 2.0, np.pi / 2))})
    ranges = [2.0, 0.0, 1.0, float("inf")]
    model.hear(0.0, "scan", {UGV: LaserScan(start_angle=0.0, end_angle=3 * np.pi / 2, ranges=ranges)})
    mount = model.vehicles[UGV].member.file.sensors.lidar.mount.xyz
    ahead, behind = (3.0, 2.0 + mount[0] + 2.0, mount[2]), (3.0, 2.0 + mount[0] - 1.0, mount[2])
    assert model.vehicles[UGV].scan_points == pytest.approx(np.array((ahead, behind)))


def test_the_scan_of_a_lidar_that_hangs_upside_down_is_no_mirror_image():
    site = demo_site()
    member = site.members[UGV]
    lidar = msgspec.structs.replace(member.file.sensors.lidar, mount=Mount(xyz=(0.0, 0.0, 0.2), rpy=(np.pi, 0.0, 0.0)))
    file = msgspec.structs.replace(member.file, sensors=msgspec.structs.replace(member.file.sensors, lidar=lidar))
    model = Model(dataclasses.replace(site, members={**site.members, UGV: dataclasses.replace(member, file=file)}))
    model.hear(0.0, "pose", {UGV: PoseInFrame(pose=planar_pose(0.0, 0.0, 0.0))})
    model.hear(0.0, "scan", {UGV: LaserScan(start_angle=0.0, end_angle=np.pi / 2, ranges=[1.0, 2.0])})
    assert model.vehicles[UGV].scan_points == pytest.approx(np.array(((1.0, 0.0, 0.2), (0.0, -2.0, 0.2))))


def test_without_a_pose_a_scan_has_no_place():
    model = Model(demo_site())
    model.hear(0.0, "scan", {UGV: LaserScan(start_angle=0.0, end_angle=1.0, ranges=[1.0, 1.0])})
    assert model.vehicles[UGV].scan_points is None


def test_a_new_epoch_begins_new_tracks():
    station = Station()
    station.run(3.0)
    assert station.model.vehicles[UAV].track.tail_length > 10
    station.script.put("sys", topics.CLOCK, Clock(t_ns=0, epoch=1), 3.0)
    station.run(0.05, silent=True)
    assert station.model.vehicles[UAV].track.tail_length == 0
    assert "afresh" in list(station.model.log)[-1].text


@pytest.mark.parametrize(
    ("age", "word", "style"),
    [(0.0, "LIVE", "good"), (3.0, "STALE 3 s", "warn"), (LOST_AFTER + 2, "LINK LOST 7 s", "bad")],
)
def test_the_link_ages(age, word, style):
    assert link_of(10.0, 10.0 + age) == (word, style)


def test_a_link_that_never_was_is_waited_for():
    assert link_of(None, 100.0) == ("WAITING", "idle")


def test_events_are_kept_in_order_with_their_cause():
    model = Model(demo_site())
    first = Event(text="blocked", cause="a chair", severity=Event.WARNING, timestamp=stamp(2.0))
    model.hear_events(9.0, {UGV: [first, Event(text="free")]})
    assert [(line.text, line.severity) for line in model.log] == [("blocked (a chair)", Event.WARNING), ("free", Event.INFO)]
    assert next(iter(model.log)).t == 2.0


def test_a_map_frame_is_kept_with_its_vehicle():
    model = Model(demo_site())
    model.hear(0.0, "world_from_map", {UGV: FrameTransform(translation=Vector3(x=2.2))})
    assert model.vehicles[UGV].world_from_map.translation.x == 2.2
