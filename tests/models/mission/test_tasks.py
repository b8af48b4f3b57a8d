"""The tasks of a mission file: what is taken, and the one line that says what is wrong with what is not."""

import pytest

from uvf.models.mission.file import load_mission
from uvf.models.mission.task_check import members_of
from uvf.models.mission.tasks import DEEPEST, MOST_TASKS, title_of, walk
from uvf.models.yaml_data import BadInput

HEAD = """about: Two rovers.
world: house
vehicles:
  anne: {model: burger, system_id: 1, start: {x: 2.2, y: 1.3}, job: {explore: true, armed: false}}
  bert: {model: burger, system_id: 2, start: {x: 8.0, y: 4.4}}
roles: {team: [anne, bert]}
tasks:
"""


def load(folder, tasks, head=HEAD):
    path = folder / "two.yaml"
    path.write_text(head + tasks)
    return load_mission(path)


def refusal(folder, tasks, head=HEAD):
    with pytest.raises(BadInput) as error:
        load(folder, tasks, head)
    return str(error.value)


def test_a_tree_is_read_with_its_names_and_parts(tmp_path):
    mission = load(
        tmp_path,
        """  - {name: look around, explore: team, until: {vehicle: team, explored: 0.5}, within: 100}
  - parallel:
      - {goal: {vehicle: anne, x: 4.0, y: 1.7}}
      - {when: {task: look around, after: 3.0}, follow: {vehicle: bert, leader: anne}, until: {at: 90.0}}
""",
    )
    assert [title_of(task) for task in walk(mission.tasks)] == ["look around", "parallel", "goal anne", "follow bert"]


def test_roles_and_names_stand_for_vehicles_each_once():
    roles = {"team": ["anne", "bert"]}
    assert members_of(["bert", "team"], roles) == ["bert", "anne"]
    assert members_of("carl", roles) == ["carl"]


@pytest.mark.parametrize(
    ("tasks", "why"),
    [
        ("  - {gaol: {vehicle: anne, x: 1, y: 2}}", "tasks[0]: gaol: unknown key 'gaol'; did you mean 'goal'?"),
        ("  - {goal: {vehicle: ann, x: 1, y: 2}}", "goal: vehicle: no vehicle or role 'ann'; did you mean 'anne'?"),
        ("  - {arm: team, disarm: team}", "tasks[0]: a task does one thing, this one arm and disarm"),
        ("  - {name: x}", "tasks[0]: there is nothing to do and nothing to wait for"),
        ("  - {parallel: []}", "tasks[0]: parallel: there are no tasks in it"),
        ("  - {follow: {vehicle: bert, leader: anne}}", "nobody follows to an end: say with until when it is done"),
        ("  - {when: {reaches: {x: 1, y: 1}}}", "tasks[0]: when: reaches: whose? give the vehicle or role"),
        ("  - {when: {vehicle: anne}}", "tasks[0]: when: anne does what?"),
        ("  - {when: {}}", "tasks[0]: when: there is no condition"),
        ("  - {when: {task: a}}", "tasks[0]: when: no task is called 'a'"),
        (
            "  - {sequence: [{when: {vehicle: anne, near: {vehicle: carl, within: 1}}}]}",
            "sequence[0]: when: near: vehicle: no vehicle or role 'carl'",
        ),
        ("  - {name: a, arm: anne}\n  - {name: a, arm: bert}", "two tasks are called 'a'; rename one"),
        ("  - {drive: {vehicle: anne, track: tracks/no.csv}}", "drive: track: there is no file"),
        ("  - {mode: {vehicle: anne, mode: misson}}", "no 'misson' here; did you mean 'mission'?"),
        ("  - " + "{sequence: [" * DEEPEST + "{arm: anne}" + "]}" * DEEPEST, f"nested more than {DEEPEST} deep"),
        ("  - {share_map: {vehicle: team, to: bert, layer: grid}}", "share_map: vehicle: 'team' is a role; name one vehicle, as 'anne'"),
        ("  - {follow: {vehicle: bert, leader: team}, until: {at: 9}}", "follow: leader: 'team' is a role"),
        ("  - {when: {vehicle: anne, near: {vehicle: team, within: 1}}}", "near: vehicle: 'team' is a role"),
        ("  - {follow: {vehicle: team, leader: anne}, until: {at: 9}}", "follow: leader: anne would follow itself"),
        ("  - {name: '  ', arm: anne}", "a task's name is blank"),
        (f"  - {{name: {'a' * 101}, arm: anne}}", "tasks[0]: name: "),
        ("  - {save_map: {vehicle: anne, name: ../x}}", "a map has letters, digits, - and _"),
        ("  - {name: a, when: {task: a}}", "tasks[0]: when: it would wait for ever: it is 'a' itself"),
        ("  - {name: a, when: {failed: b}, sequence: [{name: b, arm: anne}]}", "wait for ever: 'b' is a part of it"),
        ("  - {name: a, parallel: [{when: {task: a}, arm: anne}]}", "parallel[0]: when: it would wait for ever: it is a part of 'a'"),
        ("  - {when: {task: b}, arm: anne}\n  - {name: b, arm: bert}", "wait for ever: 'b' begins after it; do both in a parallel"),
        (
            "  - {fallback: [{parallel: [{when: {task: c}}]}, {parallel: [{name: c, arm: anne}]}]}",
            "fallback[0]: parallel[0]: when: it would wait for ever: 'c' begins after it",
        ),
        ("  - {arm: anne}\n" * (MOST_TASKS + 1), f"{MOST_TASKS + 1} tasks; {MOST_TASKS} are possible"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_its_place(tmp_path, tasks, why):
    assert why in refusal(tmp_path, tasks)


def test_tasks_wait_for_what_is_done_beside_or_before_them(tmp_path):
    tree = """  - {name: a, arm: anne}
  - parallel:
      - {when: {task: c}, arm: anne}
      - {sequence: [{name: b, when: {task: a}, arm: bert}, {name: c, when: {task: b}, disarm: bert}]}
  - {when: {failed: b}, arm: anne}
"""
    assert len(list(walk(load(tmp_path, tree).tasks))) == 7


@pytest.mark.parametrize(
    ("roles", "why"),
    [
        ("{anne: [bert]}", "roles: anne: a vehicle has this name"),
        ("{team: []}", "roles: team: nobody has the role"),
        ("{team: [an]}", "roles: team: no vehicle 'an'"),
    ],
)
def test_roles_are_checked(tmp_path, roles, why):
    assert why in refusal(tmp_path, "  - {arm: anne}", HEAD.replace("{team: [anne, bert]}", roles))


@pytest.mark.parametrize(
    ("criterion", "why"),
    [
        ("{measure: done, at_least: 1}", "a criterion is about a vehicle or a task, one of the two"),
        ("{task: go, vehicle: anne, measure: done, at_least: 1}", "a criterion is about a vehicle or a task, one of the two"),
        ("{task: gone, measure: done, at_least: 1}", "no task is called 'gone'; did you mean 'go'?"),
    ],
)
def test_a_criterion_is_about_a_vehicle_or_a_task_that_is_there(tmp_path, criterion, why):
    assert why in refusal(tmp_path, f"  - {{name: go, arm: anne}}\ncriteria:\n  - {criterion}\n")
