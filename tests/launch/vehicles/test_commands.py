"""``uvf vehicle`` as typed."""

import shutil

import pytest
from PIL import Image
from typer.testing import CliRunner

from launch.commands import vehicle as vehicle_cli
from launch.commands.vehicle import vehicle_app
from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from tests.launch.vehicles.foreign_robots import gazebo_sdf
from uvf.models.scenario import ROOT


@pytest.fixture
def vehicles(tmp_path, monkeypatch):
    """A folder of vehicles to which a test may add, in place of the project's."""
    for name in ("burger", "common"):
        shutil.copytree(ROOT / "vehicles" / name, tmp_path / "vehicles" / name)
    monkeypatch.setattr(vehicle_cli, "_vehicles", lambda: tmp_path / "vehicles")
    monkeypatch.setenv("UVF_RUNS", str(tmp_path / "runs"))
    return tmp_path / "vehicles"


def run(*words):
    return CliRunner().invoke(vehicle_app, [str(word) for word in words])


def test_list_names_all_of_them(vehicles):
    assert "burger" in run("list").output


def test_show_prints_figures_and_frames(vehicles):
    output = run("show", "burger").output
    assert "0.16 m apart" in output and "wheel_left_link  0 0.08 0.033  (continuous wheel_left_joint)" in output


def test_check_draws_the_tree_and_a_picture(vehicles, tmp_path):
    found = run("check", "burger", "--picture", tmp_path / "p.png")
    assert found.exit_code == 0 and "burger: no faults" in found.output and "base_footprint" in found.output
    assert Image.open(tmp_path / "p.png").width > 600


def test_check_fails_for_a_fault_and_for_a_name_that_is_none(vehicles):
    path = vehicles / "burger" / "vehicle.yaml"
    path.write_text(path.read_text().replace("track: 0.16", "track: 0.26"))
    assert run("check", "burger").exit_code == 1
    missing = run("check", "burgr")
    assert missing.exit_code == 2 and "did you mean 'burger'?" in missing.output


@pytest.mark.parametrize(("radius", "track", "wheel", "height"), [(0.08, 0.12, 0.03, 0.1), (0.2, 0.3, 0.05, 0.2), (0.5, 1.1, 0.2, 0.6)])
def test_new_makes_a_vehicle_that_drives_from_four_measures(vehicles, radius, track, wheel, height):
    made = run("new", "mine", "--radius", radius, "--track", track, "--wheel-radius", wheel, "--height", height)
    assert made.exit_code == 0, made.output
    assert inspect(vehicles / "mine").faults == []
    driven = drive(vehicles / "mine", (0.3, 0.3), 3.0)
    assert driven.pose == pytest.approx(driven.expected, abs=0.02)
    assert driven.tilt < 0.02


@pytest.mark.parametrize(
    ("name", "track", "why"), [("burger", 0.3, "exists"), ("a b", 0.3, "letters, digits and _"), ("mine", 2.0, "--track 2 m does not fit")]
)
def test_new_refuses_what_cannot_be(vehicles, name, track, why):
    refused = run("new", name, "--radius", 0.2, "--track", track, "--wheel-radius", 0.05, "--height", 0.2)
    assert refused.exit_code == 2 and why in refused.output


def test_import_tells_and_checks(vehicles, tmp_path):
    done = run("import", gazebo_sdf(tmp_path / "source"), "--name", "blue", "--into", vehicles)
    assert done.exit_code == 0, done.output
    assert "note: plugins dropped: libsomething.so" in done.output and "blue: no faults" in done.output


def test_a_picture_shows_the_vehicle(vehicles, tmp_path):
    assert run("picture", "burger", "--into", tmp_path).exit_code == 0
    colours = Image.open(tmp_path / "burger.png").convert("RGB").getcolors(maxcolors=10**6)
    assert any(g > 1.5 * r and g > 1.5 * b for _, (r, g, b) in colours)  # its green boards
