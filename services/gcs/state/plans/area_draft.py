"""DrawnAreas that are being drawn for a vehicle: its fence, its rally points, and what it is to survey."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from schemas.messages import Fence, FenceZone, RallyPoints, Vector3
from services.gcs.state.remembered import Remembered
from uvf.models.mission.fence import ACTIONS, MOST_VERTICES, MOST_ZONES
from uvf.runtime.messages.plans.fences import fence_fault

Point = tuple[float, float]

PARTS = {"mission": "Mission", "fence": "Fence", "rally": "Rally", "survey": "Survey"}
"""What can be drawn in the tab Plan."""
RALLY_HEIGHT = 60.0  # m, world, of an aircraft's rally points where none tells another one
SIDELAP, FRONTLAP = 0.6, 0.75


@dataclass
class Ring:
    """Corners [m, world] of a zone; of a circle only its centre, with a ``radius`` [m]."""

    corners: list[Point] = field(default_factory=list)
    excludes: bool = False
    radius: float = 0.0
    group: int = 0


@dataclass
class AreaDraft:
    """Rings in the making; ``edits`` rises with each change."""

    rings: list[Ring] = field(default_factory=lambda: [Ring()])
    chosen: int = 0
    """The ring that gets the next corner."""
    edits: int = 0
    touched: bool = False
    """Whether somebody has changed it since it was taken from the vehicle."""

    def add(self, x: float, y: float) -> None:
        """Adds a corner [m, world] to the chosen ring; a circle is moved there."""
        if not 0 <= self.chosen < len(self.rings):
            return
        ring = self.rings[self.chosen]
        if ring.radius > 0.0:
            ring.corners = [(x, y)]
        elif len(ring.corners) < MOST_VERTICES:
            ring.corners.append((x, y))
        self.changed()

    def move(self, ring: int, index: int, x: float, y: float) -> None:
        """Moves a corner to x, y [m, world]."""
        if self._has(ring, index):
            self.rings[ring].corners[index] = (x, y)
            self.changed()

    def drop(self, ring: int, index: int) -> None:
        """Takes a corner out."""
        if self._has(ring, index):
            del self.rings[ring].corners[index]
            self.changed()

    def clear(self) -> None:
        """Takes all corners out."""
        self.rings, self.chosen = [Ring()], 0
        self.changed()

    def changed(self) -> None:
        """Notes a change."""
        self.edits += 1
        self.touched = True

    def _has(self, ring: int, index: int) -> bool:
        return 0 <= ring < len(self.rings) and 0 <= index < len(self.rings[ring].corners)


@dataclass
class FenceDraft(AreaDraft):
    """A fence in the making: zones, floor and ceiling [m, world], and what the vehicle does there."""

    rings: list[Ring] = field(default_factory=list)
    floor: float | None = None
    ceiling: float | None = None
    action: str = "return"
    _fault: Remembered[str] = field(default_factory=Remembered)

    @property
    def fault(self) -> str:
        """Why it makes no sense; empty if it does."""
        return self._fault.of((self.edits,), lambda: fence_fault(self.message()))

    def take(self, fence: Fence | None) -> None:
        """Begins anew with the fence in force."""
        there = fence if fence is not None else Fence()
        self.rings = [_ring(zone) for zone in there.zones]
        self.floor = there.floor if there.HasField("floor") else None
        self.ceiling = there.ceiling if there.HasField("ceiling") else None
        self.action = next((name for name, action in ACTIONS.items() if int(action) == int(there.action)), "return")
        self.chosen, self.touched = max(len(self.rings) - 1, 0), False
        self.edits += 1

    def begin(self, excludes: bool, radius: float = 0.0) -> None:
        """Begins another zone; with a radius [m] it is a circle."""
        if len(self.rings) < MOST_ZONES:
            self.rings.append(Ring(excludes=excludes, radius=radius))
            self.chosen = len(self.rings) - 1
            self.changed()

    def end(self, ring: int) -> None:
        """Takes a zone out."""
        if 0 <= ring < len(self.rings):
            del self.rings[ring]
            self.chosen = max(len(self.rings) - 1, 0)
            self.changed()

    def clear(self) -> None:
        """Takes all zones and limits away."""
        self.rings, self.floor, self.ceiling, self.chosen = [], None, None, 0
        self.changed()

    def message(self) -> Fence:
        """As it is sent."""
        return Fence(zones=[_zone(ring) for ring in self.rings], floor=self.floor, ceiling=self.ceiling, action=ACTIONS[self.action].name)


@dataclass
class RallyDraft(AreaDraft):
    """Rally points in the making, all at one height [m, world]."""

    height: float = RALLY_HEIGHT

    def take(self, rally: RallyPoints | None) -> None:
        """Begins anew with the points in force."""
        points: Sequence[Vector3] = rally.points if rally is not None else []
        self.rings = [Ring([(p.x, p.y) for p in points])]
        self.height = points[0].z if points else RALLY_HEIGHT
        self.touched = False
        self.edits += 1

    def message(self, flies: bool) -> RallyPoints:
        """As they are sent."""
        return RallyPoints(points=[Vector3(x=x, y=y, z=self.height if flies else 0.0) for x, y in self.rings[0].corners])


@dataclass
class SurveyDraft(AreaDraft):
    """A field to be surveyed, from a height [m] above its highest ground, with pictures that overlap by these shares."""

    height: float = RALLY_HEIGHT
    sidelap: float = SIDELAP
    frontlap: float = FRONTLAP
    making: bool = False
    """Whether a mission is being made of it."""
    fault: str = ""
    """Why none could be made of it."""


@dataclass
class DrawnAreas:
    """All that is drawn for one vehicle beside its mission."""

    fence: FenceDraft = field(default_factory=FenceDraft)
    rally: RallyDraft = field(default_factory=RallyDraft)
    survey: SurveyDraft = field(default_factory=SurveyDraft)

    def of(self, part: str) -> AreaDraft | None:
        """The one of a part of the tab Plan; None for the mission."""
        parts: dict[str, AreaDraft] = {"fence": self.fence, "rally": self.rally, "survey": self.survey}
        return parts.get(part)


def _ring(zone: FenceZone) -> Ring:
    if zone.vertices:
        return Ring([(v.x, v.y) for v in zone.vertices], zone.excludes, group=zone.group)
    return Ring([(zone.centre.x, zone.centre.y)], zone.excludes, zone.radius, zone.group)


def _zone(ring: Ring) -> FenceZone:
    if ring.radius > 0.0:
        x, y = ring.corners[0] if ring.corners else (0.0, 0.0)
        return FenceZone(centre=Vector3(x=x, y=y), radius=ring.radius, excludes=ring.excludes, group=ring.group)
    return FenceZone(vertices=[Vector3(x=x, y=y) for x, y in ring.corners], excludes=ring.excludes, group=ring.group)
