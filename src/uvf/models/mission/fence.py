"""A fence as people write it in a mission file, as a message, and as the region it stands for."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from schemas.limits import LENGTHS
from schemas.messages import Fence, FenceZone, Vector3
from uvf.maths.zones import Area, Disc, Overlap, Point, Polygon, Region
from uvf.models.yaml_data import BadInput

Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]
MOST_ZONES, MOST_VERTICES = LENGTHS["uvf.v1.Fence.zones"], LENGTHS["uvf.v1.FenceZone.vertices"]
"""Of a file, of MAVLink's items and of the message alike."""
ACTIONS = {"return": Fence.RETURN, "hold": Fence.HOLD, "warn": Fence.WARN, "land": Fence.LAND}


class ZoneFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A polygon (corners x, y) or a circle (x, y, radius), m, world; ``exclude``: keep out of it, instead of within."""

    polygon: list[tuple[Metres, Metres]] | None = None
    circle: tuple[Metres, Metres, Annotated[float, Meta(gt=0, le=1e6)]] | None = None
    exclude: bool = False


class FenceFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where a vehicle may be: within one of the zones that do not exclude, outside of all that do, between floor and ceiling."""

    zones: list[ZoneFile] = []
    floor: Metres | None = None  # m, world z, of an aircraft in flight
    ceiling: Metres | None = None  # m, world z
    action: Literal["return", "hold", "warn", "land"] = "return"


@dataclass(frozen=True)
class Fencing:
    """A fence to reckon with. m, world frame (ENU)."""

    region: Region
    floor: float
    ceiling: float
    action: Fence.Action
    return_point: tuple[float, float, float] | None = None
    """m, where action RETURN leads; None: to home or a rally point."""

    @property
    def steers(self) -> bool:
        """Whether it is more than told of."""
        return self.action != Fence.WARN

    @property
    def is_open(self) -> bool:
        """Nothing is kept out of."""
        return not (self.region.include or self.region.exclude) and self.floor == -inf and self.ceiling == inf


OPEN = Fencing(Region(), -inf, inf, Fence.WARN)


def fence_message(file: FenceFile, place: object) -> Fence:
    """Raises BadInput with ``place`` when it cannot be meant."""
    zones = []
    for i, zone in enumerate(file.zones):
        if (zone.polygon is None) == (zone.circle is None):
            raise BadInput(f"{place}: zones: {i}: a zone is a polygon or a circle, one of the two")
        zones.append(_zone_message(zone))
        zones[-1].group = 0 if zone.exclude else i
    message = Fence(zones=zones, floor=file.floor, ceiling=file.ceiling, action=ACTIONS[file.action])
    if why := fence_fault(message):
        raise BadInput(f"{place}: {why}")
    return message


def _zone_message(zone: ZoneFile) -> FenceZone:
    if zone.circle is not None:
        x, y, radius = zone.circle
        return FenceZone(centre=Vector3(x=x, y=y), radius=radius, excludes=zone.exclude)
    return FenceZone(vertices=[Vector3(x=x, y=y) for x, y in zone.polygon or ()], excludes=zone.exclude)


def fence_fault(message: Fence) -> str:
    """Why a fence makes no sense; empty if it does."""
    if len(message.zones) > MOST_ZONES:
        return f"{len(message.zones)} zones; {MOST_ZONES} are possible"
    for i, zone in enumerate(message.zones):
        if why := _zone_fault(zone):
            return f"zone {i}: {why}"
    if message.HasField("floor") and message.HasField("ceiling") and message.floor >= message.ceiling:
        return f"the floor, {message.floor:g} m, is not below the ceiling, {message.ceiling:g} m"
    if message.action not in Fence.Action.values():
        return f"there is no action {message.action}"
    return ""


def _zone_fault(zone: FenceZone) -> str:
    if not zone.vertices:
        return "" if zone.radius > 0 else "a circle of no size, or a polygon without corners"
    if not 3 <= len(zone.vertices) <= MOST_VERTICES:
        return f"a polygon of {len(zone.vertices)} corners; 3 to {MOST_VERTICES} are possible"
    crossing = Polygon(_corners(zone.vertices)).crossing
    return f"its edges from corners {crossing[0]} and {crossing[1]} cross each other" if crossing else ""


def fencing(message: Fence) -> Fencing:
    """Of a message without fault; one that is disabled keeps out of nothing."""
    if message.disabled:
        return OPEN
    groups: dict[int, list[Area]] = {}
    for zone in message.zones:
        if not zone.excludes:
            groups.setdefault(zone.group, []).append(_area(zone))
    include = tuple(areas[0] if len(areas) == 1 else Overlap(tuple(areas)) for areas in groups.values())
    exclude = tuple(_area(zone) for zone in message.zones if zone.excludes)
    floor = message.floor if message.HasField("floor") else -inf
    ceiling = message.ceiling if message.HasField("ceiling") else inf
    p = message.return_point
    back = (p.x, p.y, p.z) if message.HasField("return_point") else None
    return Fencing(Region(include, exclude), floor, ceiling, message.action, back)


def near_home(plan: Fencing, home: Point, distance: float) -> Fencing:
    """The same, and not farther than ``distance`` [m] from home; 0: however far."""
    if not distance:
        return plan
    disc, region = Disc(home, distance), plan.region
    include = tuple(Overlap((area, disc)) for area in region.include) or (disc,)
    return replace(plan, region=Region(include, region.exclude))


def _area(zone: FenceZone) -> Area:
    return Polygon(_corners(zone.vertices)) if zone.vertices else Disc((zone.centre.x, zone.centre.y), zone.radius)


def _corners(vertices: Sequence[Vector3]) -> list[Point]:
    return [(v.x, v.y) for v in vertices]
