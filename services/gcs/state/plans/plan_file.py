"""Drawn plans as files, with the keys that a vehicle's job and fence have in a mission file."""

from typing import Annotated, Any

import msgspec
import yaml

from schemas.messages import MissionItem
from services.gcs.state.plans.area_draft import FenceDraft, RallyDraft, Ring
from services.gcs.state.plans.plan_draft import MOST_ITEMS
from uvf.models.mission.fence import MOST_VERTICES, FenceFile, ZoneFile, zones_of
from uvf.models.mission.file import Waypoint
from uvf.models.yaml_data import FileLocation, convert, parse_yaml
from uvf.runtime.messages.plans.mission_files import item_from_file

Metres = Annotated[float, msgspec.Meta(ge=-1e6, le=1e6)]
DECIMALS = 3
NUMBERS = ("acceptance_radius", "hold", "radius", "turns", "speed", "jump_to", "repeat", "distance")
PLACED = ("waypoint", "orbit", "takeoff", "land", "land_start", "set_home")


class PlanFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan as it is kept."""

    mission: Annotated[list[Waypoint], msgspec.Meta(max_length=MOST_ITEMS)] = []
    fence: FenceFile = FenceFile()
    rally: Annotated[list[tuple[Metres, Metres, Metres]], msgspec.Meta(max_length=MOST_VERTICES)] = []

    @property
    def items(self) -> list[MissionItem]:
        """The mission's items as they are drawn."""
        return [item_from_file(waypoint) for waypoint in self.mission]


def plan_text(items: list[MissionItem], fence: FenceDraft, rally: RallyDraft) -> str:
    """A plan as the text of its file."""
    zones = [_zone(ring) for ring in fence.rings if ring.corners]
    limits = {name: value for name, value in (("floor", fence.floor), ("ceiling", fence.ceiling)) if value is not None}
    data: dict[str, Any] = {"mission": [_row(item) for item in items]}
    if zones or limits:
        data["fence"] = {"zones": zones, **limits, "action": fence.action}
    if rally.rings[0].corners:
        data["rally"] = [[_round(x), _round(y), _round(rally.height)] for x, y in rally.rings[0].corners]
    return yaml.safe_dump(data, sort_keys=False, default_flow_style=None, width=120)


def read_plan(text: str, name: str) -> PlanFile:
    """The plan in the text of a file called ``name``. Raises BadInput."""
    file = convert(parse_yaml(text, name), PlanFile, name)
    zones_of(file.fence, FileLocation(name, ("fence",)))
    return file


def take_areas(file: PlanFile, fence: FenceDraft, rally: RallyDraft) -> None:
    """Draws the areas of a file in place of what is drawn."""
    fence.rings = [_ring(zone) for zone in file.fence.zones]
    fence.floor, fence.ceiling, fence.action = file.fence.floor, file.fence.ceiling, file.fence.action
    fence.chosen = max(len(fence.rings) - 1, 0)
    fence.changed()
    rally.rings = [Ring([(x, y) for x, y, _ in file.rally])]
    rally.height = file.rally[0][2] if file.rally else rally.height
    rally.changed()


def _row(item: MissionItem) -> dict[str, Any]:
    known = item.kind in MissionItem.Kind.values()
    kind = MissionItem.Kind.Name(item.kind).lower() if known else f"kind {item.kind}"
    row: dict[str, Any] = {} if kind == "waypoint" else {"kind": kind}
    if kind in PLACED:
        p = item.position
        row |= {"x": _round(p.x), "y": _round(p.y), "z": _round(p.z)}
    row |= {name: _round(getattr(item, name)) for name in NUMBERS if getattr(item, name)}
    row |= {"course": round(item.course, 5)} if item.HasField("course") else {}
    return row | ({"to_altitude": True} if item.to_altitude else {})


def _zone(ring: Ring) -> dict[str, Any]:
    corners = [[_round(x), _round(y)] for x, y in ring.corners]
    shape: dict[str, Any] = {"circle": [*corners[0], _round(ring.radius)]} if ring.radius > 0 else {"polygon": corners}
    return shape | ({"exclude": True} if ring.excludes else {})


def _ring(zone: ZoneFile) -> Ring:
    if zone.circle is not None:
        x, y, radius = zone.circle
        return Ring([(x, y)], zone.exclude, radius)
    return Ring(list(zone.polygon or ()), zone.exclude)


def _round(value: float) -> float:
    return round(value, DECIMALS) if isinstance(value, float) else value
