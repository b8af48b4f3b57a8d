"""Made-up airfields: a strip in its course, with the magnetic field of the place, free of problems."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from launch.cli import app
from launch.worlds.airfield import AirfieldPlan, airfield, write_plate
from launch.worlds.check import problems
from uvf.models.world.file import LARGEST_FLOOR, Origin, load_world
from uvf.models.world.writer import write_world

ZURICH = Origin(47.37, 8.54, 420.0)


def made(tmp_path, field):
    world = airfield(field, "an airfield")
    write_world(world, tmp_path / "made")
    write_plate(tmp_path / "made")
    return load_world(tmp_path, "made")


@pytest.mark.parametrize(
    ("course", "length", "width"), [(90.0, 300.0, 12.0), (0.0, 60.0, 4.0), (137.0, 1200.0, 30.0), (-45.0, 5000.0, 60.0)]
)
def test_nothing_is_wrong_with_it(tmp_path, course, length, width):
    world = made(tmp_path, AirfieldPlan(ZURICH, length, width, math.radians(course)))
    assert list(problems(world, 0.115)) == []
    x_min, y_min, x_max, y_max = world.floor
    assert (x_max - x_min) * (y_max - y_min) <= LARGEST_FLOOR
    (strip,) = world.strips
    across = np.array((-math.sin(strip.yaw), math.cos(strip.yaw)))
    for thing in (world.boxes[0].centre, world.windsocks[0].base):
        assert abs(across @ np.array(thing[:2])) >= width / 2 + 14.0


@pytest.mark.parametrize(("course", "x", "y"), [(90.0, 1.0, 0.0), (0.0, 0.0, 1.0), (135.0, math.sqrt(0.5), -math.sqrt(0.5))])
def test_its_strip_runs_in_its_course(tmp_path, course, x, y):
    (strip,) = made(tmp_path, AirfieldPlan(ZURICH, 300.0, 12.0, math.radians(course))).strips
    assert abs(math.cos(strip.yaw) * x + math.sin(strip.yaw) * y) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("place", "field"),  # World Magnetic Model 2020 to 2025: east, north, up in uT
    [(ZURICH, (1.2, 21.6, -43.0)), (Origin(-33.9, 151.2), (5.3, 24.2, 51.1))],
)
def test_the_compass_points_as_it_does_there(tmp_path, place, field):
    world = made(tmp_path, AirfieldPlan(place, 300.0, 12.0, 1.0))
    assert np.array(world.magnetic_field) * 1e6 == pytest.approx(np.array(field), abs=2.0)


@pytest.mark.parametrize("latitude", [-90.0, 90.0])
def test_at_a_pole_the_needle_stands_on_its_end(tmp_path, latitude):
    east, north, up = made(tmp_path, AirfieldPlan(Origin(latitude, 180.0), 300.0, 12.0, 1.0)).magnetic_field
    assert 50e-6 < abs(up) < 65e-6 and math.hypot(east, north) < 20e-6 and up * latitude < 0


def test_the_command_writes_it_or_says_what_is_wrong(tmp_path, monkeypatch):
    monkeypatch.setattr("launch.commands.world._worlds", lambda: tmp_path)
    said = CliRunner().invoke(app, ["world", "new", "airfield", "meadow", "--at", "47.37", "8.54", "420", "--course", "140"])
    assert said.exit_code == 0, said.output
    assert load_world(tmp_path, "meadow").strips[0].length == 300.0
    for args, why in ((["--at", "97", "8", "0"], "--at: latitude: 97 is above 90 deg"), (["--strip", "4", "12"], "--strip: length: 4")):
        said = CliRunner().invoke(app, ["world", "new", "airfield", "other", *args])
        assert said.exit_code != 0 and why in said.output
    assert not (tmp_path / "other").exists()
