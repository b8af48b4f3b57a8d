"""The localization service step by step, on messages, and how a mission asks for it."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from schemas.messages import Event, FrameTransform, LaserScan, MapFix, PlaceRequest, RelocalizeRequest, Vector3
from services.slam import localization_service
from services.slam.build import build
from services.slam.localization_service import LocalizationService, LocalizationStart
from tests.runtime.stepping import recall, stepped
from tests.services.live_params import all_settable_are_read
from tests.slam.localization.places import ROOM, ellipse, errors, map_of, readings
from uvf.maths.se2 import Pose2, compose
from uvf.maths.se2_arrays import composed, inverted
from uvf.models.mission.file import Maps
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.sensors import Lidar, Mount
from uvf.models.world.map_file import save_map
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import occupancy_cells, planar_pose, stamp, yaw_of
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.maps.grids import as_message
from uvf.slam.localization import known_map
from uvf.slam.localization.localizer import HALF_SURE
from uvf.slam.localization.params import FilterParams
from uvf.slam.maps.session import NO_EDGES, MappingSession
from uvf.slam.method import Keyframe

LIDAR_FILE = Lidar(Mount((0.0, 0.0, 0.2)), hz=5, beams=360, angle_min=0.0, angle_increment=0.01745, range_min=0.05, range_max=3.5)
WORLD_FROM_MAP = Pose2(2.0, 1.0, np.pi / 2)


@pytest.fixture(scope="module")
def room():
    return map_of(ROOM)


def frame(t, parent, child, pose):
    flat = planar_pose(*pose)
    place = Vector3(x=pose[0], y=pose[1])
    return FrameTransform(
        timestamp=stamp(t), parent_frame_id=f"v/{parent}", child_frame_id=f"v/{child}", translation=place, rotation=flat.orientation
    )


def service(known, anywhere=False):
    return LocalizationService("v", [LIDAR_FILE], WORLD_FROM_MAP, FilterParams(), LocalizationStart(known, anywhere, 3))


def drive(localization, drive, known=None, asked=None):
    """All that is said, a step for each reading; asked: requests by step."""
    frames, said = FrameBuffer(), []
    frames.add(frame(0.0, "base_footprint", "lidar", (0.0, 0.0, 0.0)), is_static=True)
    for k, reading in enumerate(drive):
        frames.add(frame(reading.t, "odom", "base_footprint", reading.odom_from_base))
        scan = LaserScan(timestamp=stamp(reading.t), frame_id="v/lidar", start_angle=0.0, end_angle=np.radians(359), ranges=reading.ranges)
        requests = {"pose": [], "relocalize": []} | (asked or {}).get(k, {})
        said.append(stepped(localization, reading.t, scan=scan, frames=frames, known=known, **requests))
    return said


def begun_at_zero(way):
    """The map frame is the start pose of the mission: the drive begins in its origin only when the way does."""
    return composed(inverted(way[0]), way)


def moved(known_room, way):
    """The room's map in the frame of the first pose of a way."""
    start = inverted(way[0])
    keyframes = [Keyframe(Pose2(*composed(start, p).tolist()), r) for p, r in zip(ellipse(40), readings(ROOM, ellipse(40), 9), strict=True)]
    return known_map.of_keyframes(keyframes), keyframes


def test_its_outputs_are_those_of_mapping(room):
    way = ellipse(60)
    known, _ = moved(room, way)
    drive_ = readings(ROOM, way, worse=1.05)
    said = drive(service(known), drive_)
    first, last = said[0], said[-1]
    assert (first["placing"].parent_frame_id, first["placing"].child_frame_id) == ("world", "v/map")
    assert first["map"].frame_id == "v/map" and np.array_equal(occupancy_cells(first["map"]), known.grid.cells)
    assert sum("map" in out for out in said) == 1
    shift = last["correction"].translation
    pose = compose(Pose2(shift.x, shift.y, yaw_of(last["correction"].rotation)), drive_[-1].odom_from_base)
    assert errors([pose], begun_at_zero(way)[-1:])[0][0] < 0.1
    assert last["fix"].quality > 0.7 and len(last["fix"].covariance) == 9
    assert not [e for out in said for e in out["events"]]


def test_the_correction_never_jumps_while_the_vehicle_is_tracked(room):
    way = ellipse(60)
    drive_ = readings(ROOM, way, worse=1.1)
    said = drive(service(moved(room, way)[0]), drive_)
    poses = [
        compose(Pose2(s.translation.x, s.translation.y, yaw_of(s.rotation)), r.odom_from_base)
        for s, r in zip([out["correction"] for out in said], drive_, strict=True)
    ]
    before = [
        compose(Pose2(s.translation.x, s.translation.y, yaw_of(s.rotation)), r.odom_from_base)
        for s, r in zip([out["correction"] for out in said[:-1]], drive_[1:], strict=True)
    ]
    assert max(np.hypot(p.x - q.x, p.y - q.y) for p, q in zip(poses[1:], before, strict=True)) <= 0.01 + 1e-9


def test_a_pose_can_be_set_and_the_vehicle_be_looked_for(room):
    way = ellipse(80, end=3.8 * np.pi)
    known, _ = moved(room, way)
    drive_, true = readings(ROOM, way), begun_at_zero(way)
    world = compose(WORLD_FROM_MAP, Pose2(*true[40].tolist()))
    asked = {
        1: {"relocalize": [RelocalizeRequest()]},
        40: {"pose": [PlaceRequest(pose=planar_pose(*world)), PlaceRequest(pose=planar_pose(100.0, 0.0, 0.0))]},
    }
    said = drive(service(known), drive_, asked=asked)
    assert said[1]["relocalize"][0].accepted
    good, outside = said[40]["pose"]
    assert good.accepted and outside.reason == "(100.00, 0.00) is outside the map"
    fix = said[41]["fix"]
    assert errors([(fix.x, fix.y, fix.yaw)], true[41:42])[0][0] < 0.05


@pytest.mark.parametrize("off", [(0.0, 0.0, 0.0), (1.2, -0.7, 2.0)])
@pytest.mark.parametrize("quality", [0.45, np.nan])
def test_one_started_again_while_the_vehicle_was_looked_for_goes_on_looking(room, off, quality):
    way = ellipse(80, end=3.8 * np.pi)
    localization = service(moved(room, way)[0], anywhere=True)
    recall(localization, correction=frame(0.0, "map", "odom", off), fix=MapFix(quality=quality))
    said = drive(localization, readings(ROOM, way))
    assert said[0]["fix"].quality <= HALF_SURE
    assert [e.text for out in said for e in out["events"]] == ["the vehicle is localized"]
    fix = said[-1]["fix"]
    assert errors([(fix.x, fix.y, fix.yaw)], begun_at_zero(way)[-1:])[0][0] < 0.05


def test_one_started_again_while_the_vehicle_was_tracked_goes_on_tracking(room):
    way = ellipse(20)
    localization = service(moved(room, way)[0], anywhere=True)
    recall(localization, correction=frame(0.0, "map", "odom", (0.0, 0.0, 0.0)), fix=MapFix(quality=0.9))
    said = drive(localization, readings(ROOM, way))
    assert said[1]["fix"].quality > HALF_SURE and not [e for out in said for e in out["events"]]


def test_the_map_may_come_on_the_bus(room):
    way = ellipse(30)
    known, _ = moved(room, way)
    placed = replace(known.grid, origin=compose(WORLD_FROM_MAP, known.grid.origin))
    localization = service(None)
    without = drive(localization, readings(ROOM, way)[:15])
    assert [(e.severity, e.cause[:18]) for out in without for e in out["events"]] == [(Event.WARNING, "there is no map on")]
    drive_ = [replace(r, t=r.t + 10.0) for r in readings(ROOM, way)]
    fix = drive(localization, drive_, as_message(placed, "world", 1.0))[-1]["fix"]
    assert errors([(fix.x, fix.y, fix.yaw)], begun_at_zero(way)[-1:])[0][0] < 0.05


def test_a_map_that_is_of_no_use_is_told_of_once():
    empty = as_message(replace(map_of(ROOM).grid, cells=np.zeros((4, 4), dtype=np.int8)), "world", 1.0)
    said = drive(service(None), readings(ROOM, ellipse(8)), empty)
    (event,) = [e for out in said for e in out["events"]]
    assert event.cause == "map/known: a map with 0 cells of walls beside free floor: there is nothing to be localized by"


def test_a_map_of_no_use_is_looked_at_once(monkeypatch):
    looks, of_grid = [], localization_service.of_grid
    monkeypatch.setattr(localization_service, "of_grid", lambda *map_: looks.append(map_) or of_grid(*map_))
    empty = as_message(replace(map_of(ROOM).grid, cells=np.zeros((4, 4), dtype=np.int8)), "world", 1.0)
    drive(service(None), readings(ROOM, ellipse(8)), empty)
    assert len(looks) == 1


@pytest.mark.parametrize("sigma", [1e200, 1e4, 1e-200, -1.0, np.inf, np.nan])
@pytest.mark.parametrize("of", ["position_sigma", "yaw_sigma"])
def test_a_pose_that_is_less_sure_than_any_map_is_wide_is_refused(room, sigma, of):
    known, _ = moved(room, ellipse(8))
    asked = {2: {"pose": [PlaceRequest(pose=planar_pose(*WORLD_FROM_MAP), **{of: sigma})]}}
    said = drive(service(known), readings(ROOM, ellipse(4)), asked=asked)
    (reply,) = said[2]["pose"]
    assert not reply.accepted and reply.reason.startswith("a pose of finite numbers is needed, with sigmas from 0.0001 to 1000")


def test_parameters_count_while_running(room):
    way = ellipse(10)
    localization = service(moved(room, way)[0])
    with all_settable_are_read(localization):
        drive(localization, readings(ROOM, way))


def site_with(tmp_path, maps):
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    burger = site.members["burger"]
    changed = replace(burger, entry=msgspec.structs.replace(burger.entry, maps=maps))
    return replace(site, mission_path=tmp_path / "mission.yaml", members={"burger": changed})


@pytest.mark.parametrize("kind", ["session", "picture"])
def test_a_mission_names_the_map_and_gets_localization_in_the_place_of_mapping(room, tmp_path, kind):
    if kind == "session":
        MappingSession(tuple(moved(room, ellipse(40))[1]), NO_EDGES, "graph", {}).save(tmp_path / "room.npz")
    else:
        save_map(room.grid, tmp_path / "room.yaml")
    name = "room.npz" if kind == "session" else "room.yaml"
    hosts = build(site_with(tmp_path, Maps(known=name, known_at=(1.0, 2.0, 0.3), localize="start")))
    assert [host.service.name for host in hosts] == ["odometry", "localization", "map_server"]
    assert hosts[1].make() is not hosts[1].make()


def test_bad_map_files_are_told_in_a_line(tmp_path):
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04 no zip")
    (tmp_path / "small.yaml").write_text("image: small.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n")
    (tmp_path / "small.pgm").write_bytes(b"P5 2 2 255 " + bytes((254, 254, 254, 254)))
    for name, words in {"none.yaml": "no such file", "broken.npz": "not a session", "small.yaml": "nothing to be localized by"}.items():
        with pytest.raises(BadInput, match=words) as refused:
            build(site_with(tmp_path, Maps(known=name, localize="anywhere")))
        assert "\n" not in str(refused.value)


def test_people_see_where_its_particles_are(room):
    way = ellipse(40)
    known, _ = moved(room, way)
    said = drive(service(known, anywhere=True), readings(ROOM, way, worse=1.05))
    spread = [np.ptp([(p.position.x, p.position.y) for p in out["particles"].poses], axis=0).max() for out in said]
    assert all(len(out["particles"].poses) == localization_service.PARTICLES_TOLD for out in said)
    assert said[0]["particles"].frame_id == "v/map" and spread[0] > 1.0 and spread[-1] < 0.3
