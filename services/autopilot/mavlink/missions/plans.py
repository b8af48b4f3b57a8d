"""The three plans of the mission protocol: what an item of each means, what is in force, and how it is replaced."""

from typing import Any, Generic, TypeVar

from google.protobuf.message import Message

from schemas.messages import Fence, FenceRequest, Mission, MissionItem, MissionRequest, RallyPoints, RallyRequest
from services.autopilot.mavlink.commands.actions import SOURCE
from services.autopilot.mavlink.connection.line import VehicleConnection
from uvf.mavlink import dialect as mav
from uvf.mavlink.names import command_name
from uvf.runtime.mavlink import fence_items, rally_items
from uvf.runtime.mavlink.mission_items import (
    BadItem,
    Body,
    check_whole,
    from_wire,
    is_skipped,
    mission_of,
    place_of,
    to_wire,
    unpacked,
)
from uvf.runtime.messages.plan_ids import fence_id, rally_id

Item = mav.MAVLink_mission_item_int_message
P = TypeVar("P", Mission, Fence, RallyPoints)


class Plan(Generic[P]):
    """One of them, of one vehicle. What was just accepted serves downloads until the autopilot's own report shows up."""

    kind: int
    name: str
    largest: int
    call: str
    empty: type[P]

    def __init__(self, line: VehicleConnection) -> None:
        self._line = line
        self._accepted: tuple[int, P] | None = None
        """(id of what was published before, what has been accepted)."""
        self._written: tuple[P, float, list[Body]] | None = None
        """(plan, height of home, its items)."""

    @property
    def now(self) -> P:
        published = self.published()
        if self._accepted is not None and self.id_of(published) != self._accepted[0]:
            self._accepted = None
        return self._accepted[1] if self._accepted is not None else published

    def accept(self, plan: P) -> None:
        before = self.id_of(self.published())
        self._accepted = (before, plan) if before != self.id_of(plan) else None

    @property
    def home_z(self) -> float:
        """m, world; of the origin while home is unknown."""
        home = self._line.latest.home
        return float(home[2]) if home is not None else 0.0

    def told(self) -> P | None:
        """What the autopilot has said last, None while it has said nothing."""
        raise NotImplementedError

    @property
    def is_told(self) -> bool:
        return self.told() is not None or self._accepted is not None

    def published(self) -> P:
        told = self.told()
        return self.empty() if told is None else told

    def id_of(self, plan: P) -> int:
        raise NotImplementedError

    @property
    def bodies(self) -> list[Body]:
        """Of the plan in force, in their order: written once, for each item is asked for by itself."""
        plan, home_z = self.now, self.home_z
        if self._written is None or self._written[0] is not plan or self._written[1] != home_z:
            self._written = plan, home_z, self.write(plan)
        return self._written[2]

    def write(self, plan: P) -> list[Body]:
        raise NotImplementedError

    def read(self, item: Item) -> Any:
        """What an item means by itself. Raises BadItem."""
        raise NotImplementedError

    def made(self, items: list[Any]) -> P:
        """The whole plan of what has been read. Raises BadItem, which names the item."""
        raise NotImplementedError

    def request(self, plan: P) -> Message:
        raise NotImplementedError

    def note(self, items: list[Any]) -> str:
        """What has to be said of an accepted plan."""
        return ""


class MissionPlan(Plan[Mission]):
    kind, name, largest, call = mav.MAV_MISSION_TYPE_MISSION, "Mission", 500, "set_mission"
    empty = Mission

    def told(self) -> Mission | None:
        return self._line.latest.mission

    def id_of(self, plan: Mission) -> int:
        return plan.id

    def write(self, plan: Mission) -> list[Body]:
        return [to_wire(item, self._line.facts, self.home_z) for item in plan.items]

    def read(self, item: Item) -> MissionItem:
        return from_wire(item, self._line.facts, self.home_z)

    def made(self, items: list[MissionItem]) -> Mission:
        check_whole(items)
        return mission_of(items)

    def request(self, plan: Mission) -> MissionRequest:
        return MissionRequest(mission=plan, source=SOURCE)

    def note(self, items: list[MissionItem]) -> str:
        bodies = [unpacked(item.origin) for item in items]
        skipped = any(is_skipped(body[1], body[5], self._line.facts) for body in bodies)
        return "Mission: camera and gimbal items are skipped" if skipped else ""


class FencePlan(Plan[Fence]):
    kind, name, largest, call = mav.MAV_MISSION_TYPE_FENCE, "Fence", 500, "set_fence"
    empty = Fence

    def told(self) -> Fence | None:
        return self._line.latest.fence

    def id_of(self, plan: Fence) -> int:
        return fence_id(plan)

    def write(self, plan: Fence) -> list[Body]:
        return fence_items.bodies(plan, self._line.facts, self.home_z)

    def read(self, item: Item) -> Item:
        return fence_items.checked(item, self._line.facts, self.home_z)

    def made(self, items: list[Item]) -> Fence:
        return fence_items.fence_of(items, self.now, self._line.facts, self.home_z)

    def request(self, plan: Fence) -> FenceRequest:
        return FenceRequest(fence=plan, source=SOURCE)


class RallyPlan(Plan[RallyPoints]):
    kind, name, largest, call = mav.MAV_MISSION_TYPE_RALLY, "Rally", 20, "set_rally"
    empty = RallyPoints

    def told(self) -> RallyPoints | None:
        return self._line.latest.rally

    def id_of(self, plan: RallyPoints) -> int:
        return rally_id(plan)

    def write(self, plan: RallyPoints) -> list[Body]:
        return rally_items.bodies(plan, self._line.facts, self.home_z)

    def read(self, item: Item) -> Item:
        if item.command != mav.MAV_CMD_NAV_RALLY_POINT:
            raise BadItem(mav.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is no rally point")
        place_of(item, self._line.facts, self.home_z)
        return item

    def made(self, items: list[Item]) -> RallyPoints:
        return rally_items.rally_of(items, self._line.facts, self.home_z)

    def request(self, plan: RallyPoints) -> RallyRequest:
        return RallyRequest(rally=plan, source=SOURCE)
