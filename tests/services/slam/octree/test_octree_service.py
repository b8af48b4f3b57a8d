"""The service step by step, on messages."""

import io
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from PIL import Image

from launch import catalogue
from schemas.messages import CameraCalibration, CompressedImage, FrameTransform, LaserScan, OctreeSaveRequest, Vector3
from services.slam.octree import octree_service
from services.slam.octree.build import build
from services.slam.octree.octree_service import OctreeParams, OctreeService
from tests.runtime.stepping import recall, stepped
from tests.services.live_params import all_settable_are_read
from uvf.maths.rotations import IDENTITY, from_euler
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.sensors import Camera, Lidar, Mount, Sensors
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import occupancy_cells, quaternion, stamp
from uvf.runtime.messages.frames import FrameBuffer
from uvf.slam.octree.files import read_octree
from uvf.slam.octree.octree import FREE, NOT_KNOWN, OCCUPIED

WIDTH, HEIGHT = 32, 24
CAMERA = Camera(mount=Mount(), hz=5.0, width=WIDTH, height=HEIGHT, fov=1.2, far=10.0, depth=True)
LIDAR = Lidar(Mount(), hz=5, beams=91, angle_min=-0.785, angle_increment=0.01745, range_min=0.1, range_max=8.0)
SENSORS = Sensors(camera=CAMERA, lidar=LIDAR)
INFO = CameraCalibration(width=WIDTH, height=HEIGHT, K=[24.0, 0, 15.5, 0, 24.0, 11.5, 0, 0, 1])
PARAMS = OctreeParams(map_period=1.0)
OPTICAL = from_euler(-np.pi / 2, 0.0, -np.pi / 2)


def service(params=PARAMS, keep=lambda name, content: name):
    return OctreeService(SENSORS, keep, params)


def wall_picture(t, metres=2.0):
    stream = io.BytesIO()
    Image.fromarray(np.full((HEIGHT, WIDTH), round(1000 * metres), dtype=np.uint16)).save(stream, format="PNG")
    return CompressedImage(timestamp=stamp(t), frame_id="v/camera_optical", data=stream.getvalue(), format="png")


def sweep(t, metres=3.0):
    return LaserScan(timestamp=stamp(t), frame_id="v/lidar", start_angle=-0.3, end_angle=0.3, ranges=[metres] * 41)


def frame(t, parent, child, xyz, rotation=IDENTITY):
    x, y, z = xyz
    return FrameTransform(
        timestamp=stamp(t), parent_frame_id=parent, child_frame_id=child, translation=Vector3(x=x, y=y, z=z), rotation=quaternion(rotation)
    )


def frames_at(places):
    """Where base_link was, by time; camera and lidar sit in it."""
    frames = FrameBuffer()
    frames.add(frame(0.0, "v/base_link", "v/camera_optical", (0, 0, 0), OPTICAL), is_static=True)
    frames.add(frame(0.0, "v/base_link", "v/lidar", (0, 0, 0.5)), is_static=True)
    for t, place in places.items():
        frames.add(frame(t, "world", "v/base_link", place))
    return frames


NOW = {0.0: (0.0, 0.0, 1.0), 9.0: (0.0, 0.0, 1.0)}


def heard(made, t, depth=(), scan=(), places=None, info=INFO, save=()):
    return stepped(
        made, t, depth=list(depth), info=info, scan=list(scan), frames=frames_at(NOW if places is None else places), save=list(save)
    )


def states(message, *points):
    return read_octree(message.data, "map").states(np.array(points)).tolist()


def test_a_picture_is_a_wall_where_the_camera_looks():
    told = heard(service(), 1.0, depth=[wall_picture(0.8)])["map"]
    assert (told.frame_id, told.resolution, told.depth) == ("world", 0.1, 16)
    assert states(told, (2.05, 0.05, 1.05), (1.0, 0.0, 1.0), (2.5, 0.0, 1.0)) == [OCCUPIED, FREE, NOT_KNOWN]


def test_a_sweep_is_put_in_at_the_height_and_time_of_the_lidar():
    moving = {0.0: (0.0, 0.0, 1.0), 1.0: (10.0, 0.0, 1.0)}
    told = heard(service(), 1.2, scan=[sweep(0.5, 3.02)], places=moving)["map"]
    beside = ((6.0, 0.05, 1.55), (8.05, 0.05, 1.55), (8.15, 0.05, 1.55), (7.0, 0.05, 1.05))
    assert states(told, *beside) == [FREE, OCCUPIED, NOT_KNOWN, NOT_KNOWN]


@pytest.mark.parametrize("clockwise", [False, True])
def test_the_beams_of_a_slow_lidar_are_put_in_from_where_it_was(clockwise):
    """At 1 m/s: the sweep is of 0.5 to 0.7 s; its right end, its middle and its left end."""
    slow = msgspec.structs.replace(LIDAR, sweep_time=0.2, clockwise=clockwise)
    made = OctreeService(Sensors(lidar=slow), lambda name, content: name, PARAMS)
    moving = {0.0: (0.0, 0.0, 1.0), 1.0: (1.0, 0.0, 1.0)}
    told = heard(made, 1.2, scan=[sweep(0.5, 2.98)], places=moving)["map"]
    right, left = (0.7, 0.5) if clockwise else (0.5, 0.7)
    ahead, aside = 2.98 * np.cos(0.3), 2.98 * np.sin(0.3)
    meant = ((right + ahead, -aside, 1.55), (0.6 + 2.98, 0.05, 1.55), (left + ahead, aside, 1.55))
    assert states(told, *meant) == [OCCUPIED] * 3
    assert states(told, (left + ahead, -aside, 1.55)) != [OCCUPIED]
    assert states(told, (right + ahead, aside, 1.55)) != [OCCUPIED]


def test_a_slow_sweep_waits_until_the_place_of_its_last_beam_is_known():
    made = OctreeService(Sensors(lidar=msgspec.structs.replace(LIDAR, sweep_time=0.2)), lambda name, content: name, PARAMS)
    early = {0.0: (0.0, 0.0, 1.0), 0.6: (0.0, 0.0, 1.0)}
    assert "map" not in heard(made, 1.0, scan=[sweep(0.5)], places=early)
    assert "map" in heard(made, 1.5)


def test_what_is_taken_waits_until_its_place_is_known():
    made = service()
    early = {0.0: (0.0, 0.0, 1.0), 0.5: (0.0, 0.0, 1.0)}
    assert "map" not in heard(made, 1.0, depth=[wall_picture(0.8)], places=early)
    assert "map" in heard(made, 1.5)


def test_beams_without_return_are_free_up_to_the_reach():
    told = heard(service(), 1.0, scan=[sweep(0.5, 0.0)])["map"]
    assert states(told, (7.5, 0.05, 1.55), (8.5, 0.05, 1.55)) == [FREE, NOT_KNOWN]


def test_a_picture_clears_no_farther_than_the_camera_sees():
    told = heard(service(OctreeParams(depth_reach=50.0)), 1.0, depth=[wall_picture(0.8, 0.0)])["map"]
    beside = np.array((24.0, 0.5, 0.5)) / 24.0  # along the pixel next to the middle
    on_the_way, beyond = (tuple(np.array((0.0, 0.0, 1.0)) + length * beside) for length in (9.5, 10.5))
    assert states(told, on_the_way, beyond) == [FREE, NOT_KNOWN]


def test_nothing_is_told_while_nothing_has_changed():
    made = service()
    assert "map" in heard(made, 1.0, scan=[sweep(0.5)])
    assert "map" not in heard(made, 3.0)
    assert "map" not in heard(made, 1.5, scan=[sweep(1.2)])
    assert "map" in heard(made, 2.0)


def test_pictures_without_a_place_are_told_of_once_with_the_reason():
    made = service()
    events = [e for k in range(1, 20) for e in heard(made, 0.5 * k, depth=[wall_picture(0.1)], places={})["events"]]
    assert [e.text for e in events] == ["pictures or scans cannot be mapped"]
    assert "no frame 'world'" in events[0].cause


def test_a_broken_picture_is_left_out_and_told_of_once():
    made = service()
    broken = CompressedImage(timestamp=stamp(0.5), frame_id="v/camera_optical", data=b"broken", format="png")
    outputs = heard(made, 1.0, depth=[broken, wall_picture(0.5)])
    assert [e.text for e in outputs["events"]] == ["a depth picture is left out"]
    assert "map" in outputs
    assert heard(made, 2.0, depth=[broken])["events"] == []


def test_the_slice_and_the_heights_fit_the_map():
    outputs = heard(service(OctreeParams(slice_low=1.2, slice_high=1.3)), 1.0, depth=[wall_picture(0.8)])
    grid, heights = outputs["slice"], outputs["heights"]
    cells = occupancy_cells(grid)
    row, column = (int(np.floor((v - o) / 0.1)) for v, o in ((0.05, grid.pose.position.y), (2.05, grid.pose.position.x)))
    assert cells[row, column] == 100 and cells[row, column - 5] == 0
    values = np.frombuffer(heights.data, dtype="<f4").reshape(*cells.shape, 2)
    assert [f.name for f in heights.fields] == ["top", "ground"]
    assert values[row, column, 0] == pytest.approx(2.0, abs=0.11)


def test_a_slice_of_no_height_is_told_of():
    outputs = heard(service(OctreeParams(slice_low=1.3, slice_high=1.2)), 1.0, depth=[wall_picture(0.8)])
    assert [(e.text, e.cause) for e in outputs["events"]] == [("the slice of the map is empty", "'slice_low' lies above 'slice_high'")]
    assert (occupancy_cells(outputs["slice"]) == -1).all()


def test_a_map_too_large_for_a_message_is_told_with_larger_cells(monkeypatch):
    monkeypatch.setattr(octree_service, "MESSAGE_MOST", 600)
    told = heard(service(), 1.0, depth=[wall_picture(0.8)])["map"]
    assert told.depth < 16 and len(told.data) <= 600
    assert states(told, (2.05, 0.05, 1.05)) == [OCCUPIED]


def test_it_goes_on_with_the_map_told_last():
    told = heard(service(), 1.0, depth=[wall_picture(0.8)])["map"]
    again = service()
    recall(again, map=told)
    assert heard(again, 4.0)["map"].data == told.data
    later = heard(again, 5.0, scan=[sweep(4.5, 5.02)])["map"]
    assert states(later, (2.05, 0.05, 1.05), (5.05, 0.05, 1.55)) == [OCCUPIED, OCCUPIED]


def test_a_broken_or_other_map_is_not_gone_on_with():
    told = heard(service(), 1.0, depth=[wall_picture(0.8)])["map"]
    for params, data in ((PARAMS, told.data[:50]), (OctreeParams(resolution=0.2), told.data)):
        told.data = data
        again = service(params)
        recall(again, map=told)
        later = heard(again, 5.0, scan=[sweep(4.5, 1.0)])["map"]
        assert states(later, (2.1, 0.1, 0.7)) == [NOT_KNOWN]


def test_the_map_is_written_on_request():
    kept = {}
    made = service(keep=lambda name, content: kept.update({name: content}) or f"/maps/{name}.bt")
    heard(made, 1.0, depth=[wall_picture(0.8)])
    outputs = heard(made, 1.5, save=[OctreeSaveRequest(name="house-1")])
    assert outputs["save"][0].accepted and [e.text for e in outputs["events"]] == ["map written to /maps/house-1.bt"]
    assert read_octree(kept["house-1"], "kept").states(np.array(((2.05, 0.05, 1.05),))) == OCCUPIED


def test_a_full_map_is_told_of_and_stays(monkeypatch):
    made = service()
    heard(made, 1.0, depth=[wall_picture(0.8)])
    monkeypatch.setattr(octree_service, "MEMORY_MOST", 1000)
    outputs = heard(made, 2.0, scan=[sweep(1.5)])
    assert [e.text for e in outputs["events"]] == ["the map is full: nothing is put in any more"]
    assert "map" not in heard(made, 4.0, scan=[sweep(3.5)])
    monkeypatch.setattr(octree_service, "MEMORY_MOST", 10**9)
    assert states(heard(made, 6.0, scan=[sweep(5.5)])["map"], (2.05, 0.05, 1.05)) == [OCCUPIED]


@pytest.mark.parametrize("name", ["", "../../etc/passwd", "a/b", "x" * 65, "map.bt"])
def test_a_name_that_is_no_files_is_refused(name):
    (reply,) = heard(service(), 1.0, save=[OctreeSaveRequest(name=name)])["save"]
    assert not reply.accepted and "no name for a file" in reply.reason


def test_a_disk_that_refuses_is_answered():
    def full(name, content):
        raise BadInput(f"{name}: cannot be written: No space left on device")

    (reply,) = heard(service(keep=full), 1.0, save=[OctreeSaveRequest(name="house")])["save"]
    assert not reply.accepted and "No space left" in reply.reason


def test_parameters_count_while_running():
    made = service()
    with all_settable_are_read(made):
        heard(made, 1.0, depth=[wall_picture(0.8)], scan=[sweep(0.8)])
    made.params = OctreeParams(map_period=1.0, depth_reach=1.5)
    told = heard(made, 3.0, depth=[wall_picture(2.5, 1.8)])["map"]
    assert states(told, (1.8, 0.05, 1.05)) == [FREE]


def with_sensors(**changes):
    site = load_scenario(ROOT / "missions" / "mapping.yaml")
    member = site.members["burger"]
    sensors = msgspec.structs.replace(member.file.sensors, **changes)
    return replace(site, members={"burger": replace(member, file=msgspec.structs.replace(member.file, sensors=sensors))})


def test_only_who_asks_for_a_map_gets_one():
    demo, mapping = (load_scenario(ROOT / "missions" / f"{name}.yaml") for name in ("demo", "mapping"))
    assert build(demo) == [] and "octree" not in {kind.name for kind in catalogue.needed(demo)}
    assert {host.vehicle for host in build(mapping)} == {"burger", "milvus"} and "octree" in {
        kind.name for kind in catalogue.needed(mapping)
    }


def test_a_vehicle_that_sees_nothing_cannot_map():
    with pytest.raises(BadInput, match=r"burger_depth/vehicle\.yaml: params: octree: no sensor to map with"):
        build(with_sensors(camera=None, lidar=None))


def test_files_go_to_the_state_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path))
    (host,) = build(with_sensors())
    made = host.make()
    assert heard(made, 1.0, save=[OctreeSaveRequest(name="empty")])["save"][0].accepted
    assert read_octree((tmp_path / "maps" / "burger-empty.bt").read_bytes(), "file").is_empty
