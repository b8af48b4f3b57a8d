"""``wind:`` in missions and worlds: what is read, what stands for what, and what is refused in one line."""

import pytest

from uvf.models.mission.file import load_mission
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput

MISSION = """
about: A windy flight.
world: house
vehicles:
  milvus: {model: milvus, system_id: 1, start: {x: 0.0, y: 0.0, z: 60.0, speed: 25.0}}
"""
WHOLE = """
wind:
  steady: [6.0, -2.0, 0.0]
  shear: {law: logarithmic, roughness: 0.05, height: 10.0}
  gusts:
    - {velocity: [0.0, 0.0, 4.0], length: 60.0, time: 20.0}
    - {velocity: [5.0, 0.0, 0.0], length: 100.0, place: [300.0, 40.0]}
  turbulence: {severity: moderate, w20: 12.0}
"""


def mission(tmp_path, wind):
    path = tmp_path / "windy.yaml"
    path.write_text(MISSION + wind)
    return path


def test_a_missions_wind_stands_for_that_of_its_world(tmp_path):
    wind = load_scenario(mission(tmp_path, WHOLE)).wind
    assert wind.steady == (6.0, -2.0, 0.0)
    assert wind.shear.law == "logarithmic"
    assert (wind.gusts[0].time, wind.gusts[1].place) == (20.0, (300.0, 40.0))
    assert wind.turbulence.at_20_feet == 12.0


def test_without_one_the_worlds_wind_blows_as_before(tmp_path):
    site = load_scenario(mission(tmp_path, ""))
    assert site.wind.steady == (1.5, 1.3, 0.0)
    assert load_scenario(ROOT / "missions" / "demo.yaml").wind == site.world.wind


def test_a_severity_alone_has_the_standards_wind_at_20_feet(tmp_path):
    knots = {"light": 15, "moderate": 30, "severe": 45}
    for severity, stated in knots.items():
        path = mission(tmp_path, f"wind: {{turbulence: {{severity: {severity}}}}}")
        assert load_mission(path).wind.turbulence.at_20_feet == pytest.approx(stated * 0.514444, abs=0.01)


@pytest.mark.parametrize(
    ("wind", "said"),
    [
        ("wind: {stedy: [1.0, 0.0, 0.0]}", "did you mean 'steady'"),
        ("wind: {turbulence: {severty: light}}", "did you mean 'severity'"),
        ("wind: {turbulence: {severity: heavy}}", "heavy"),
        ("wind: {shear: {law: logaritmic}}", "logaritmic"),
        ("wind: {shear: {law: logarithmic, roughness: 1.0, height: 2.0}}", "within the roughness"),
        ("wind: {changes: [{at: 10, steady: [1, 0, 0], over: 5}, {at: 12, steady: [0, 0, 0]}]}", "before the change ahead of it has ended"),
        ("wind: {gusts: [{velocity: [1.0, 0.0, 0.0], length: 50.0}]}", "either the time"),
        ("wind: {gusts: [{velocity: [1.0, 0.0, 0.0], length: 50.0, time: 1.0, place: [0.0, 0.0]}]}", "either the time"),
        ("wind: {steady: [300.0, 0.0, 0.0]}", "100"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_its_place(tmp_path, wind, said):
    with pytest.raises(BadInput) as caught:
        load_mission(mission(tmp_path, wind))
    assert said in str(caught.value)
    assert "windy.yaml:" in str(caught.value)
    assert "\n" not in str(caught.value)
