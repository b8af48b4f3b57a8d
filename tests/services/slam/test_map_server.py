"""The map server of a vehicle: what the mission gives is published once and handed out; the drawn map is saved where it lies."""

from pathlib import Path

import numpy as np
import pytest

from schemas.messages import FrameTransform, MapRequest, SaveMapRequest, Vector3
from services.slam.map_server import MapServer
from services.slam.map_serving import map_servers
from tests.runtime.stepping import stepped
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.world.map_file import GridMap, save_map
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import occupancy_cells, quaternion, yaw_of
from uvf.runtime.messages.maps.grids import as_map, as_message
from uvf.runtime.state.saved_maps import find_map

CELLS = np.array([[0, 100, -1], [0, 0, 50]], dtype=np.int8)
DRAWN = as_message(GridMap(CELLS, 0.05, Pose2(1.0, 0.0, 0.0)), "v/map", 3.0)
PLACING = FrameTransform(translation=Vector3(x=2.0, y=1.0), rotation=quaternion(from_euler(0.0, 0.0, np.pi / 2)))


def server(layers=None, saved=None):
    def save(grid, name, mode):
        if saved is None:
            raise BadInput("no room")
        saved[name] = (grid, mode)
        return Path(name)

    return MapServer(layers or {}, save)


def asked(service, t=1.0, map=DRAWN, placing=PLACING, save=(), get=()):
    return stepped(service, t, map=map, placing=placing, save=list(save), get=list(get))


def test_layers_are_published_once_where_they_lie():
    keepout = GridMap(np.where(CELLS == 100, 100, 0).astype(np.int8), 0.1, Pose2(3.0, 4.0, 0.5))
    service = server({"keepout": keepout})
    outputs = asked(service, map=None, placing=None)
    assert set(outputs) == {"keepout"}
    message = outputs["keepout"]
    assert (message.frame_id, message.cell_size.x, message.pose.position.x) == ("world", 0.1, 3.0)
    assert yaw_of(message.pose.orientation) == pytest.approx(0.5)
    assert np.array_equal(occupancy_cells(message), keepout.cells)
    assert asked(service, 1.5) == {}
    (reply,) = asked(service, 2.0, get=[MapRequest(layer="keepout")])["get"]
    assert reply.accepted and reply.grid == message


def test_the_drawn_map_is_handed_out_and_saved_in_the_world_frame():
    saved = {}
    outputs = asked(server(saved=saved), save=[SaveMapRequest(name="house", mode="raw")], get=[MapRequest()])
    assert outputs["get"][0].grid == DRAWN and outputs["save"][0].accepted
    grid, mode = saved["house"]
    assert mode == "raw" and np.array_equal(grid.cells, CELLS)
    assert grid.origin == pytest.approx((2.0, 2.0, np.pi / 2))


@pytest.mark.parametrize(
    ("request_", "part"),
    [
        (MapRequest(layer="keepot"), "did you mean 'keepout'"),
        (MapRequest(layer="speed"), "the mission gives no speed under 'maps:'"),
        (MapRequest(), "there is no map yet"),
        (SaveMapRequest(name="../etc"), "cannot be called '../etc'; use letters"),
        (SaveMapRequest(name=""), "cannot be called ''"),
        (SaveMapRequest(name="a"), "there is no map yet"),
    ],
)
def test_what_cannot_be_done_is_answered(request_, part):
    kind = "get" if isinstance(request_, MapRequest) else "save"
    (reply,) = asked(server(saved={}), map=None, **{kind: [request_]})[kind]
    assert not reply.accepted and part in reply.reason


def test_what_cannot_be_written_is_answered():
    (reply,) = asked(server(), save=[SaveMapRequest(name="a")])["save"]
    assert (reply.accepted, reply.reason) == (False, "no room")


def mission(tmp_path, burger="", milvus=""):
    text = (ROOT / "missions" / "demo.yaml").read_text()
    text = text.replace("    model: burger\n", f"    model: burger\n{burger}").replace(
        "    model: milvus\n", f"    model: milvus\n{milvus}"
    )
    (tmp_path / "m.yaml").write_text(text)
    return load_scenario(tmp_path / "m.yaml")


def test_a_mission_gives_files_beside_it_and_saved_maps_by_name(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    grid = GridMap(CELLS, 0.05, IDENTITY)
    save_map(grid, tmp_path / "state" / "maps" / "house.yaml", "raw")
    save_map(GridMap(np.full((2, 2), 50, dtype=np.int8), 0.05, IDENTITY), tmp_path / "slow.yaml", "raw")
    site = mission(tmp_path, "    maps: {known: house, keepout: state/maps/house.yaml, speed: slow.yaml}\n")
    (host,) = map_servers(site)
    assert host.vehicle == "burger"
    outputs = stepped(host.make(), 0.0)
    assert np.array_equal(as_map(outputs["known"]).cells, CELLS)
    assert occupancy_cells(outputs["keepout"]).tolist() == [[0, 100, 0], [0, 0, 0]]
    assert occupancy_cells(outputs["speed"]).tolist() == [[50, 50], [50, 50]]
    asked(host.make(), save=[SaveMapRequest(name="again")])
    assert find_map("again").origin == pytest.approx((2.0, 2.0, np.pi / 2))


def test_maps_that_are_not_there_are_told_with_the_nearest(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path))
    save_map(GridMap(CELLS, 0.05, IDENTITY), tmp_path / "maps" / "house.yaml")
    with pytest.raises(BadInput, match="no map 'hous' is saved; did you mean 'house'"):
        map_servers(mission(tmp_path, "    maps: {known: hous}\n"))
    with pytest.raises(BadInput, match=r"no\.yaml: no such file"):
        map_servers(mission(tmp_path, "    maps: {known: no.yaml}\n"))
    with pytest.raises(BadInput, match="an aircraft does not drive by maps"):
        map_servers(mission(tmp_path, milvus="    maps: {}\n"))


def test_without_maps_the_drawn_map_is_saved_all_the_same(tmp_path, monkeypatch):
    monkeypatch.setenv("UVF_STATE", str(tmp_path / "state"))
    (host,) = map_servers(mission(tmp_path))
    assert stepped(host.make(), 0.0) == {}
    asked(host.make(), save=[SaveMapRequest(name="mine")])
    assert find_map("mine").cells.size


def test_a_grid_that_is_no_map_is_told():
    broken = as_message(GridMap(CELLS, 0.05, IDENTITY), "v/map", 0.0)
    broken.data = broken.data[:-1]
    (reply,) = asked(server(saved={}), map=broken, save=[SaveMapRequest(name="a")])["save"]
    assert "is no map of whole rows" in reply.reason
