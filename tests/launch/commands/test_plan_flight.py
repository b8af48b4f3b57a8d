"""``uvf plan flight``: the mission that it writes, and what it refuses."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from launch.checks import check_mission
from launch.cli import app
from launch.planning.obstacles import prisms_of
from uvf.guidance.fence_plan import mission_fault
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.maths.zones import Disc
from uvf.models.mission.fence import FenceAction, Fencing, region_of, zones_of
from uvf.models.mission.file import load_mission
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import Box, Cylinder, Origin, Sphere, WorldFile
from uvf.planning.flight import Airspace

PLAIN = {
    "start": "{x: -300, y: 0, z: 60}",
    "goal": "{x: 400, y: 60, z: 90, course: 1.571}",
    "fence": "{floor: 20, ceiling: 160, zones: [{polygon: [[-500, -400], [700, -400], [700, 400], [-500, 400]]}]}",
    "obstacles": "[{circle: [50, 0, 60]}, {polygon: [[200, -300], [260, -300], [260, 40], [200, 40]], ceiling: 150}]",
}


@pytest.fixture
def write(tmp_path):
    def written(**changed):
        path = tmp_path / "yard.yaml"
        path.write_text("\n".join(f"{name}: {value}" for name, value in (PLAIN | changed).items() if value is not None))
        return path

    return written


def flight(*arguments):
    result = CliRunner().invoke(app, ["plan", "flight", *map(str, arguments)])
    return result.exit_code, result.output


def test_a_file_becomes_a_mission_that_passes_its_check(write, tmp_path):
    out = tmp_path / "flight.yaml"
    code, said = flight(write(), "--wind", 4, -3, "--out", out)
    assert code == 0, said
    assert "2 obstacles" in said and "circles at the goal" in said
    assert check_mission(str(out)) == []
    mission = load_mission(out)
    vehicle = mission.vehicles["aircraft"]
    items = vehicle.job.mission
    assert (vehicle.start.x, vehicle.start.z, vehicle.fence.ceiling) == (-300.0, 60.0, 160.0)
    assert vehicle.start.yaw == pytest.approx(math.atan2(60, 700), abs=1e-4)
    goal = [item for item in items if item.kind == "waypoint"][-1]
    assert (goal.x, goal.y, goal.z, goal.course) == (400.0, 60.0, 90.0, 1.571)
    assert items[-1].kind == "orbit" and not items[-1].to_altitude
    assert mission.wind.steady[:2] == (4.0, -3.0)


def test_the_autopilot_takes_the_mission_within_its_fence(write, tmp_path):
    out = tmp_path / "flight.yaml"
    assert flight(write(), "--out", out)[0] == 0
    vehicle = load_mission(out).vehicles["aircraft"]
    fencing = Fencing(region_of(zones_of(vehicle.fence, "")), vehicle.fence.floor, vehicle.fence.ceiling, FenceAction.RETURN)
    items = [PlanItem(ItemKind(item.kind), Place(item.y, item.x, item.z), radius=item.radius) for item in vehicle.job.mission]
    assert mission_fault(items, fencing, AirParams()) == ""


def test_the_same_seed_writes_the_same_file(write):
    path = write()
    assert flight(path, "--seed", 3) == flight(path, "--seed", 3)


@pytest.mark.parametrize(
    ("changed", "arguments", "why"),
    [
        ({}, ["--vehicle", "burger"], "no aircraft"),
        ({}, ["--world", "nowhere"], "nowhere"),
        ({}, ["--wind", "nan", 0], "finite"),
        ({}, ["--wind", 30, 0], "not every course"),
        ({}, ["--airspeed", 90], "flies 19 to 32"),
        ({}, ["--aside", 5], "keeps 12 m from its fence"),
        ({"goal": "{x: -300, y: 0, z: 60}"}, [], "at one place"),
        ({"goal": "{x: 50, y: 10, z: 60}"}, [], "the goal lies within obstacle or excluded zone 0"),
        ({"goal": "{x: 900, y: 10, z: 60}"}, [], "the goal lies outside of the fence"),
        ({"goal": "{x: .nan, y: 10, z: 60}"}, [], "goal"),
        ({"goal": None}, [], "goal"),
        ({"start": "{x: -300, y: 0, z: 15}"}, [], "the start is at 15 m; with the margin, heights from 30 to 150 m"),
        ({"obstacles": "[{ceiling: 50}]"}, [], "obstacles: 0: an obstacle is a polygon or a circle"),
        ({"obstacles": "[{circle: [0, 0, 5], floor: 60, ceiling: 50}]"}, [], "obstacles: 0: the floor, 60 m, is not below"),
        ({"obstacles": "[{polygon: [[0, 0], [1, 1]]}]"}, [], "obstacles: 0: a polygon of 2 corners"),
        ({"obstacles": "[{polygon: [[0, -500], [9, -500], [9, 500], [0, 500]]}]"}, [], "no way was found"),
        ({"surprise": "1"}, [], "surprise"),
    ],
)
def test_what_cannot_be_is_answered_in_one_line(write, changed, arguments, why):
    code, said = flight(write(**changed), *arguments)
    assert code == 2
    assert why in said and "Traceback" not in said


def test_without_a_file_it_says_what_it_takes(tmp_path):
    code, said = flight(tmp_path / "missing.yaml")
    assert code == 2 and "start, goal, fence and obstacles" in said


def test_things_of_a_world_are_kept_clear_of_up_to_their_tops():
    world = WorldFile(
        about="",
        origin=Origin(0.0, 0.0),
        floor=(-50.0, -50.0, 50.0, 50.0),
        boxes=[Box("block", (10.0, 0.0, 5.0), (8.0, 4.0, 10.0), (0.0, 0.0, math.pi / 2)), Box("slab", (0.0, 30.0, 9.0), (2.0, 2.0, 2.0))],
        cylinders=[Cylinder("mast", (-20.0, 0.0, 0.0), 1.5, 30.0), Cylinder("log", (-20.0, 20.0, 1.0), 1.0, 10.0, (math.pi / 2, 0.0, 0.0))],
        spheres=[Sphere("tank", (0.0, -20.0, 6.0), 6.0)],
    )
    block, slab, mast, log, tank = prisms_of(world)
    assert [prism.ceiling for prism in (block, slab, mast, log, tank)] == pytest.approx([10.0, 10.0, 30.0, 2.0, 12.0])
    assert block.area.inside(np.array([(11.9, 3.9), (12.1, 0.0)])) == pytest.approx([0.1, -0.1])
    assert mast.area == Disc((-20.0, 0.0), 1.5)
    assert log.area.inside(np.array([(-20.0, 15.0)]))[0] > 0.9 > 0 > log.area.inside(np.array([(-20.0, 21.0)]))[0]
    assert Airspace((block, slab, mast, log, tank)).obstacles
