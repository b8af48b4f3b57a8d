"""The mission that is being drawn for a vehicle, and how it differs from the one in force there."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot
from typing import Any

from schemas.messages import Mission, MissionItem, Vector3
from services.gcs.state.remembered import Remembered

MOST_ITEMS = 500
NEAR = 1e-3  # m: a place that was moved by less has not been moved
KINDS: dict[str, Any] = {
    "waypoint": MissionItem.WAYPOINT,
    "orbit": MissionItem.ORBIT,
    "takeoff": MissionItem.TAKEOFF,
    "land": MissionItem.LAND,
    "return": MissionItem.RETURN,
    "repeat": MissionItem.JUMP,
    "speed": MissionItem.SPEED,
}
"""Kinds of items that can be drawn, in the page's words."""
PLACED = (MissionItem.WAYPOINT, MissionItem.ORBIT, MissionItem.TAKEOFF, MissionItem.LAND)
"""Kinds that have a place."""
FIELDS = ("x", "y", "z", "radius", "turns", "hold", "speed", "acceptance_radius")
"""What can be set of an item by a number."""


def kind_name(item: MissionItem) -> str:
    """The page's word for an item's kind; that of the message for one that cannot be drawn here."""
    word = next((word for word, kind in KINDS.items() if kind == item.kind), "")
    known = item.kind in MissionItem.Kind.values()
    return word or (MissionItem.Kind.Name(item.kind).lower().replace("_", " ") if known else f"kind {item.kind}")


@dataclass
class PlanDraft:
    """Items of a mission in the making. ``edits`` rises with each change."""

    items: list[MissionItem] = field(default_factory=list)
    edits: int = 0
    touched: bool = False
    """Whether somebody has changed it since it was taken from the vehicle."""
    chosen: int = -1
    """The item whose fields are shown."""
    _differences: Remembered[int] = field(default_factory=Remembered)

    def take(self, mission: Mission | None) -> None:
        """Begins anew with what is in force on the vehicle."""
        self.items = [_copy(item) for item in mission.items][:MOST_ITEMS] if mission is not None else []
        self.touched, self.chosen = False, -1
        self.edits += 1

    def add(self, kind: str, place: tuple[float, float, float]) -> None:
        """Adds an item of a kind at a place [m, world], before the jump that closes the circuit."""
        if kind not in KINDS or len(self.items) >= MOST_ITEMS:
            return
        item = MissionItem(kind=KINDS[kind])
        if item.kind in PLACED:
            item.position.CopyFrom(Vector3(x=place[0], y=place[1], z=place[2]))
        if item.kind == MissionItem.JUMP:
            item.repeat = -1
        closed = bool(self.items) and self.items[-1].kind == MissionItem.JUMP
        self.chosen = len(self.items) - closed
        self.items.insert(self.chosen, item)
        self._changed()

    def set(self, index: int, name: str, value: float) -> None:
        """Sets a field of an item [SI units]."""
        if not self.has(index) or name not in FIELDS:
            return
        item = self.items[index]
        if name in ("x", "y", "z"):
            setattr(item.position, name, value)
        else:
            setattr(item, name, value)
        self._changed()

    def move(self, index: int, x: float, y: float) -> None:
        """Moves an item to x, y [m, world]."""
        if self.has(index) and self.items[index].kind in PLACED:
            self.items[index].position.x, self.items[index].position.y = x, y
            self._changed()

    def remove(self, index: int) -> None:
        """Takes an item out; jumps beyond it lead to the same items as before."""
        if self.has(index):
            del self.items[index]
            for item in self.items:
                if item.kind == MissionItem.JUMP and item.jump_to > index:
                    item.jump_to -= 1
            self.chosen = min(self.chosen, len(self.items) - 1)
            self._changed()

    def shift(self, index: int, by: int) -> None:
        """Exchanges an item with the one ``by`` places after it."""
        if self.has(index) and self.has(index + by):
            self.items[index], self.items[index + by] = self.items[index + by], self.items[index]
            self.chosen = index + by
            self._changed()

    def replace(self, items: Sequence[MissionItem]) -> None:
        """Takes other items in place of all."""
        self.items, self.chosen = [_copy(item) for item in items][:MOST_ITEMS], -1
        self._changed()

    def clear(self) -> None:
        """Takes all items out."""
        self.items.clear()
        self.chosen = -1
        self._changed()

    def has(self, index: int) -> bool:
        """Whether there is an item with this index."""
        return 0 <= index < len(self.items)

    def _changed(self) -> None:
        self.edits += 1
        self.touched = True

    def differences(self, mission: Mission | None) -> int:
        """How many items are not on the vehicle, or are other ones there."""
        return self._differences.of((self.edits, mission), lambda: self._count(mission))

    def _count(self, mission: Mission | None) -> int:
        there: Sequence[MissionItem] = mission.items if mission is not None else []
        changed = sum(not same(mine, theirs) for mine, theirs in zip(self.items, there, strict=False))
        return changed + abs(len(self.items) - len(there))


def same(a: MissionItem, b: MissionItem) -> bool:
    """Whether two items say the same, whatever wire items they came from."""
    moved = hypot(a.position.x - b.position.x, a.position.y - b.position.y, a.position.z - b.position.z) > NEAR
    return not moved and _bare(a) == _bare(b)


def _bare(item: MissionItem) -> MissionItem:
    bare = _copy(item)
    bare.ClearField("position")
    bare.ClearField("origin")
    return bare


def _copy(item: MissionItem) -> MissionItem:
    copied = MissionItem()
    copied.CopyFrom(item)
    return copied
