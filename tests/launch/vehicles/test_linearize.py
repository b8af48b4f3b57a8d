"""``uvf vehicle linearize`` as typed."""

import json

import pytest
from PIL import Image
from typer.testing import CliRunner

from launch.commands.vehicle import vehicle_app


def run(*words):
    return CliRunner().invoke(vehicle_app, ["linearize", *map(str, words)])


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("linear")
    done = run("milvus", "--speed", 25, "--json", folder / "m.json", "--picture", folder / "m.png")
    assert done.exit_code == 0, done.output
    return done.output, json.loads((folder / "m.json").read_text()), Image.open(folder / "m.png")


def test_every_mode_and_coefficient_of_the_book_is_printed(written):
    for word in (
        "short period",
        "phugoid",
        "Dutch roll",
        "roll",
        "spiral",
        "a_phi2",
        "a_theta3",
        "a_V3",
        "a_beta2",
        "residual",
        "quasi-steady",
    ):
        assert word in written[0]


def test_the_file_holds_the_matrices_with_their_names(written):
    figures = written[1]
    side = figures["longitudinal"]
    assert [len(row) for row in side["a"]] == [len(side["states"])] * 5
    assert [len(row) for row in side["b"]] == [len(side["inputs"])] * 5
    assert figures["design"]["a_phi1"] == pytest.approx(-figures["lateral"]["a"][1][1])
    assert figures["trim"]["airspeed"] == 25.0
    assert {mode["name"] for mode in figures["modes"]} >= {"short period", "phugoid", "Dutch roll", "roll", "spiral"}


def test_the_picture_shows_something(written):
    assert len(written[2].convert("RGB").getcolors(1 << 24)) > 50


def test_a_rover_has_no_such_models():
    done = run("burger")
    assert done.exit_code == 2
    assert "kind is 'ground'; only aircraft of JSBSim" in done.output.replace("\n", " ")


@pytest.mark.parametrize("option", ["--picture", "--json"])
def test_a_file_that_cannot_be_written_is_one_line(tmp_path, option):
    done = run("milvus", option, tmp_path / "not there" / "figures.png")
    assert done.exit_code == 2
    assert done.output.count("\n") == 1
    assert "cannot be written: No such file or directory; choose another place" in done.output


@pytest.mark.parametrize("altitude", ["nan", "1e6"])
def test_an_altitude_where_nothing_flies_is_refused_at_once(altitude):
    assert run("milvus", "--altitude", altitude).exit_code == 2
