"""A program is one class in a Python file; whatever else the file holds is refused with its place."""

import shutil

import pytest

from launch import catalogue
from launch.checks import wiring_problems
from services.programs.build import build
from services.programs.loading import load_program
from uvf.models.mission.file import load_mission
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.time.lockstep import Lockstep

PLACE = FileLocation("m.yaml", ("vehicles", "rover", "program"))
HEAD = "from uvf.runtime.contract.program import Program\n"
GOOD = HEAD + "class Still(Program):\n    name = 'still'\n    hz = 5.0\n    def step(self, t, now):\n        return self.Outputs()\n"
MISSION = """about: Two rovers with one program.
world: house
vehicles:
  anne: {model: burger, system_id: 1, start: {x: 2.2, y: 1.3}, program: own.py}
  bert: {model: burger, system_id: 2, start: {x: 3.2, y: 1.3}, program: own.py}
"""


@pytest.fixture
def mission(tmp_path):
    (tmp_path / "own.py").write_text(GOOD)
    (tmp_path / "two.yaml").write_text(MISSION)
    return tmp_path / "two.yaml"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("def x(:\n", r"own\.py:1: SyntaxError"),
        ("\n\nimport no_such_module\n", r"own\.py:3: ModuleNotFoundError: No module named 'no_such_module'"),
        ("x = 1\ny = x / 0\n", r"own\.py:2: ZeroDivisionError"),
        ("x = 1\n", "defines no class derived from Program; one file has one program"),
        (GOOD + GOOD.replace("Still", "Other").replace(HEAD, ""), "defines Still and Other; one file has one program"),
        (GOOD.replace("    hz = 5.0\n", ""), "Still has no hz"),
        (GOOD.replace("    def step(self, t, now):\n        return self.Outputs()\n", ""), "Still has no step"),
        (GOOD.replace("    hz = 5.0\n", "    hz = 5.0\n    clock = 'wall'\n"), "leave scope, clock and simulator out"),
        (GOOD + "    def __init__(self):\n        pass\n", r"write 'def __init__\(self, vehicle: MissionVehicle\)'"),
    ],
)
def test_what_is_no_program_is_refused(text, why, tmp_path):
    path = tmp_path / "own.py"
    path.write_text(text)
    with pytest.raises(BadInput, match=f"m.yaml.*{why}"):
        load_program(path, PLACE)


def test_a_file_that_is_not_there_is_refused(mission):
    (mission.parent / "own.py").unlink()
    with pytest.raises(BadInput, match=r"anne.*program: there is no file .*own\.py"):
        load_mission(mission)


def test_each_vehicle_has_an_instance_of_its_own(mission):
    hosts = build(load_scenario(mission))
    assert [host.vehicle for host in hosts] == ["anne", "bert"]
    lockstep = Lockstep(hosts)
    lockstep.run(0.5)
    assert [shell.service.vehicle.name for shell in lockstep.shells] == ["anne", "bert"]


def test_it_may_not_be_called_as_another_service_of_the_vehicle(mission):
    (mission.parent / "own.py").write_text(GOOD.replace("'still'", "'planner'"))
    site = load_scenario(mission)
    hosts = catalogue.hosts(site, [kind for kind in catalogue.needed(site) if kind.clock == "sim"])
    assert "anne: 2 services are called 'planner'; rename one" in list(wiring_problems(site, hosts))


def test_a_program_that_fails_stops_its_own_vehicle_only(mission):
    text = GOOD.replace("        return", "        if self.vehicle.name == 'anne':\n            raise ValueError('mine')\n        return")
    (mission.parent / "own.py").write_text(text)
    lockstep = Lockstep(build(load_scenario(mission)), contains=True)
    lockstep.run(5.0)
    assert [line for line in lockstep.failures() if "anne" in line] and not [line for line in lockstep.failures() if "bert" in line]


def test_a_mission_elsewhere_finds_the_program_of_the_one_that_it_extends(tmp_path):
    (tmp_path / "deeper").mkdir()
    shutil.copytree(ROOT / "missions" / "programs", tmp_path / "programs")
    shutil.copy(ROOT / "missions" / "ugv1_waypoints.yaml", tmp_path)
    (tmp_path / "deeper" / "own.yaml").write_text("extends: ../ugv1_waypoints\nvehicles: {rover: {model: my2bot}}\n")
    site = load_scenario(tmp_path / "deeper" / "own.yaml")
    assert site.members["rover"].entry.program == "../programs/waypoint_pid.py"
    assert [host.service.__name__ for host in build(site)] == ["WaypointPid"]
