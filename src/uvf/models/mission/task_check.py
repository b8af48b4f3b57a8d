"""Whether the tasks of a mission say what is to be done, by whom of its vehicles, and when."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from uvf.models.mission.task_order import check_waits
from uvf.models.mission.tasks import COMPOSITES, DEEPEST, MOST_TASKS, VERBS, Task, TaskCondition, Who, parts_of, verb_of, walk
from uvf.models.yaml_data import BadInput, FileLocation, nearest

Roles = Mapping[str, list[str]]
"""Vehicles by role."""
ABOUT_VEHICLES = ("reaches", "near", "item", "mode", "landed", "fails", "charge_below", "explored", "merged", "found")


def members_of(who: Who, roles: Roles) -> list[str]:
    """Names of the vehicles that are meant, each once, in the order in which they are named."""
    named = [who] if isinstance(who, str) else who
    return list(dict.fromkeys(name for each in named for name in roles.get(each, [each])))


def check_tasks(tasks: list[Task], roles: Roles, vehicles: Mapping[str, object], file: FileLocation, folder: Path) -> None:
    """Checks the tasks and roles of a mission; ``folder``: where its tracks are. Raises BadInput."""
    for role, names in roles.items():
        place = file.at("roles", role)
        if role in vehicles:
            raise BadInput(f"{place}: a vehicle has this name; choose another one for the role")
        if not names:
            raise BadInput(f"{place}: nobody has the role")
        for name in names:
            if name not in vehicles:
                raise BadInput(f"{place}: no vehicle '{name}'; {nearest(name, vehicles)}")
    if len(every := list(walk(tasks))) > MOST_TASKS:
        raise BadInput(f"{file.at('tasks')}: {len(every)} tasks; {MOST_TASKS} are possible")
    _check_names(every, file)
    known = {task.name for task in every if task.name}
    for task, place in placed_tasks(tasks, file.at("tasks")):
        _check_task(task, place, folder)
        for who, where in _named(task, place):
            _check_who(who, roles, vehicles, where)
        for name, where in _alone(task, place):
            _check_who(name, roles, vehicles, where)
            if name in roles:
                raise BadInput(f"{where}: '{name}' is a role; name one vehicle, as '{roles[name][0]}'")
        if task.follow is not None and task.follow.leader in members_of(task.follow.vehicle, roles):
            raise BadInput(f"{place.at('follow', 'leader')}: {task.follow.leader} would follow itself; name another vehicle")
        for condition, where in ((task.when, place.at("when")), (task.until, place.at("until"))):
            if condition is not None:
                _check_condition(condition, known, where)
    check_waits(tasks, file.at("tasks"))


def placed_tasks(tasks: list[Task], place: FileLocation, depth: int = 1) -> Iterator[tuple[Task, FileLocation]]:
    """Every task of a tree, each before its parts, and where it stands. Raises BadInput."""
    if depth > DEEPEST:
        raise BadInput(f"{place}: tasks are nested more than {DEEPEST} deep; name parts of them one after the other")
    for i, task in enumerate(tasks):
        yield task, place.at(i)
        yield from placed_tasks(parts_of(task), place.at(i, verb_of(task)), depth + 1)


def _check_names(every: list[Task], file: FileLocation) -> None:
    names = [task.name for task in every if task.name]
    for name in names:
        if not name.strip():
            raise BadInput(f"{file.at('tasks')}: a task's name is blank; leave it out or give it one")
        if names.count(name) > 1:
            raise BadInput(f"{file.at('tasks')}: two tasks are called '{name}'; rename one")


def _check_task(task: Task, place: FileLocation, folder: Path) -> None:
    verbs = [verb for verb in VERBS if getattr(task, verb) is not None]
    if len(verbs) > 1:
        raise BadInput(f"{place}: a task does one thing, this one {' and '.join(verbs)}; make a sequence or parallel of them")
    if not verbs and task.when is None:
        raise BadInput(f"{place}: there is nothing to do and nothing to wait for; give one of {', '.join(VERBS)}, or when")
    if verbs and verbs[0] in COMPOSITES and not parts_of(task):
        raise BadInput(f"{place.at(verbs[0])}: there are no tasks in it")
    if task.follow is not None and task.until is None:
        raise BadInput(f"{place}: nobody follows to an end: say with until when it is done")
    if task.share_map is not None and (area := task.share_map.area) is not None and not (area[0] < area[2] and area[1] < area[3]):
        raise BadInput(f"{place.at('share_map', 'area')}: nothing lies in it; give [x_min, y_min, x_max, y_max]")
    if task.charge is not None and not task.charge.below < task.charge.up_to:
        raise BadInput(
            f"{place.at('charge')}: below {task.charge.below:g} it goes there, at {task.charge.up_to:g} it leaves; make 'up_to' larger"
        )
    if task.visit is not None and bool(task.visit.places) is (task.visit.found is not None):
        raise BadInput(f"{place.at('visit')}: give places, or found with the vehicles that find markers: one of the two")
    if task.drive is not None and not (folder / task.drive.track).is_file():
        raise BadInput(f"{place.at('drive', 'track')}: there is no file {folder / task.drive.track}")


def _named(task: Task, place: FileLocation) -> Iterator[tuple[Who, FileLocation]]:
    """Whom a task names, with where, but for those of ``_alone``."""
    verb = verb_of(task)
    does = getattr(task, verb, None)
    if isinstance(does, str | list) and verb not in COMPOSITES:
        yield does, place.at(verb)
    for part in ("vehicle", "to") if task.share_map is None else ("to",):
        if (who := getattr(does, part, None)) is not None:
            yield who, place.at(verb, part)
    if task.visit is not None and task.visit.found is not None:
        yield task.visit.found.by, place.at("visit", "found", "by")
    for name, condition in (("when", task.when), ("until", task.until)):
        if condition is not None and condition.vehicle is not None:
            yield condition.vehicle, place.at(name, "vehicle")


def _alone(task: Task, place: FileLocation) -> Iterator[tuple[str, FileLocation]]:
    """Whom a task names where one vehicle is meant, with where."""
    if task.share_map is not None:
        yield task.share_map.vehicle, place.at("share_map", "vehicle")
    if task.follow is not None:
        yield task.follow.leader, place.at("follow", "leader")
    for name, condition in (("when", task.when), ("until", task.until)):
        if condition is not None and condition.near is not None:
            yield condition.near.vehicle, place.at(name, "near", "vehicle")


def _check_who(who: Who, roles: Roles, vehicles: Mapping[str, object], place: FileLocation) -> None:
    members = members_of(who, roles)
    if not members:
        raise BadInput(f"{place}: nobody is named")
    for name in members:
        if name not in vehicles:
            raise BadInput(f"{place}: no vehicle or role '{name}'; {nearest(name, {*vehicles, *roles})}")


def _check_condition(condition: TaskCondition, known: set[str], place: FileLocation) -> None:
    about = [name for name in ABOUT_VEHICLES if getattr(condition, name) is not None]
    if about and condition.vehicle is None:
        raise BadInput(f"{place.at(about[0])}: whose? give the vehicle or role")
    if condition.vehicle is not None and not about:
        raise BadInput(f"{place}: {condition.vehicle} does what? give one of {', '.join(ABOUT_VEHICLES)}")
    if all(getattr(condition, name) is None for name in condition.__struct_fields__):
        raise BadInput(f"{place}: there is no condition")
    for name in (condition.task, condition.failed):
        if name is not None and name not in known:
            raise BadInput(f"{place}: no task is called '{name}'; {nearest(name, known)}")
