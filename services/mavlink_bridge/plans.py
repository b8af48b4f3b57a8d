"""Plans of an autopilot as the bus has them and back: nothing is lost of what it has, and nothing is sent that it would not fly."""

from collections.abc import Sequence

from schemas.messages import Fence, Mission, MissionItem, RallyPoints
from services.mavlink_bridge.frame import Chart
from uvf.runtime.mavlink import dialect as mav
from uvf.runtime.mavlink import fence_items, rally_items
from uvf.runtime.mavlink.mission_items import (
    ORIGIN,
    WITH_PLACE,
    BadItem,
    Body,
    check_whole,
    from_wire,
    mission_of,
    packed,
    place_of,
    to_wire,
    unpacked,
)

Item = mav.MAVLink_mission_item_int_message
SAME_PLACE = 0.5  # m


def as_item(body: Body) -> Item:
    """The wire item of a body, for no one in particular."""
    frame, command, autocontinue, p1, p2, p3, p4, x, y, z = body
    return mav.MAVLink_mission_item_int_message(0, 0, 0, frame, command, 0, autocontinue, p1, p2, p3, p4, x, y, z)


class MissionScribe:
    """first: how many items of the wire come before the mission's own; ArduPilot keeps home there."""

    def __init__(self, first: int) -> None:
        self.first = first

    def mission(self, bodies: Sequence[Body], chart: Chart, home_z: float) -> Mission:
        """An item that the system has no word for is carried as one that is never done, and given back unchanged."""
        items = [self._read(as_item(body), chart, home_z) for body in bodies[self.first :]]
        for item in items:
            if item.kind == MissionItem.JUMP and item.jump_to >= len(items):
                item.jump_to, item.repeat = 0, 0
        try:
            check_whole(items)
        except BadItem:  # a delay before any place
            items = [MissionItem(kind=MissionItem.JUMP, origin=i.origin) if _is_nowhere(i) else i for i in items]
        return mission_of(items)

    def _read(self, item: Item, chart: Chart, home_z: float) -> MissionItem:
        try:
            read = from_wire(item, chart, home_z)
        except BadItem:
            return MissionItem(kind=MissionItem.JUMP, origin=packed(item))
        if read.kind == MissionItem.JUMP and item.command == mav.MAV_CMD_DO_JUMP:
            read.jump_to = max(read.jump_to - self.first, 0)
        return read

    def bodies(self, mission: Mission, chart: Chart, home: tuple[float, float, float] | None, home_z: float) -> list[Body]:
        """home: deg, deg, m AMSL. What the items came from counts only as long as it means the same here. Raises BadItem."""
        found = [self._body(item, chart, home_z) for item in mission.items]
        if not self.first or not found:
            return found
        if home is None:
            raise BadItem(mav.MAV_MISSION_ERROR, "the autopilot wants its home in the plan, and has not told it")
        at = round(home[0] * 1e7), round(home[1] * 1e7), home[2]
        return [(mav.MAV_FRAME_GLOBAL, mav.MAV_CMD_NAV_WAYPOINT, 1, 0.0, 0.0, 0.0, 0.0, *at), *found]

    def _body(self, item: MissionItem, chart: Chart, home_z: float) -> Body:
        own = MissionItem()
        own.CopyFrom(item)
        if len(item.origin) == ORIGIN.size and not _means_the_same(item, chart, home_z):
            own.ClearField("origin")
        body = to_wire(own, chart, home_z)
        if self.first and body[1] == mav.MAV_CMD_DO_JUMP:
            return (*body[:3], float(item.jump_to + self.first), *body[4:])
        return body


def _is_nowhere(item: MissionItem) -> bool:
    return item.kind in WITH_PLACE and not item.HasField("position")


def _means_the_same(item: MissionItem, chart: Chart, home_z: float) -> bool:
    """Whether the wire item lies where the mission's item does: with another home, or moved by somebody, it does not."""
    if item.kind not in WITH_PLACE:
        return True
    wire = as_item(unpacked(item.origin))
    if wire.command == mav.MAV_CMD_NAV_DELAY:
        return True
    try:
        place = place_of(wire, chart, home_z)
    except BadItem:
        return False
    return max(abs(place.x - item.position.x), abs(place.y - item.position.y), abs(place.z - item.position.z)) < SAME_PLACE


def fence_read(bodies: Sequence[Body], chart: Chart, home_z: float) -> Fence:
    """Raises BadItem."""
    return fence_items.fence_of([fence_items.checked(as_item(body), chart, home_z) for body in bodies], Fence(), chart, home_z)


def fence_bodies(fence: Fence, chart: Chart, home_z: float) -> list[Body]:
    """Raises BadItem where the fence has what no item says."""
    if fence.HasField("floor") or fence.HasField("ceiling") or fence.disabled:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, "floor, ceiling and the switch are parameters of the autopilot, no items of a fence")
    return fence_items.bodies(fence, chart, home_z)


def rally_read(bodies: Sequence[Body], chart: Chart, home_z: float) -> RallyPoints:
    """Raises BadItem."""
    return rally_items.rally_of([as_item(body) for body in bodies], chart, home_z)
