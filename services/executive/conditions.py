"""Whether the condition of a task holds, and in words what is waited for."""

from collections.abc import Callable, Iterator

from schemas.messages import Mode, TaskStatus
from services.executive.situation import TeamSituation
from uvf.models.mission.tasks import AtPlace, NearVehicle, TaskCondition

Holds = Callable[[TeamSituation, str], bool]


def unfulfilled(condition: TaskCondition, now: TeamSituation, since: float) -> str:
    """What does not hold yet, in words; "" if all of the condition holds. since [s]: when the turn of the task came."""
    for holds, text in _about_time(condition, now, since):
        if not holds:
            return text
    if condition.found is not None and condition.vehicle is not None:
        vehicles = now.vehicles(condition.vehicle)
        if (known := len(now.found(vehicles))) < condition.found:
            return f"{condition.found} markers are found by {' and '.join(vehicles)}, {known} by now"
    checks = list(_about_vehicles(condition))
    if condition.vehicle is None or not checks:
        return ""
    vehicles = now.vehicles(condition.vehicle)
    missing = [next((text for check, text in checks if not check(now, vehicle)), "") for vehicle in vehicles]
    return "" if "" in missing else f"{' or '.join(vehicles)} {missing[0]}"


def _about_time(condition: TaskCondition, now: TeamSituation, since: float) -> Iterator[tuple[bool, str]]:
    if condition.at is not None:
        yield now.t >= condition.at, f"it is {condition.at:g} s"
    if condition.after is not None:
        yield now.t - since >= condition.after, f"{condition.after:g} s have passed"
    for name, state in ((condition.task, TaskStatus.DONE), (condition.failed, TaskStatus.FAILED)):
        if name is not None:
            record = now.records.get(name)
            yield record is not None and record.state == state, f"{name} {'is done' if state == TaskStatus.DONE else 'fails'}"


def _about_vehicles(condition: TaskCondition) -> Iterator[tuple[Holds, str]]:
    if condition.reaches is not None:
        yield _is_at(condition.reaches), f"is within {condition.reaches.within:g} m of ({condition.reaches.x:g}, {condition.reaches.y:g})"
    if condition.near is not None:
        yield _is_near(condition.near), f"is within {condition.near.within:g} m of {condition.near.vehicle}"
    if condition.item is not None:
        yield _has_reached(condition.item), f"has reached item {condition.item}"
    if condition.mode is not None:
        mode = Mode.Value(f"MODE_{condition.mode.upper()}")
        yield lambda now, vehicle: now.mode(vehicle) == mode, f"is in mode {condition.mode}"
    if condition.landed is not None:
        landed = condition.landed
        yield lambda now, vehicle: _landed(now, vehicle) is landed, "has landed" if landed else "flies"
    if condition.fails is not None:
        fails = condition.fails
        yield lambda now, vehicle: _fails(now, vehicle) is fails, "has a failsafe that holds" if fails else "has no failsafe that holds"
    if condition.charge_below is not None:
        yield _is_low(condition.charge_below), f"has less than {100 * condition.charge_below:g} % of its charge"
    if condition.explored is not None:
        yield _has_explored(condition.explored), f"has explored {100 * condition.explored:g} %"
    if condition.merged is not None:
        merged = condition.merged
        yield lambda now, vehicle: _is_merged(now, vehicle) is merged, "has a map that is one with another" if merged else "has a map alone"


def _is_at(at: AtPlace) -> Holds:
    def holds(now: TeamSituation, vehicle: str) -> bool:
        place, distance = now.place(vehicle), now.distance(vehicle, (at.x, at.y))
        return distance is not None and distance <= at.within and (at.above is None or (place is not None and place[2] > at.above))

    return holds


def _is_near(near: NearVehicle) -> Holds:
    def holds(now: TeamSituation, vehicle: str) -> bool:
        other = now.place(near.vehicle)
        distance = None if other is None else now.distance(vehicle, other[:2])
        return distance is not None and distance <= near.within

    return holds


def _has_reached(item: int) -> Holds:
    def holds(now: TeamSituation, vehicle: str) -> bool:
        progress = now.now.progress.get(vehicle)
        return progress is not None and progress.reached >= item

    return holds


def _landed(now: TeamSituation, vehicle: str) -> bool | None:
    status = now.now.status.get(vehicle)
    return None if status is None else status.landed


def _fails(now: TeamSituation, vehicle: str) -> bool | None:
    status = now.now.status.get(vehicle)
    return None if status is None else bool(status.failsafes)


def _is_low(share: float) -> Holds:
    def holds(now: TeamSituation, vehicle: str) -> bool:
        status = now.now.status.get(vehicle)
        return status is not None and 0.0 <= status.battery_remaining < share

    return holds


def _has_explored(share: float) -> Holds:
    def holds(now: TeamSituation, vehicle: str) -> bool:
        nav = now.now.nav.get(vehicle)
        return nav is not None and nav.explored >= share

    return holds


def _is_merged(now: TeamSituation, vehicle: str) -> bool:
    of_others = (place for place in now.now.map_place.values() if place.child_frame_id != place.parent_frame_id)
    return any(f"{vehicle}/map" in (place.child_frame_id, place.parent_frame_id) for place in of_others)
