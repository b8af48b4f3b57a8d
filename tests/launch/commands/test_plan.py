"""``uvf plan survey``: the mission that it writes, and what it refuses."""

import json

import pytest
from typer.testing import CliRunner

from launch.checks import check_mission
from launch.cli import app
from uvf.models.mission.file import load_mission

OUTLINE = [[14.790, 40.770], [14.794, 40.7705], [14.7935, 40.773], [14.7905, 40.7725]]


@pytest.fixture
def area(tmp_path):
    path = tmp_path / "meadow.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [OUTLINE]}))
    return path


def survey(*arguments):
    result = CliRunner().invoke(app, ["plan", "survey", *map(str, arguments)])
    return result.exit_code, result.output


def test_an_area_becomes_a_mission_that_passes_its_check(area, tmp_path):
    out = tmp_path / "survey.yaml"
    code, said = survey(area, "--height", 80, "--wind", 5, -3, "--out", out)
    assert code == 0, said
    assert "swaths" in said and "covered 99" in said
    assert check_mission(str(out)) == []
    mission = load_mission(out)
    items = mission.vehicles["surveyor"].job.mission
    assert mission.wind.steady[:2] == (5.0, -3.0)
    assert {item.z for item in items if item.kind == "waypoint"} == {80.0}
    assert sum(item.kind == "trigger_distance" and item.distance > 0 for item in items) >= 4
    assert max(abs(item.x) for item in items) < 900.0


def test_heights_are_above_the_highest_ground(area, tmp_path):
    out = tmp_path / "survey.yaml"
    code, said = survey(area, "--height", 80, "--world", "hills", "--at", 0, 0, "--out", out)
    assert code == 0, said
    heights = {item.z for item in load_mission(out).vehicles["surveyor"].job.mission if item.kind == "waypoint"}
    assert len(heights) == 1 and heights.pop() > 81.0


def test_without_a_file_the_mission_is_printed(area):
    code, said = survey(area, "--height", 120, "--sensor", 23.5, 15.6, 35, "--direction", 90)
    assert code == 0
    assert "course: -0.00000" in said or "course: 0.00000" in said or "course: 3.14159" in said


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["--height", 0], "height"),
        (["--height", 80, "--vehicle", "burger"], "no aircraft"),
        (["--height", 80, "--vehicle", "nonsense"], "nonsense"),
        (["--height", 80, "--world", "nowhere"], "nowhere"),
        (["--height", 80, "--wind", 30, 0], "not every course"),
        (["--height", 80, "--wind", "nan", 0], "finite"),
        (["--height", 80, "--airspeed", 90], "flies 19 to 32"),
        (["--height", 80, "--sidelap", 0.99], "0.95"),
        (["--height", 80, "--spacing", 0.1, "--trigger", 5], "at most"),
        (["--height", 80, "--fov", 0, 10], "field of view"),
        (["--height", 80, "--fov", 60, 40, "--sensor", 1, 1, 1], "either"),
    ],
)
def test_what_cannot_be_is_answered_in_one_line(area, arguments, why):
    code, said = survey(area, *arguments)
    assert code == 2
    assert why in said and "Traceback" not in said


def test_an_area_far_from_the_world_is_refused_with_the_mend(tmp_path):
    path = tmp_path / "far.json"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [[[5.0, 52.0], [5.005, 52.0], [5.005, 52.003]]]}))
    code, said = survey(path, "--height", 80)
    assert code == 2 and "--at 0 0" in said
    assert survey(path, "--height", 80, "--at", 0, 0)[0] == 0
