"""Whether the vehicles of a mission have what its tasks need: wheels, batteries, cameras, maps, a job."""

from collections.abc import Collection, Iterator, Mapping

from uvf.models.mission.task_check import Roles, members_of, placed_tasks
from uvf.models.mission.tasks import Task, Who, verb_of
from uvf.models.yaml_data import BadInput, FileLocation

DRIVEN = ("explore", "route", "visit", "follow", "charge", "drive", "save_map")
"""What ground vehicles do."""


def check_charging(tasks: list[Task], chargers: int, file: FileLocation) -> None:
    """Checks that there are chargers where a task needs one. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        if task.charge is not None and chargers == 0:
            raise BadInput(f"{place.at('charge')}: the mission has no chargers; set some up under 'chargers'")


def check_batteries(tasks: list[Task], roles: Roles, without: Collection[str], file: FileLocation) -> None:
    """Checks that who is to be charged, or whose charge is waited for, has a battery; without: vehicles that have none. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        asked = [] if task.charge is None else [(task.charge.vehicle, place.at("charge", "vehicle"))]
        for who, where in (*asked, *_conditions_on("charge_below", task, place)):
            for vehicle in members_of(who, roles):
                if vehicle in without:
                    raise BadInput(f"{where}: {vehicle} has no battery; give its vehicle.yaml one")


def check_finders(tasks: list[Task], roles: Roles, seeing: Collection[str], file: FileLocation) -> None:
    """Checks that who is to find markers looks for them; seeing: vehicles with a detector. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        asked = [] if task.visit is None or task.visit.found is None else [(task.visit.found.by, place.at("visit", "found", "by"))]
        for who, where in (*asked, *_conditions_on("found", task, place)):
            for vehicle in members_of(who, roles):
                if vehicle not in seeing:
                    raise BadInput(f"{where}: {vehicle} looks for no markers; give it params: {{detector: {{}}}}, and a camera")


def _conditions_on(about: str, task: Task, place: FileLocation) -> Iterator[tuple[Who, FileLocation]]:
    """Of whose vehicles the task's conditions ask that, and where they do."""
    for name, condition in (("when", task.when), ("until", task.until)):
        if condition is not None and condition.vehicle is not None and getattr(condition, about) is not None:
            yield condition.vehicle, place.at(name, about)


def check_drivers(tasks: list[Task], roles: Roles, kinds: Mapping[str, str], file: FileLocation) -> None:
    """Checks that who is asked for what ground vehicles do is one; kinds: of each vehicle. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        verb = verb_of(task)
        if verb not in DRIVEN:
            continue
        does = getattr(task, verb)
        who, where = (does, place.at(verb)) if isinstance(does, str | list) else (does.vehicle, place.at(verb, "vehicle"))
        for name in members_of(who, roles):
            if kinds[name] != "ground":
                raise BadInput(f"{where}: {name} does not drive; name ground vehicles")


def check_explorers(tasks: list[Task], roles: Roles, exploring: Collection[str], file: FileLocation) -> None:
    """Checks that who is waited for until everything is explored explores; exploring: vehicles with that job. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        for name in [] if task.explore is None else members_of(task.explore, roles):
            if name not in exploring:
                raise BadInput(f"{place.at('explore')}: {name} has another job; give it job: {{explore: true}}")


def check_merging(tasks: list[Task], roles: Roles, mapping: Collection[str], file: FileLocation) -> None:
    """Checks that whose maps are waited for to be one draw maps, and are not alone; mapping: vehicles that draw maps. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        for who, where in _conditions_on("merged", task, place):
            for name in members_of(who, roles):
                if name not in mapping:
                    raise BadInput(f"{where}: {name} draws no map that could be merged; name ground vehicles without 'localize'")
                if len(mapping) < 2:
                    raise BadInput(f"{where}: only {name} draws a map; it takes two to be merged")


def check_heights(tasks: list[Task], roles: Roles, kinds: Mapping[str, str], file: FileLocation) -> None:
    """Checks that goals of aircraft are above the ground; kinds: of each vehicle. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        if task.goal is not None and task.goal.z <= 0.0:
            for name in members_of(task.goal.vehicle, roles):
                if kinds[name] != "ground":
                    raise BadInput(f"{place.at('goal', 'z')}: {name} flies; give the height above the world's origin")


def check_shares(tasks: list[Task], roles: Roles, kinds: Mapping[str, str], file: FileLocation) -> None:
    """Checks that maps which are handed over can be drawn and used; kinds: of each vehicle. Raises BadInput."""
    for task, place in placed_tasks(tasks, file.at("tasks")):
        if (share := task.share_map) is None:
            continue
        here = place.at("share_map")
        layer = "grid" if kinds[share.vehicle] == "ground" else "heights"
        if share.layer != layer:
            raise BadInput(f"{here.at('layer')}: {share.vehicle} has no {share.layer}; a {kinds[share.vehicle]} vehicle has its {layer}")
        if share.area is not None and layer == "grid":
            raise BadInput(f"{here.at('area')}: a grid is handed over as a whole; leave the area out")
        for name in members_of(share.to, roles):
            if kinds[name] != "ground":
                raise BadInput(f"{here.at('to')}: {name} does not drive; only ground vehicles plan by such a map")
