"""What is drawn follows what is known, and stays the same object while nothing changes."""

import dataclasses
import io

import msgspec
import numpy as np
import pytest
from PIL import Image

from schemas.messages import Clock, FrameTransform, FrameTransforms, LaserScan, Quaternion, Vector3
from services.gcs.actions.page import Layer
from services.gcs.state.state import Model
from services.gcs.view.drawing import FloorPicture, MeshNode, Points, Polyline, TextNode
from services.gcs.view.scene.map_layers import floor_picture
from services.gcs.view.scene.scene_view import SceneView
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import LEGS, UAV, UGV, demo_site, uav_at, ugv_at
from uvf.models.world.file import Box, Windsock
from uvf.models.world.windsock import hangs
from uvf.runtime.messages.convert import occupancy_grid, planar_pose


@pytest.fixture
def station():
    station = Station()
    station.run(2.0)
    return station


def test_an_unheard_vehicle_is_not_drawn():
    station = Station()
    station.run(0.1, silent=True)
    assert not [n for n in station.page.now.nodes if n.startswith("/vehicles")]
    assert station.page.now.places == {}
    assert any(n.startswith("/world/walls") for n in station.page.now.nodes)


def test_both_vehicles_stand_where_they_are(station):
    places = station.page.now.places
    assert places[f"/vehicles/{UGV}"].position[:2] == pytest.approx(ugv_at(2.0)[:2])
    assert places[f"/vehicles/{UAV}"].position == pytest.approx(uav_at(2.0)[0])
    assert isinstance(station.page.now.nodes[f"/vehicles/{UGV}/0"], MeshNode)


def told(name, wind, scale=1.0):
    w, x, y, z = scale * hangs(np.array(wind))
    return FrameTransform(child_frame_id=name, rotation=Quaternion(w=w, x=x, y=y, z=z))


def test_a_windsock_hangs_as_the_simulation_says():
    site = demo_site()
    socks = [Windsock(name, (3.0, 4.0, 0.0), 5.0) for name in "abc"]
    model = Model(dataclasses.replace(site, world=msgspec.structs.replace(site.world, windsocks=socks)))
    view = SceneView(model)
    assert view.places()["/world/windsocks/a"].position.tolist() == [3.0, 4.0, 5.0]
    assert view.places()["/world/windsocks/a"].wxyz == pytest.approx(hangs(np.zeros(3)))
    model.hear_windsocks(
        FrameTransforms(transforms=[told("a", (0.0, 9.0, 0.0)), told("b", (9.0, 0.0, 0.0), 7.0), told("stranger", (9.0, 0.0, 0.0))])
    )
    places = view.places()
    assert places["/world/windsocks/a"].wxyz == pytest.approx(hangs(np.array((0.0, 9.0, 0.0))))
    assert places["/world/windsocks/b"].wxyz == pytest.approx(hangs(np.zeros(3)))  # no attitude
    assert "/world/windsocks/stranger" not in places
    assert isinstance(view.nodes(0.0)["/world/windsocks/a/0"], MeshNode)


def test_what_moves_by_script_stands_where_it_is_at_simulation_time():
    site = demo_site()
    door = Box("door", centre=(1.0, 2.0, 1.0), size=(0.9, 0.05, 2.0), path=[(0.0, 1.0, 2.0, 0.0), (10.0, 2.0, 2.0, 0.0)])
    model = Model(dataclasses.replace(site, world=msgspec.structs.replace(site.world, boxes=[*site.world.boxes, door])))
    view = SceneView(model)
    model.hear_clock(0.0, Clock(t_ns=2_500_000_000))
    assert view.places()["/world/moving/door"].position == pytest.approx((1.25, 2.0, 1.0))
    assert view.nodes(0.0)["/world/moving/door/shape"] is view.nodes(1.0)["/world/moving/door/shape"]


def test_tracks_grow_along_the_way(station):
    before = station.page.now.nodes[f"/track/{UAV}/tail"]
    station.run(2.0)
    after = station.page.now.nodes[f"/track/{UAV}/tail"]
    assert len(after.points) > len(before.points)
    assert np.array_equal(after.points[: len(before.points)], before.points)
    assert after.points[-1] == pytest.approx(uav_at(station.t)[0], abs=2.0)


def test_nothing_new_means_the_same_objects(station):
    station.run(1.1, silent=True)
    before = station.page.now.nodes
    station.run(1.1, silent=True)
    after = station.page.now.nodes
    assert after.keys() == before.keys()
    assert all(after[name] is before[name] for name in before)


def test_the_map_is_drawn_at_most_once_a_second(station):
    station.page.pictures.clear()
    station.run(3.0)
    maps = {id(p.nodes[f"/map/{UGV}"]) for p in station.page.pictures}
    assert 3 <= len(maps) <= 4


def test_the_path_the_scan_and_the_goal_are_drawn(station):
    nodes = station.page.now.nodes
    assert isinstance(nodes[f"/path/{UGV}"], Polyline)
    assert isinstance(nodes[f"/scan/{UGV}"], Points)
    assert nodes[f"/goal/{UGV}"].points[:, :2].mean(axis=0) == pytest.approx(station.script.goal, abs=0.05)


def test_what_a_second_lidar_sees_is_drawn_with_the_scan(station):
    vehicle = station.model.vehicles[UGV]
    before, sensors = station.page.now.nodes[f"/scan/{UGV}"].points, vehicle.member.file.sensors
    rear = msgspec.structs.replace(sensors.lidar, frame="rear")
    file = msgspec.structs.replace(vehicle.member.file, sensors=msgspec.structs.replace(sensors, other_lidars=[rear]))
    vehicle.member = dataclasses.replace(vehicle.member, file=file)
    scans = [LaserScan(frame_id=f"{UGV}/{frame}", start_angle=0.0, end_angle=1.0, ranges=[1.0, 2.0]) for frame in ("rear", "stranger")]
    station.model.hear_other_scans({UGV: scans, "stranger": scans})
    station.run(0.3, silent=True)
    assert len(station.page.now.nodes[f"/scan/{UGV}"].points) == len(before) + 2


def test_an_accepted_click_moves_the_goal(station):
    station.go(4.0, 3.0)
    station.run(0.3)
    assert station.page.now.nodes[f"/goal/{UGV}"].points[:, :2].mean(axis=0) == pytest.approx((4.0, 3.0), abs=0.05)


def test_a_mission_is_a_closed_line_with_numbers(station):
    nodes = station.page.now.nodes
    line = nodes[f"/mission/{UAV}"]
    assert line.points[:, :2] == pytest.approx(np.array((*LEGS, LEGS[0])))
    assert [nodes[f"/mission/{UAV}/{i}"].text for i in range(4)] == ["1", "2", "3", "4"]
    assert f"/mission/{UAV}/4" not in nodes


def test_an_aircraft_is_labelled_with_its_height(station):
    label = station.page.now.nodes[f"/label/{UAV}"]
    assert isinstance(label, TextNode)
    assert label.text == f"{UAV}  {uav_at(2.0)[0][2]:.0f} m"
    frame = station.page.now.places[f"/height/{UAV}"]
    top, foot = frame.position + station.page.now.nodes[f"/height/{UAV}/line"].points[::-1]
    assert frame.wxyz == pytest.approx((1, 0, 0, 0))
    assert top == pytest.approx(uav_at(2.0)[0], abs=0.01)
    assert foot[:2] == pytest.approx(top[:2])
    assert -1.0 < foot[2] <= 0.0
    shadow = frame.position + station.page.now.nodes[f"/height/{UAV}/shadow"].vertices
    assert np.abs(shadow[:, 2]).max() < 1.0 and shadow.mean(axis=0)[:2] == pytest.approx(top[:2])


def test_no_node_that_has_a_place_of_its_own_is_the_parent_of_another(station):
    nodes = station.page.now.nodes
    placed = [name for name, node in nodes.items() if isinstance(node, TextNode | FloorPicture)]
    assert [child for child in nodes for parent in placed if child.startswith(parent + "/")] == []


@pytest.mark.parametrize(("layer", "prefix"), [("Walls", "/world/walls"), ("Scan", "/scan"), ("Map", "/map"), ("Tracks", "/track")])
def test_a_layer_can_be_hidden_and_shown(station, layer, prefix):
    def shown():
        return [n for n in station.page.now.nodes if n.startswith(prefix)]

    before = shown()
    station.press(Layer(ME, layer, False))
    assert before and not shown()
    station.press(Layer(ME, layer, True))
    assert shown() == before


def test_the_true_pose_is_a_ghost_that_must_be_asked_for(station):
    assert f"/true/{UAV}" not in station.page.now.places
    station.press(Layer(ME, "True pose", True))
    assert station.page.now.places[f"/true/{UAV}"].position == pytest.approx(uav_at(station.t)[0])
    assert f"/true/{UGV}" not in station.page.now.places


CELLS = np.array([[0, 100, -1], [-1, -1, -1]], dtype=np.int8)


def test_a_map_lies_on_the_cells_it_describes():
    picture = floor_picture(occupancy_grid(CELLS, 0.5, 2.0, -1.0, "world", 0.0), None)
    assert (picture.width, picture.height, picture.yaw) == (1.5, 1.0, 0.0)
    assert picture.centre[:2] == pytest.approx((2.75, -0.5))


def test_unknown_margins_are_left_out_of_the_picture_and_nothing_moves():
    cells = np.full((200, 300), -1, dtype=np.int8)
    cells[70:75, 130:140] = 0
    picture = floor_picture(occupancy_grid(cells, 0.5, -10.0, 20.0, "world", 0.0), None)
    pixels = np.array(Image.open(io.BytesIO(picture.png)).convert("RGBA"))
    rows, columns = np.nonzero(pixels[:, :, 3])
    assert pixels.shape[0] < 100 and pixels.shape[1] < 100 and len(rows) == 50
    corner = (picture.centre[0] - picture.width / 2 + columns.min() * 0.5, picture.centre[1] - picture.height / 2 + rows.min() * 0.5)
    assert corner == pytest.approx((-10.0 + 130 * 0.5, 20.0 + 70 * 0.5))


def test_a_map_in_a_frame_of_its_own_is_turned_into_the_world():
    grid = occupancy_grid(CELLS, 0.5, 0.0, 0.0, "burger/map", 0.0)
    turn = planar_pose(0, 0, np.pi / 2).orientation
    frame = FrameTransform(translation=Vector3(x=10.0), rotation=Quaternion(w=turn.w, z=turn.z))
    picture = floor_picture(grid, frame)
    assert picture.yaw == pytest.approx(np.pi / 2)
    assert picture.centre[:2] == pytest.approx((10.0 - 0.5, 0.75))


def test_a_map_picture_is_clear_where_unknown_and_dark_where_occupied():
    picture = floor_picture(occupancy_grid(CELLS, 0.5, 0.0, 0.0, "world", 0.0), None)
    assert isinstance(picture, FloorPicture)
    pixels = np.array(Image.open(io.BytesIO(picture.png)).convert("RGBA"))
    assert pixels.shape == (2, 3, 4)
    free, occupied, unknown = pixels[0]
    assert free[:3].mean() > 200 > 60 > occupied[:3].mean()
    assert free[3] > 200 and occupied[3] > 200 and unknown[3] == 0
    assert (pixels[1, :, 3] == 0).all()
