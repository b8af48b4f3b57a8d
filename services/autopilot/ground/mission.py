"""The mission of a ground vehicle: which item is driven to, and when the next one's turn comes."""

from collections.abc import Sequence
from math import hypot, inf, isfinite

from schemas.messages import Mission, MissionItem, MissionProgress, Timestamp, Vector3
from uvf.runtime.messages.plans.plan_ids import mission_id

Point = tuple[float, float]

DRIVABLE = (MissionItem.WAYPOINT, MissionItem.RETURN)
SUPPORTED = (*DRIVABLE, MissionItem.JUMP, MissionItem.SPEED, MissionItem.SET_HOME)


def refusal(items: Sequence[MissionItem]) -> str:
    """Why a ground vehicle cannot drive these items; "" if it can."""
    for index, item in enumerate(items):
        fault = _fault(item, len(items))
        if fault:
            return f"item {index}: {fault}"
    if items and not any(item.kind in DRIVABLE for item in items):
        return "there is no waypoint in it"
    return ""


def _fault(item: MissionItem, total: int) -> str:
    if item.kind not in SUPPORTED:
        known = item.kind in MissionItem.Kind.values()
        return f"{MissionItem.Kind.Name(item.kind) if known else f'kind {item.kind}'} is not for a ground vehicle"
    if item.kind == MissionItem.JUMP and item.jump_to >= total:
        return f"jump to {item.jump_to}, but the last item is {total - 1}"
    for name, value in (("x", item.position.x), ("y", item.position.y), ("z", item.position.z)):
        if not isfinite(value):
            return f"{name} is {value:g}; it must be finite"
    for name in ("acceptance_radius", "hold", "speed"):
        value = getattr(item, name)
        if not 0.0 <= value < inf:
            return f"{name} is {value:g}; it must be finite and not negative"
    return ""


def mission_of(items: Sequence[MissionItem], timestamp: Timestamp) -> Mission:
    """The items as a mission message with its id, a CRC-32 of the items."""
    return Mission(timestamp=timestamp, items=items, id=mission_id(items))


class MissionEngine:
    """Steps through the items: waypoints by acceptance radius and hold time, jumps and speed changes at once."""

    def __init__(self, home: Point, acceptance_radius: float) -> None:
        self.mission = Mission()
        self.state: MissionProgress.State = MissionProgress.NO_MISSION
        self.current = 0
        self.reached = -1
        self.laps = 0
        self.speed = 0.0  # m/s, 0 = the vehicle's own
        self.acceptance_radius = acceptance_radius
        """m, of items that name none."""
        self.home = home
        self._jumps: dict[int, int] = {}
        self._arrived_at: float | None = None
        self._here: Point | None = None  # m, world

    def load(self, mission: Mission) -> None:
        """Starts another mission at its first item; check it with ``refusal`` first."""
        self.mission = mission
        self.reached, self.laps, self.speed = -1, 0, 0.0
        self._jumps.clear()
        self.state = MissionProgress.NOT_STARTED if mission.items else MissionProgress.NO_MISSION
        self._go_to(0)

    def resume(self, mission: Mission, progress: MissionProgress) -> None:
        """Resumes a mission at the item where an earlier engine was."""
        self.load(mission)
        if progress.mission_id != mission.id or progress.current >= len(mission.items):
            return
        self.state, self.current = progress.state, progress.current
        self.reached, self.laps = progress.reached, progress.laps
        changes = [item.speed for item in mission.items[: self.current] if item.kind == MissionItem.SPEED]
        self.speed = changes[-1] if changes else 0.0

    def jump_to(self, index: int) -> str:
        """Makes an item the current one; returns why it cannot, or ""."""
        if index >= len(self.mission.items):
            return f"there is no item {index}; the mission has {len(self.mission.items)}"
        if self.state == MissionProgress.COMPLETE:
            self.state = MissionProgress.NOT_STARTED
        self._go_to(index)
        return ""

    @property
    def target(self) -> Point | None:
        """Position (x, y) [m, world] of the current item; None when there is nothing to drive to."""
        if self.state in (MissionProgress.NO_MISSION, MissionProgress.COMPLETE):
            return None
        item = self.mission.items[self.current]
        return self.home if item.kind == MissionItem.RETURN else (item.position.x, item.position.y)

    def distance_left(self, position: Point | None) -> float:
        """Distance [m] from ``position`` [m, world] to the target; 0 without a target or a position."""
        target = self.target
        return hypot(position[0] - target[0], position[1] - target[1]) if position and target else 0.0

    def advance(self, t: float, position: Point | None, active: bool) -> int | None:
        """One cycle at ``t`` [s] and ``position`` [m, world]; the index of an item just completed, or None."""
        target = self.target
        if target is None:
            return None
        self.state, self._here = MissionProgress.ACTIVE if active else MissionProgress.PAUSED, position
        if not active or position is None:
            return None
        item = self.mission.items[self.current]
        if self._arrived_at is None:
            radius = item.acceptance_radius or self.acceptance_radius
            if not hypot(position[0] - target[0], position[1] - target[1]) <= radius:
                return None
            self._arrived_at = t
        if t - self._arrived_at < item.hold:
            return None
        self.reached = self.current
        self._go_to(self.current + 1)
        return self.reached

    def progress(self, timestamp: Timestamp) -> MissionProgress:
        """The progress as a message."""
        return MissionProgress(
            timestamp=timestamp,
            state=self.state,
            current=self.current,
            total=len(self.mission.items),
            reached=self.reached,
            laps=self.laps,
            mission_id=self.mission.id,
        )

    def _go_to(self, index: int) -> None:
        """The next item that is driven to, from ``index`` on; ends the mission when there is none.

        Every jump is taken at most once here, so that a ring of jumps and speeds alone ends.
        """
        self._arrived_at = None
        taken: set[int] = set()
        items = self.mission.items
        while index < len(items) and items[index].kind not in DRIVABLE:
            if items[index].kind in (MissionItem.SPEED, MissionItem.SET_HOME):
                self._carry_out(items[index])
                index += 1
            elif index not in taken and self._may_jump(index):
                taken.add(index)
                index = items[index].jump_to
            else:
                index += 1
        if index < len(items):
            self.current = index
        elif items:
            self.current = len(items) - 1
            self.state = MissionProgress.COMPLETE

    def _carry_out(self, item: MissionItem) -> None:
        if item.kind == MissionItem.SPEED:
            self.speed = item.speed
        else:
            self.home = (item.position.x, item.position.y) if item.HasField("position") else self._here or self.home

    def _may_jump(self, index: int) -> bool:
        item = self.mission.items[index]
        done = self._jumps.get(index, 0)
        if 0 <= item.repeat <= done:
            return False
        self._jumps[index] = done + 1
        self.laps += 1
        return True


def vector(point: Point) -> Vector3:
    """The point (x, y) [m] as a message with z = 0."""
    return Vector3(x=point[0], y=point[1])
