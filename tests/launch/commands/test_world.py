"""``uvf world``: what each command prints and how it ends."""

import pytest
from typer.testing import CliRunner

from launch.cli import app
from launch.commands import world as world_cli

RUN = CliRunner()


@pytest.fixture
def worlds(tmp_path, monkeypatch):
    monkeypatch.setattr(world_cli, "_worlds", lambda: tmp_path / "worlds")
    return tmp_path / "worlds"


def said(*arguments, code=0):
    result = RUN.invoke(app, ["world", *map(str, arguments)])
    assert result.exit_code == code, result.output
    return result.output


def test_the_worlds_are_listed_with_what_they_are_about():
    lines = said("list").splitlines()
    assert any(line.startswith("watkins") and "laboratory" in line for line in lines)


def test_a_world_is_shown_with_what_moves():
    assert "moving   person_1, person_2, person_3" in said("show", "plaza")


def test_a_world_that_is_not_there_is_named_with_the_nearest():
    assert "did you mean 'plaza'?" in said("show", "plazza", code=2)


def test_the_check_says_nothing_wrong_or_ends_with_one(worlds):
    worlds.joinpath("bad").mkdir(parents=True)
    lamp = "boxes: [{name: lamp, centre: [1.0, 1.0, 2.0], size: [0.2, 0.2, 0.2]}]"
    worlds.joinpath("bad", "world.yaml").write_text(f"about: b\norigin: {{latitude: 0, longitude: 0}}\nfloor: [0, 0, 3, 3]\n{lamp}\n")
    assert "lamp floats" in said("check", "bad", code=1)


def test_a_steep_ramp_is_a_note_and_no_problem(worlds):
    worlds.joinpath("steep").mkdir(parents=True)
    ramp = "boxes: [{name: ramp, centre: [1.5, 1.5, 0.1], size: [1.0, 1.0, 0.1], rpy: [0, -0.35, 0]}]"
    worlds.joinpath("steep", "world.yaml").write_text(f"about: b\norigin: {{latitude: 0, longitude: 0}}\nfloor: [0, 0, 3, 3]\n{ramp}\n")
    lines = said("check", "steep").splitlines()
    assert lines == ["note: ramp: 20.1 deg, steeper than the 15 deg that a rover drives", "uvf: nothing wrong"]


def test_a_start_inside_of_something_is_told_by_the_check_with_a_mission():
    assert "nothing wrong" in said("check", "house", "-m", "demo")


def test_a_new_world_is_drawn_and_not_made_twice(worlds, tmp_path):
    said("new", "house", "mine", "--rooms", "2", "--seed", "5")
    assert "is there already" in said("new", "house", "mine", code=2)
    assert "cannot be called" in said("new", "house", "../mine", code=2)
    said("picture", "mine", "--out", tmp_path / "mine.png")
    assert (tmp_path / "mine.png").read_bytes().startswith(b"\x89PNG")
    assert said("picture", "mine") == f"uvf: {worlds / 'mine' / 'picture.png'}\n"
    assert (worlds / "mine" / "picture.png").is_file()


def test_an_import_tells_what_it_left_out(worlds, tmp_path):
    box = (
        "<model name='box'><link name='l'><collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>"
    )
    text = f"<sdf version='1.6'><world name='w'><light name='lamp'/><include><uri>model://sun</uri></include>{box}</world></sdf>"
    (tmp_path / "a.world").write_text(text)
    told = said("import", tmp_path / "a.world", "--name", "a")
    assert "note: lights are not simulated: lamp" in told
    assert "# note: lights are not simulated" in (worlds / "a" / "world.yaml").read_text()
