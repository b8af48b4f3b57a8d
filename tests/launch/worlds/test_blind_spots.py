"""What a vehicle's level lidar tells wrong of a world."""

import msgspec
import pytest
from typer.testing import CliRunner

from launch.cli import app
from launch.worlds.blind_spots import blind_spots
from tests.launch.worlds.test_check import world_of
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.file import Box, Ramp, load_world

BURGER = load_vehicle(ROOT / "vehicles", "burger")  # its lidar is 0.18 m high
LOW, HIGH = Box("pallet", (2.0, 1.0, 0.05), (0.6, 0.6, 0.1)), Box("crate", (2.0, 1.0, 0.2), (0.6, 0.6, 0.4))
TABLE = Box("table", (2.0, 1.0, 0.195), (0.8, 0.8, 0.02))
RAMP, DECK = Ramp("ramp", (0.5, 1.0), 0.2, 2.0, 0.8), Box("deck", (3.0, 1.0, 0.1), (1.0, 0.8, 0.2))


def said(*boxes, file=BURGER, **parts):
    return list(blind_spots(world_of(boxes=list(boxes), **parts), "rover", file))


def test_what_stands_in_the_way_of_the_lidar_is_seen():
    assert said(HIGH) == said() == []


@pytest.mark.parametrize(("thing", "name"), [(LOW, "pallet"), (TABLE, "table")])
def test_what_the_lidar_looks_over_or_under_is_told_by_its_name(thing, name):
    (line,) = said(thing)
    assert line.startswith(f"the lidar of rover, 0.18 m high, does not see: {name} about (") and "keep-out zones help" in line


def test_a_second_lidar_sees_what_the_first_does_not():
    low = msgspec.structs.replace(
        BURGER.sensors.lidar, frame="low", mount=msgspec.structs.replace(BURGER.sensors.lidar.mount, xyz=(0.0, 0.0, 0.05))
    )
    both = msgspec.structs.replace(BURGER, sensors=msgspec.structs.replace(BURGER.sensors, other_lidars=[low]))
    assert said(LOW, file=both) == []


def test_edges_that_fall_off_and_slopes_that_look_like_walls_are_told():
    edges, slopes = said(DECK, ramps=[RAMP])
    assert "does not see: an edge of 0.20 m about (" in edges
    assert "takes for walls: ramp about (2." in slopes and "goes round" in slopes


def test_a_depth_camera_is_mentioned():
    (line,) = said(LOW, file=load_vehicle(ROOT / "vehicles", "burger_depth"))
    assert "only its depth camera does" in line


def test_of_our_worlds_the_pallet_and_the_flower_beds_are_not_seen():
    (line,) = blind_spots(load_world(ROOT / "worlds", "watkins"), "mybot05", load_vehicle(ROOT / "vehicles", "mybot05"))
    assert "does not see: pallet about" in line
    assert not list(blind_spots(load_world(ROOT / "worlds", "house"), "burger", BURGER))


def test_the_check_tells_it_of_a_vehicle_that_is_named():
    told = CliRunner().invoke(app, ["world", "check", "watkins", "--vehicle", "mybot05"])
    assert (told.exit_code, "note: the lidar of mybot05, 0.21 m high, does not see: pallet" in told.output) == (0, True)
