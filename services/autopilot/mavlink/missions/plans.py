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
from uvf.runtime.messages.plans.plan_ids import fence_id, rally_id

Item = mav.MAVLink_mission_item_int_message
P = TypeVar("P", Mission, Fence, RallyPoints)


class Plan(Generic[P]):
    """One of a vehicle's plans. What was just accepted is served to downloads until the autopilot's own report shows up."""

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
        """The plan in force: the one just accepted, or the published one."""
        published = self.published()
        if self._accepted is not None and self.id_of(published) != self._accepted[0]:
            self._accepted = None
        return self._accepted[1] if self._accepted is not None else published

    def accept(self, plan: P) -> None:
        """Notes a plan that the autopilot has accepted."""
        before = self.id_of(self.published())
        self._accepted = (before, plan) if before != self.id_of(plan) else None

    @property
    def home_z(self) -> float:
        """Height z of home [m, world]; that of the origin while home is unknown."""
        home = self._line.latest.home
        return float(home[2]) if home is not None else 0.0

    def told(self) -> P | None:
        """The plan that the autopilot has published last; None while it has published none."""
        raise NotImplementedError

    @property
    def is_told(self) -> bool:
        """Whether the plan is known."""
        return self.told() is not None or self._accepted is not None

    def published(self) -> P:
        """The published plan, empty while there is none."""
        told = self.told()
        return self.empty() if told is None else told

    def id_of(self, plan: P) -> int:
        """The id of a plan."""
        raise NotImplementedError

    @property
    def bodies(self) -> list[Body]:
        """The items of the plan in force in MAVLink's form; cached, for each item is requested by itself."""
        plan, home_z = self.now, self.home_z
        if self._written is None or self._written[0] is not plan or self._written[1] != home_z:
            self._written = plan, home_z, self.write(plan)
        return self._written[2]

    def write(self, plan: P) -> list[Body]:
        """The items of a plan in MAVLink's form."""
        raise NotImplementedError

    def read(self, item: Item) -> Any:
        """The meaning of a single item. Raises BadItem."""
        raise NotImplementedError

    def made(self, items: list[Any]) -> P:
        """The whole plan from the items read. Raises BadItem, which names the item."""
        raise NotImplementedError

    def request(self, plan: P) -> Message:
        """The request that sets the plan."""
        raise NotImplementedError

    def note(self, items: list[Any]) -> str:
        """What has to be reported about an accepted plan, "" for nothing."""
        return ""


class MissionPlan(Plan[Mission]):
    """The mission."""

    kind, name, largest, call = mav.MAV_MISSION_TYPE_MISSION, "Mission", 500, "set_mission"
    empty = Mission

    def told(self) -> Mission | None:
        """The mission that the autopilot has published last."""
        return self._line.latest.mission

    def id_of(self, plan: Mission) -> int:
        """The mission's id."""
        return plan.id

    def write(self, plan: Mission) -> list[Body]:
        """The mission items in MAVLink's form."""
        return [to_wire(item, self._line.facts, self.home_z) for item in plan.items]

    def read(self, item: Item) -> MissionItem:
        """The mission item of a message. Raises BadItem."""
        return from_wire(item, self._line.facts, self.home_z)

    def made(self, items: list[MissionItem]) -> Mission:
        """The mission made of the items. Raises BadItem."""
        check_whole(items)
        return mission_of(items)

    def request(self, plan: Mission) -> MissionRequest:
        """The request that sets the mission."""
        return MissionRequest(mission=plan, source=SOURCE)

    def note(self, items: list[MissionItem]) -> str:
        """Reports camera and gimbal items, which are skipped."""
        bodies = [unpacked(item.origin) for item in items]
        skipped = any(is_skipped(body[1], body[5], self._line.facts) for body in bodies)
        return "Mission: camera and gimbal items are skipped" if skipped else ""


class FencePlan(Plan[Fence]):
    """The geofence."""

    kind, name, largest, call = mav.MAV_MISSION_TYPE_FENCE, "Fence", 500, "set_fence"
    empty = Fence

    def told(self) -> Fence | None:
        """The fence that the autopilot has published last."""
        return self._line.latest.fence

    def id_of(self, plan: Fence) -> int:
        """The fence's id."""
        return fence_id(plan)

    def write(self, plan: Fence) -> list[Body]:
        """The fence items in MAVLink's form."""
        return fence_items.bodies(plan, self._line.facts, self.home_z)

    def read(self, item: Item) -> Item:
        """The fence item, checked. Raises BadItem."""
        return fence_items.checked(item, self._line.facts, self.home_z)

    def made(self, items: list[Item]) -> Fence:
        """The fence made of the items. Raises BadItem."""
        return fence_items.fence_of(items, self.now, self._line.facts, self.home_z)

    def request(self, plan: Fence) -> FenceRequest:
        """The request that sets the fence."""
        return FenceRequest(fence=plan, source=SOURCE)


class RallyPlan(Plan[RallyPoints]):
    """The rally points."""

    kind, name, largest, call = mav.MAV_MISSION_TYPE_RALLY, "Rally", 20, "set_rally"
    empty = RallyPoints

    def told(self) -> RallyPoints | None:
        """The rally points that the autopilot has published last."""
        return self._line.latest.rally

    def id_of(self, plan: RallyPoints) -> int:
        """The rally points' id."""
        return rally_id(plan)

    def write(self, plan: RallyPoints) -> list[Body]:
        """The rally points in MAVLink's form."""
        return rally_items.bodies(plan, self._line.facts, self.home_z)

    def read(self, item: Item) -> Item:
        """The rally point item, checked. Raises BadItem."""
        if item.command != mav.MAV_CMD_NAV_RALLY_POINT:
            raise BadItem(mav.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is no rally point")
        place_of(item, self._line.facts, self.home_z)
        return item

    def made(self, items: list[Item]) -> RallyPoints:
        """The rally points made of the items. Raises BadItem."""
        return rally_items.rally_of(items, self._line.facts, self.home_z)

    def request(self, plan: RallyPoints) -> RallyRequest:
        """The request that sets the rally points."""
        return RallyRequest(rally=plan, source=SOURCE)
