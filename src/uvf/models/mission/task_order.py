"""Whether what a task waits for can come while it waits."""

from collections.abc import Iterator
from typing import NamedTuple

from uvf.models.mission.tasks import Task, parts_of, verb_of
from uvf.models.yaml_data import BadInput, FileLocation


class _Step(NamedTuple):
    """On the way to a task: whether the tasks beside it are done one after the other, and its place among them."""

    in_order: bool
    place: int


Way = tuple[_Step, ...]


def check_waits(tasks: list[Task], place: FileLocation) -> None:
    """Raises BadInput for a task that waits for itself, for what it is a part of, or for what comes after it."""
    ways = {task.name: way for task, way, _ in _with_ways(tasks, place) if task.name}
    for task, way, where in _with_ways(tasks, place):
        for name in () if task.when is None else (task.when.task, task.when.failed):
            if name is not None and (why := _never(way, ways[name], name)):
                raise BadInput(f"{where.at('when')}: it would wait for ever: {why}")


def _never(way: Way, other: Way, name: str) -> str:
    """Why a task waits in vain for another one, whose name that is; "" where it does not."""
    same = next((i for i, (own, its) in enumerate(zip(way, other, strict=False)) if own != its), min(len(way), len(other)))
    if same == len(way) == len(other):
        return f"it is '{name}' itself"
    if same == len(other):
        return f"it is a part of '{name}'"
    if same == len(way):
        return f"'{name}' is a part of it"
    own, its = way[same], other[same]
    return f"'{name}' begins after it; do both in a parallel" if own.in_order and its.place > own.place else ""


def _with_ways(tasks: list[Task], place: FileLocation, way: Way = (), in_order: bool = True) -> Iterator[tuple[Task, Way, FileLocation]]:
    for i, task in enumerate(tasks):
        here = (*way, _Step(in_order, i))
        yield task, here, place.at(i)
        yield from _with_ways(parts_of(task), place.at(i, verb_of(task)), here, verb_of(task) != "parallel")
