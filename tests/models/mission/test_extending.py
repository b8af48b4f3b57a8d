"""Missions that extend others: only what differs is written, and files are found from wherever they are named."""

import pytest
import yaml

from launch.changed_mission import changed_mission
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
    assert yaml.safe_load(path.read_text())["extends"] == "../base"
    mission = load_mission(path)
    rover = mission.vehicles["rover"]
    assert (rover.model, rover.start.x, rover.start.y, mission.seed) == ("my3bot", 3.5, 1.3, 7)
    assert changed_mission(folder / "base.yaml", [], folder / "none") == folder / "base.yaml"
    assert not (folder / "none").exists()


@pytest.mark.parametrize("setting", ["seed", "=3", "vehicles..x=1", "seed=[1"])
def test_a_setting_that_is_none_is_one_line(folder, setting):
    with pytest.raises(BadInput, match="--set"):
        changed_mission(folder / "base.yaml", [setting], folder / "run")
