"""Plans of an autopilot as the bus has them and back: nothing is lost of what it has, and nothing is sent that it would not fly."""

from collections.abc import Sequence

from schemas.messages import Fence, Mission, MissionItem, RallyPoints, Vector3
from services.mavlink_bridge.frame import Chart
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink import fence_items, rally_items
from uvf.runtime.mavlink.limits import far_off
from uvf.runtime.mavlink.mission_items import (
    ORIGIN,
    SAME_PLACE,
    WITH_PLACE,
    BadItem,
    Body,
    as_item,
    check_whole,
    from_wire,
    is_nowhere,
    is_same_place,
    means_the_same,
    mission_of,
    packed,
    to_wire,
    unpacked,
)
from uvf.runtime.messages.validation import error_in

Item = mav.MAVLink_mission_item_int_message
MADE_UP = mav.MAV_MISSION_INVALID


class MissionScribe:
    """Converts missions. first: number of wire items before the mission's own; ArduPilot keeps home there."""

    def __init__(self, first: int) -> None:
        self.first = first

    def mission(self, bodies: Sequence[Body], chart: Chart, home_z: float) -> Mission:
        """The mission of wire items; home_z: height of home [m, world].

        An item without a counterpart is carried as one that is never executed, and given back unchanged.
        """
        items = [self._read(as_item(body), chart, home_z) for body in bodies[self.first :]]
        for item in items:
            if item.kind == MissionItem.JUMP and item.jump_to >= len(items):
                item.jump_to, item.repeat = 0, 0
        try:
            check_whole(items)
        except BadItem:  # a delay before any place
            items = [MissionItem(kind=MissionItem.JUMP, origin=i.origin) if is_nowhere(i) else i for i in items]
        return mission_of(items)

    def _read(self, item: Item, chart: Chart, home_z: float) -> MissionItem:
        try:
            read = from_wire(item, chart, home_z)
        except BadItem:
            return MissionItem(kind=MissionItem.JUMP, origin=packed(item))
        if error_in(read):  # a height that no reader on the bus would take the mission with
            return MissionItem(kind=MissionItem.JUMP, origin=packed(item))
        if read.kind == MissionItem.JUMP and item.command == mav.MAV_CMD_DO_JUMP:
            read.jump_to = max(read.jump_to - self.first, 0)
        return read

    def bodies(self, mission: Mission, chart: Chart, home: tuple[float, float, float] | None, home_z: float) -> list[Body]:
        """The wire items of a mission; home: (deg, deg, m AMSL), home_z: its height [m, world].

        The original wire item of an item is used only as long as it means the same here. Raises BadItem.
        """
        found: list[Body] = []
        for index, item in enumerate(mission.items):
            own = self._trusted(item, chart, home_z)
            if reason := _wrong(own, len(mission.items)):
                raise BadItem(MADE_UP, f"item {index}: {reason}")
            found.append(self._body(own, chart, home_z))
        if not self.first or not found:
            return found
        if home is None:
            raise BadItem(mav.MAV_MISSION_ERROR, "the autopilot wants its home in the plan, and has not told it")
        at = round(home[0] * 1e7), round(home[1] * 1e7), home[2]
        return [(mav.MAV_FRAME_GLOBAL, mav.MAV_CMD_NAV_WAYPOINT, 1, 0.0, 0.0, 0.0, 0.0, *at), *found]

    def _trusted(self, item: MissionItem, chart: Chart, home_z: float) -> MissionItem:
        """Without what it came from, where that says something else."""
        own = MissionItem()
        own.CopyFrom(item)
        if len(item.origin) == ORIGIN.size and not means_the_same(item, chart, home_z):
            own.ClearField("origin")
        return own

    def _body(self, item: MissionItem, chart: Chart, home_z: float) -> Body:
        body = to_wire(item, chart, home_z)
        if self.first and body[1] == mav.MAV_CMD_DO_JUMP:
            return (*body[:3], float(item.jump_to + self.first), *body[4:])
        return body


def _wrong(item: MissionItem, items: int) -> str:
    """Why an item of so many can be sent to no autopilot; empty if it can."""
    if item.kind not in MissionItem.Kind.values():
        return f"there is no kind {item.kind} of mission item"
    if item.origin:
        return _misshapen([item.origin])
    if item.kind in WITH_PLACE and not item.HasField("position"):
        return f"a {MissionItem.Kind.Name(item.kind)} needs a position"
    if item.kind == MissionItem.JUMP and item.jump_to >= items:
        return f"a jump to item {item.jump_to}: the last one is {items - 1}"
    return far_off(item.position)


def _misshapen(origins: Sequence[bytes]) -> str:
    """Why wire items that a plan came from are none; empty if they are."""
    lengths = [len(origin) for origin in origins if len(origin) != ORIGIN.size]
    if not lengths:
        return ""
    return f"an origin of {lengths[0]} bytes, not {ORIGIN.size}: leave origin out, or give it back as it was read"


def fence_read(bodies: Sequence[Body], chart: Chart, home_z: float) -> Fence:
    """The fence of wire items; home_z: height of home [m, world]. Raises BadItem."""
    fence = fence_items.fence_of([fence_items.checked(as_item(body), chart, home_z) for body in bodies], Fence(), chart, home_z)
    if reason := error_in(fence):
        raise BadItem(MADE_UP, reason)
    return fence


def fence_bodies(fence: Fence, chart: Chart, home_z: float) -> list[Body]:
    """The wire items of a fence; home_z: height of home [m, world].

    Raises BadItem for what no item can express, and for an invalid fence.
    """
    if fence.HasField("floor") or fence.HasField("ceiling") or fence.disabled:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, "floor, ceiling and the switch are parameters of the autopilot, no items of a fence")
    given = _given(fence.origin)
    if given and _is_same_fence(fence_read(given, chart, home_z), fence):
        return given
    _check_near([point for zone in fence.zones for point in zone.vertices or [zone.centre]] + [fence.return_point])
    own = Fence()
    own.CopyFrom(fence)
    own.ClearField("origin")
    found = fence_items.bodies(own, chart, home_z)
    fence_read(found, chart, home_z)
    return found


def _given(origins: Sequence[bytes]) -> list[Body]:
    """The wire items that a plan came from. Raises BadItem."""
    if reason := _misshapen(origins):
        raise BadItem(MADE_UP, reason)
    return [unpacked(origin) for origin in origins]


def _check_near(places: Sequence[Vector3]) -> None:
    """Raises BadItem."""
    for reason in filter(None, map(far_off, places)):
        raise BadItem(MADE_UP, reason)


def _is_same_fence(one: Fence, other: Fence) -> bool:
    """But for rounding."""
    if len(one.zones) != len(other.zones) or one.HasField("return_point") != other.HasField("return_point"):
        return False
    for a, b in zip(one.zones, other.zones, strict=True):
        if (a.excludes, a.group, len(a.vertices)) != (b.excludes, b.group, len(b.vertices)) or abs(a.radius - b.radius) > SAME_PLACE:
            return False
        pairs = zip(a.vertices, b.vertices, strict=True) if a.vertices else [(a.centre, b.centre)]
        if not all(is_same_place(p, q, ignore_height=True) for p, q in pairs):
            return False
    return is_same_place(one.return_point, other.return_point)


def rally_read(bodies: Sequence[Body], chart: Chart, home_z: float) -> RallyPoints:
    """The rally points of wire items; home_z: height of home [m, world]. Raises BadItem."""
    rally = rally_items.rally_of([as_item(body) for body in bodies], chart, home_z)
    if reason := error_in(rally):
        raise BadItem(MADE_UP, reason)
    return rally


def rally_bodies(rally: RallyPoints, chart: Chart, home_z: float) -> list[Body]:
    """The wire items of rally points; home_z: height of home [m, world]. Raises BadItem."""
    given = _given(rally.origin)
    if given and _is_same_rally(rally_read(given, chart, home_z), rally):
        return given
    _check_near(rally.points)
    return rally_items.bodies(RallyPoints(points=rally.points), chart, home_z)


def _is_same_rally(one: RallyPoints, other: RallyPoints) -> bool:
    """But for rounding."""
    return len(one.points) == len(other.points) and all(map(is_same_place, one.points, other.points))
