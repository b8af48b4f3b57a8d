"""Mission items of messages (ENU) as the library's plan items (north, east, height)."""

import math
from collections.abc import Iterable, Mapping

from schemas.messages import MissionItem, Vector3
from uvf.guidance.approach import with_courses
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place

KINDS: Mapping[int, ItemKind] = {
    MissionItem.WAYPOINT: ItemKind.WAYPOINT,
    MissionItem.ORBIT: ItemKind.ORBIT,
    MissionItem.RETURN: ItemKind.RETURN,
    MissionItem.JUMP: ItemKind.JUMP,
    MissionItem.SPEED: ItemKind.SPEED,
    MissionItem.TRIGGER: ItemKind.TRIGGER,
    MissionItem.TRIGGER_DISTANCE: ItemKind.TRIGGER_DISTANCE,
    MissionItem.TAKEOFF: ItemKind.TAKEOFF,
    MissionItem.LAND: ItemKind.LAND,
    MissionItem.LAND_START: ItemKind.LAND_START,
    MissionItem.SET_HOME: ItemKind.SET_HOME,
}


def place_of(v: Vector3) -> Place:
    """A position (x, y, z) of a message [m, world, ENU] as a place: north, east and height [m]."""
    return Place(v.y, v.x, v.z)


def plan_items(messages: Iterable[MissionItem]) -> list[PlanItem]:
    """The items of a mission. Raises ValueError for a kind that cannot be flown yet and for a number that is none."""
    return with_courses([_item(i, m) for i, m in enumerate(messages)])


def _item(index: int, m: MissionItem) -> PlanItem:
    if m.kind not in KINDS:
        name = MissionItem.Kind.Name(m.kind) if m.kind in MissionItem.Kind.values() else f"kind {m.kind}"
        raise ValueError(f"item {index}: {name} is not flown by this autopilot; {', '.join(k.value for k in ItemKind)} are")
    p = m.position
    if not all(map(math.isfinite, (p.x, p.y, p.z, m.acceptance_radius, m.hold, m.radius, m.turns, m.speed, m.course, m.distance))):
        raise ValueError(f"item {index} holds a number that is not finite")
    return PlanItem(
        KINDS[m.kind],
        place_of(m.position),
        m.hold,
        m.radius,
        m.turns,
        m.speed,
        m.jump_to,
        m.repeat,
        course=math.pi / 2 - m.course if m.HasField("course") else None,
        acceptance=m.acceptance_radius or math.inf,
        to_altitude=m.to_altitude,
        distance=m.distance,
        here=not m.HasField("position"),
    )
