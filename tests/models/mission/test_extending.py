"""Missions that extend others: only what differs is written, and files are found from wherever they are named."""

import pytest
import yaml

from launch.changed_mission import changed_mission, load_changed
from uvf.models.mission.file import load_mission
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput

BASE = """about: A rover is driven.
world: house
seed: 4
vehicles:
  rover:
    model: burger
    system_id: 1
    start: {x: 2.2, y: 1.3}
    params: {mapping: {method: hector}}
tasks:
  - {drive: {vehicle: rover, track: tracks/a.csv}}
criteria:
  - {vehicle: rover, measure: contacts, at_most: 0}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "tracks").mkdir()
    (tmp_path / "tracks" / "a.csv").write_text("t,linear,angular\n0,0.1,0\n")
    (tmp_path / "base.yaml").write_text(BASE)
    (tmp_path / "variants").mkdir()
    return tmp_path


def variant(folder, text):
    path = folder / "variants" / "other.yaml"
    path.write_text(text)
    return path


def test_only_what_is_written_differs_and_lists_are_replaced_as_a_whole(folder):
    path = variant(folder, "extends: ../base\nvehicles: {rover: {model: my2bot}}\ncriteria: []\n")
    base, other = load_mission(folder / "base.yaml"), load_mission(path)
    assert (other.vehicles["rover"].model, other.vehicles["rover"].start) == ("my2bot", base.vehicles["rover"].start)
    assert (other.seed, other.criteria, other.world) == (4, [], "house")


def test_null_takes_out_what_the_other_one_says(folder):
    path = variant(folder, "extends: ../base\nseed: null\nvehicles: {rover: {params: null}}\n")
    other = load_mission(path)
    assert (other.seed, other.vehicles["rover"].params) == (1, {})
    (folder / "runs").mkdir()
    changed = changed_mission(folder / "base.yaml", ["vehicles.rover.params=null", "vehicles.rover.model=my2bot"], folder / "runs")
    rover = load_mission(changed).vehicles["rover"]
    assert (rover.params, rover.model, rover.start.x) == ({}, "my2bot", 2.2)


def test_a_file_is_found_from_the_folder_of_the_mission_that_names_it(folder):
    (task,) = load_mission(variant(folder, "extends: ../base\n")).tasks
    assert task.drive.track == "../tracks/a.csv"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("extends: ../bose\n", "extends: no mission '../bose' there; did you mean 'base'?"),
        ("extends: other\n", "extends: other leads round in a circle"),
        ("extends: [1]\n", "extends: name the mission file that is extended"),
        ("extends: ../base\nvehicles: {rover: {modle: x}}\n", "vehicles: rover: modle: unknown key 'modle'; did you mean 'model'?"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(folder, text, why):
    with pytest.raises(BadInput) as error:
        load_mission(variant(folder, text))
    assert why in str(error.value)


def test_parameters_of_the_mission_come_before_those_of_the_vehicles_file(folder):
    (member,) = load_scenario(folder / "base.yaml", ROOT).members.values()
    assert member.file.params["mapping"]["method"] == "hector"


def test_a_changed_mission_is_a_file_that_can_be_run_again(folder):
    path = changed_mission(folder / "base.yaml", ["vehicles.rover.model=my3bot", "seed=7", "vehicles.rover.start.x=3.5"], folder / "run")
    assert yaml.safe_load(path.read_text())["extends"] == "../base.yaml"
    mission = load_mission(path)
    rover = mission.vehicles["rover"]
    assert (rover.model, rover.start.x, rover.start.y, mission.seed) == ("my3bot", 3.5, 1.3, 7)
    assert changed_mission(folder / "base.yaml", [], folder / "none") == folder / "base.yaml"
    assert not (folder / "none").exists()


def test_null_takes_out_whatever_was_set_before_and_what_is_not_there_cannot_be_taken_out(folder):
    def changed(*settings):
        return load_mission(changed_mission(folder / "base.yaml", list(settings), folder))

    assert changed("criteria=null").criteria == []
    assert changed("vehicles.rover.system_id=4", "vehicles.rover.params=null").vehicles["rover"].params == {}
    with pytest.raises(BadInput, match=r"--set vehicles.rover.parms=null: the mission has no 'parms' there; did you mean 'params'?"):
        changed("vehicles.rover.parms=null")


@pytest.mark.parametrize("name", ["base.yaml", "base.v2.yaml", "base.yml"])
def test_the_mission_that_is_changed_stays_as_it_is_and_is_no_other_one(folder, name):
    """Also where the changed one is to lie beside it, and another one is called like the first part of its name."""
    (folder / name).write_text(BASE.replace("seed: 4", "seed: 5"))
    for _ in range(2):
        path = changed_mission(folder / name, ["duration=3"], folder)
        assert path.name not in ("base.yaml", "base.v2.yaml", "base.yml")
        assert (load_mission(path).seed, load_mission(path).duration) == (5, 3.0)
    assert "seed: 5" in (folder / name).read_text()


def test_what_is_wrong_with_a_value_is_said_of_the_mission_and_not_of_a_file_made_for_it(folder):
    with pytest.raises(BadInput) as error:
        load_changed(folder / "base.yaml", ["vehicles.rover.modle=x"])
    assert str(error.value).startswith(f"{folder / 'base.yaml'} as --set changes it: vehicles: rover: modle: unknown key")


@pytest.mark.parametrize("setting", ["seed", "=3", "vehicles..x=1", "seed=[1", "about=#x"])
def test_a_setting_that_is_none_is_one_line(folder, setting):
    with pytest.raises(BadInput, match="--set"):
        changed_mission(folder / "base.yaml", [setting], folder / "run")
