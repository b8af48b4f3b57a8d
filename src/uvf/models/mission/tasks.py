"""``tasks:`` of a mission: what its vehicles do together, in which order, and what sets it off: a behaviour tree as data."""

from collections.abc import Iterator
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, name_like, plain
from uvf.models.names import MAP

Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Distance = Annotated[float, Meta(gt=0, le=1e6)]
ItemIndex = Annotated[int, Meta(ge=0, le=65535)]
Share = Annotated[float, Meta(ge=0, le=1)]
Who = str | list[str]
"""A vehicle, a role that the mission binds to vehicles, or several of either."""
ModeName = Literal["manual", "hold", "mission", "return", "offboard", "takeoff", "land", "follow"]

COMPOSITES = ("sequence", "parallel", "fallback")
MOST_TASKS, DEEPEST = 200, 8


class AtPlace(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A place that a vehicle is at: within a distance of it over the ground."""

    x: Annotated[Metres, key("m", "East of the world's origin.")]
    y: Annotated[Metres, key("m", "North of the world's origin.")]
    within: Annotated[Distance, key("m", "Horizontal distance from it.")] = 1.0
    above: Annotated[Metres | None, key("m", "Height above the world's origin that must be exceeded, too.")] = None


class NearVehicle(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Another vehicle that a vehicle is near to."""

    vehicle: Annotated[str, plain("The other vehicle.")]
    within: Annotated[Distance, key("m", "Horizontal distance.")]


class TaskCondition(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What must hold; of several keys all must. Those about a vehicle look at each one of ``vehicle``: one that fulfils them is enough."""

    at: Annotated[Seconds | None, key("s", "Simulation time that has come.")] = None
    after: Annotated[Seconds | None, key("s", "Time since the turn of the task came.")] = None
    task: Annotated[str | None, plain("Name of a task that has been done.")] = None
    failed: Annotated[str | None, plain("Name of a task that has failed.")] = None
    vehicle: Annotated[Who | None, plain("Vehicles or roles that the following keys are about.")] = None
    reaches: Annotated[AtPlace | None, plain("The vehicle is there.")] = None
    near: Annotated[NearVehicle | None, plain("The vehicle is near another one.")] = None
    item: Annotated[ItemIndex | None, key("", "The vehicle has reached this mission item; the first is 0.")] = None
    mode: Annotated[ModeName | None, plain("The vehicle is in this mode.")] = None
    landed: Annotated[bool | None, plain("The vehicle stands on the ground, or does not.")] = None
    fails: Annotated[bool | None, plain("A failsafe of the vehicle holds, or none does.")] = None
    charge_below: Annotated[Share | None, key("", "Charge of its battery, 0 to 1, is less.")] = None
    explored: Annotated[Share | None, key("", "Share of the floor that it has explored, by its own estimate.")] = None
    merged: Annotated[bool | None, plain("The vehicle's map is one with that of another, or is alone.")] = None
    found: Annotated[
        Annotated[int, Meta(ge=1, le=200)] | None, key("", "The vehicles together have found so many markers, each counted once.")
    ] = None


class ModeTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Change the mode."""

    vehicle: Annotated[Who, plain("Vehicles or roles.")]
    mode: Annotated[ModeName, plain("The mode.")]


class GoalTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Go to a place: a ground vehicle plans its way there, an aircraft flies there and circles. Done when it is there."""

    vehicle: Annotated[Who, plain("Vehicles or roles.")]
    x: Annotated[Metres, key("m", "East of the world's origin.")]
    y: Annotated[Metres, key("m", "North of the world's origin.")]
    z: Annotated[Metres, key("m", "Height above the world's origin; ground vehicles ignore it.")] = 0.0
    yaw: Annotated[Annotated[float, Meta(ge=-7, le=7)] | None, key("rad", "Heading there, counter-clockwise from east. Left out: any.")] = (
        None
    )


class RouteTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Drive to several places, one after the other. Done at the last one; a patrol goes on until ``until``."""

    vehicle: Annotated[Who, plain("Ground vehicles or roles.")]
    places: Annotated[list[tuple[Metres, Metres]], Meta(min_length=1, max_length=100), plain("Places [x, y] in metres, world frame.")]
    kind: Annotated[
        Literal["waypoints", "through", "patrol"],
        plain("`waypoints`: stop at each. `through`: stop at the last one. `patrol`: begin again."),
    ] = "waypoints"


class FollowTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Drive behind another vehicle, along its track, until ``until``."""

    vehicle: Annotated[Who, plain("Ground vehicles or roles; several form a column, each behind the one before.")]
    leader: Annotated[str, plain("Vehicle that is followed.")]
    distance: Annotated[Distance, key("m", "Distance along the leader's track.")] = 1.0


class DriveTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Drive as somebody has driven before: recorded velocities are sent as a joystick sends them, to all vehicles alike."""

    vehicle: Annotated[Who, plain("Ground vehicles or roles.")]
    track: Annotated[str, plain("CSV file (path relative to the mission file's folder) with the columns `t`, `linear`, `angular`.")]


class SaveMapTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Save the map that a ground vehicle has drawn as pgm and yaml, as ``uvf map save`` does."""

    vehicle: Annotated[Who, plain("Ground vehicles or roles; of several, the vehicle's name is added to that of the map.")]
    name: Annotated[str, name_like(MAP, 80, "a map has letters, digits, - and _"), plain("Name of the map.")]
    layer: Annotated[
        Literal["grid", "team"], plain("`grid`: its own map. `team`: the merged one, which the first vehicle of a team has.")
    ] = "grid"


class ShareMapTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Give the map that a vehicle has made to others, who plan by it where their own map shows nothing. Done once they have it."""

    vehicle: Annotated[str, plain("Vehicle whose map it is.")]
    to: Annotated[Who, plain("Ground vehicles or roles who get it.")]
    layer: Annotated[
        Literal["heights", "grid"],
        plain("`heights`: what an aircraft has mapped from above. `grid`: what a ground vehicle has mapped."),
    ] = "heights"
    area: Annotated[
        tuple[Metres, Metres, Metres, Metres] | None,
        plain("`[x_min, y_min, x_max, y_max]` in metres, world frame: only so much of the heights. Left out: all of them."),
    ] = None


class FoundMarkers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Markers that vehicles find while others go to them."""

    by: Annotated[Who, plain("Vehicles or roles whose detectors find them; the same marker found by two counts once.")]
    count: Annotated[int, Meta(ge=1, le=200), key("", "How many have to be visited.")]
    near: Annotated[Distance, key("m", "Distance from a marker at which a vehicle stops; who passes it as near has visited it, too.")] = 1.2


class VisitTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Share places out among a team and go there: given ones so that the last is visited early, or markers as they are found.

    Who has no marker to go to goes on with its job: one that explores looks for more.
    """

    vehicle: Annotated[Who, plain("Ground vehicles or roles.")]
    found: Annotated[FoundMarkers | None, plain("Markers that are visited, instead of `places`.")] = None
    places: Annotated[list[tuple[Metres, Metres]], Meta(max_length=50), plain("Places [x, y] in metres, world frame.")] = []


class ChargeTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Drive to a free charger when the battery is low, and stand there until it is charged. Done at once when it is not low."""

    vehicle: Annotated[Who, plain("Ground vehicles or roles.")]
    below: Annotated[Share, key("", "Charge below which it is charged.")] = 0.3
    up_to: Annotated[Share, key("", "Charge with which it leaves.")] = 0.9


class Task(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One node of the tree: at most one thing to do, when it begins, and how it ends. Without anything to do it waits for ``when``.

    A task of several tasks is one of ``sequence``, ``parallel`` and ``fallback``.
    """

    name: Annotated[
        str, Meta(max_length=100), plain("Name in lists and on the page, for conditions and criteria. Left out: what it does.")
    ] = ""
    when: Annotated[TaskCondition | None, plain("It begins once this holds. Left out: when its turn comes.")] = None
    until: Annotated[TaskCondition | None, plain("It is done as soon as this holds, however far it is.")] = None
    within: Annotated[Distance | None, key("s", "It has failed when it is not done within this time from its beginning.")] = None
    repeat: Annotated[int, Meta(ge=1, le=10_000), key("", "How often it is done.")] = 1
    sequence: Annotated["list[Task] | None", plain("Tasks done one after the other. Fails as soon as one fails.")] = None
    parallel: Annotated["list[Task] | None", plain("Tasks done at the same time. Fails as soon as one fails.")] = None
    fallback: Annotated["list[Task] | None", plain("Tasks of which the next is begun when one fails. Done as soon as one is.")] = None
    arm: Annotated[Who | None, plain("Vehicles or roles that are armed.")] = None
    disarm: Annotated[Who | None, plain("Vehicles or roles that are disarmed.")] = None
    mode: Annotated[ModeTask | None, plain("Change the mode.")] = None
    mission: Annotated[Who | None, plain("Vehicles or roles that do the mission of their `job` to its end, armed if need be.")] = None
    explore: Annotated[Who | None, plain("Ground vehicles or roles whose `job` is to explore, until they know every place.")] = None
    goal: Annotated[GoalTask | None, plain("Go to a place.")] = None
    route: Annotated[RouteTask | None, plain("Drive to several places.")] = None
    visit: Annotated[VisitTask | None, plain("Share places out among a team.")] = None
    follow: Annotated[FollowTask | None, plain("Drive behind another vehicle.")] = None
    charge: Annotated[ChargeTask | None, plain("Have the battery charged when it is low.")] = None
    drive: Annotated[DriveTask | None, plain("Drive as recorded.")] = None
    save_map: Annotated[SaveMapTask | None, plain("Save a map.")] = None
    share_map: Annotated[ShareMapTask | None, plain("Give a map to other vehicles.")] = None


MODIFIERS = ("name", "when", "until", "within", "repeat")
VERBS = tuple(field for field in Task.__struct_fields__ if field not in MODIFIERS)


def verb_of(task: Task) -> str:
    """What the task does: one of ``VERBS``, or ``wait``."""
    return next((verb for verb in VERBS if getattr(task, verb) is not None), "wait")


def parts_of(task: Task) -> list[Task]:
    """The tasks that a task consists of; none of one that does something itself."""
    verb = verb_of(task)
    return list(getattr(task, verb)) if verb in COMPOSITES else []


def walk(tasks: list[Task]) -> Iterator[Task]:
    """Every task of a tree, each before its parts."""
    for task in tasks:
        yield task
        yield from walk(parts_of(task))


def title_of(task: Task) -> str:
    """The name of a task, or what it does in words: ``goal rover (4.0, 1.7)``."""
    if task.name:
        return task.name
    verb = verb_of(task)
    does = getattr(task, verb, None)
    if verb in COMPOSITES or does is None:
        return verb.replace("_", " ")
    who = does if isinstance(does, str | list) else getattr(does, "vehicle", "")
    return " ".join((verb.replace("_", " "), ", ".join([who] if isinstance(who, str) else who)))
