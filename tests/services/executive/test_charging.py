"""Batteries are charged when they are low, one vehicle at a charger, and who is not charged there says so."""

import pytest

from schemas.messages import Mode
from services.executive.actions.charging import RISES_WITHIN
from tests.services.executive.team import MISSION, Team
from uvf.models.yaml_data import BadInput

CHARGE = "  - {name: charge, charge: {vehicle: team, below: 0.3, up_to: 0.8}}\n"
CHARGERS = "chargers: [{x: 2.5, y: 3.0}, {x: 8.0, y: 4.0}]\n"


@pytest.fixture
def team(tmp_path, monkeypatch):
    def made(tasks=CHARGE, chargers=CHARGERS):
        monkeypatch.setattr("tests.services.executive.team.MISSION", MISSION + chargers)
        return Team(tasks, tmp_path)

    return made


def drain(team, **charges):
    for name, charge in charges.items():
        team.status[name].battery_remaining = charge


def goals(team):
    return [(vehicle, m.position.x, m.position.y) for name, vehicle, m in team.asked if name == "goal"]


def test_who_is_not_low_goes_nowhere(team):
    team = team()
    drain(team, anne=0.31, bert=-1.0)
    team.step(3)
    assert team.states() == ["DONE"] and team.requests() == []


def test_who_is_low_drives_to_the_nearest_stands_there_and_leaves_when_charged(team):
    team = team()
    drain(team, anne=0.2)
    team.step(8)
    assert goals(team) == [("anne", 2.5, 3.0)]
    team.arrive("anne")
    team.step(5)
    assert team.status["anne"].mode == Mode.MODE_HOLD
    for charge in (0.3, 0.5, 0.79):
        drain(team, anne=charge)
        team.step(100)
        assert team.states() == ["RUNNING"]
    assert team.tasks.tasks[0].reason == "anne is being charged: 79 %"
    drain(team, anne=0.8)
    team.step(2)
    assert team.states() == ["DONE"]


def test_two_go_to_two_chargers_and_at_a_single_one_the_second_waits(team):
    both = team()
    drain(both, anne=0.2, bert=0.2)
    both.step(8)
    assert sorted(goals(both)) == [("anne", 2.5, 3.0), ("bert", 8.0, 4.0)]

    one = team(chargers="chargers: [{x: 2.5, y: 3.0}]\n")
    drain(one, anne=0.2, bert=0.2)
    one.step(8)
    assert [vehicle for vehicle, *_ in goals(one)] == ["anne"]
    assert one.status["bert"].mode == Mode.MODE_HOLD, "who is low does not go on with its job"
    one.places["anne"] = (2.5, 3.0)
    one.arrive("anne")
    one.step(5)
    drain(one, anne=0.8)
    one.step(10)
    assert [vehicle for vehicle, *_ in goals(one)] == ["anne"], "anne still stands on it"
    assert one.tasks.tasks[0].reason == "bert waits for a charger that is free"
    one.places["anne"] = (4.0, 3.0)
    one.step(8)
    assert [vehicle for vehicle, *_ in goals(one)] == ["anne", "bert"]


def test_an_executive_that_is_started_again_does_not_end_the_charging_early(team):
    team = team()
    team.places["anne"] = (2.5, 3.1)
    drain(team, anne=0.5)
    team.step(8)
    assert team.states() == ["RUNNING"] and goals(team) == []
    drain(team, anne=0.8)
    team.step(3)
    assert team.states() == ["DONE"]


def test_a_charger_without_current_fails_the_task_with_the_reason(team):
    team = team()
    drain(team, anne=0.2)
    team.step(8)
    team.arrive("anne")
    team.step(int(10 * RISES_WITHIN) + 20)
    assert team.states() == ["FAILED"]
    assert team.tasks.tasks[0].reason == "anne is at a charger, but its charge does not rise above 20 %"


@pytest.mark.parametrize(
    ("task", "chargers", "why"),
    [
        (CHARGE, "", "no chargers"),
        (CHARGE.replace("team", "carl"), CHARGERS, "carl does not drive"),
        (CHARGE.replace("0.8", "0.3"), CHARGERS, "make 'up_to' larger"),
        (CHARGE, "chargers: [{x: 50.0, y: 3.0}]\n", r"chargers\[0\]: \(50, 3\) is not on the floor"),
    ],
)
def test_what_cannot_be_is_refused_at_load(task, chargers, why, team):
    with pytest.raises(BadInput, match=why):
        team(task, chargers)
