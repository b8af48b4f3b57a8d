"""A fence: as people write it in a mission file, and as the region it stands for."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from math import inf
from typing import Annotated, Literal, NamedTuple

import msgspec
from msgspec import Meta

from uvf.maths.zones import Area, Disc, Overlap, Point, Polygon, Region
from uvf.models.keys import key, plain
from uvf.models.yaml_data import BadInput

Metres = Annotated[float, Meta(ge=-1e6, le=1e6)]
MOST_ZONES, MOST_VERTICES = 32, 128
"""Of a file, of MAVLink's items and of the message alike."""


class FenceAction(IntEnum):
    """What a vehicle does at its fence; numbered as in the message."""

    RETURN = 0
    HOLD = 1
    WARN = 2
    LAND = 3


ACTIONS = {"return": FenceAction.RETURN, "hold": FenceAction.HOLD, "warn": FenceAction.WARN, "land": FenceAction.LAND}


class ZoneFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A polygon (corners x, y) or a circle (x, y, radius), m, world; ``exclude``: keep out of it, instead of within."""

    polygon: Annotated[list[tuple[Metres, Metres]] | None, plain("Corners [x, y] in metres, world frame.")] = None
    circle: Annotated[
        tuple[Metres, Metres, Annotated[float, Meta(gt=0, le=1e6)]] | None, plain("Centre x, y and radius in metres, world frame.")
    ] = None
    exclude: Annotated[bool, plain("Keep out of the zone instead of within it.")] = False


class FenceFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where a vehicle may be: within one of the zones that do not exclude, outside of all that do, between floor and ceiling."""

    zones: Annotated[
        list[ZoneFile], plain("Up to 32 zones. The vehicle stays within one of those that do not exclude, and outside of all that do.")
    ] = []
    floor: Annotated[Metres | None, key("m", "Lowest height above the world's origin, of an aircraft in flight.")] = None
    ceiling: Annotated[Metres | None, key("m", "Largest height above the world's origin, of an aircraft.")] = None
    action: Annotated[Literal["return", "hold", "warn", "land"], plain("What the vehicle does at the fence.")] = "return"


class Zone(NamedTuple):
    """A polygon, or a circle where there are no vertices [m, world frame]. Zones of one group overlap, those of several add up."""

    vertices: Sequence[Point]
    centre: Point = (0.0, 0.0)
    radius: float = 0.0
    excludes: bool = False
    group: int = 0

    @property
    def area(self) -> Area:
        """The zone as an area of the plane."""
        return Polygon(list(self.vertices)) if self.vertices else Disc(self.centre, self.radius)


@dataclass(frozen=True)
class Fencing:
    """A fence in force: a region, and a floor and a ceiling [m], world frame (ENU)."""

    region: Region
    floor: float
    ceiling: float
    action: FenceAction
    return_point: tuple[float, float, float] | None = None
    """m, where action RETURN leads; None: to home or a rally point."""

    @property
    def steers(self) -> bool:
        """Whether the vehicle does anything at the fence but report it."""
        return self.action != FenceAction.WARN

    @property
    def is_open(self) -> bool:
        """Whether the fence bounds nothing."""
        return not (self.region.include or self.region.exclude) and self.floor == -inf and self.ceiling == inf


OPEN = Fencing(Region(), -inf, inf, FenceAction.WARN)


def zones_of(file: FenceFile, place: object) -> list[Zone]:
    """The zones of a fence file. Raises BadInput with ``place`` for a fence that makes no sense."""
    zones = []
    for i, zone in enumerate(file.zones):
        if (zone.polygon is None) == (zone.circle is None):
            raise BadInput(f"{place}: zones: {i}: a zone is a polygon or a circle, one of the two")
        x, y, radius = zone.circle or (0.0, 0.0, 0.0)
        zones.append(Zone(zone.polygon or (), (x, y), radius, zone.exclude, 0 if zone.exclude else i))
    if why := fence_fault(zones, file.floor, file.ceiling):
        raise BadInput(f"{place}: {why}")
    return zones


def fence_fault(zones: Sequence[Zone], floor: float | None, ceiling: float | None) -> str:
    """Why a fence makes no sense; empty if it does. floor, ceiling: heights [m], world z."""
    if len(zones) > MOST_ZONES:
        return f"{len(zones)} zones; {MOST_ZONES} are possible"
    for i, zone in enumerate(zones):
        if why := _zone_fault(zone):
            return f"zone {i}: {why}"
    if floor is not None and ceiling is not None and floor >= ceiling:
        return f"the floor, {floor:g} m, is not below the ceiling, {ceiling:g} m"
    return ""


def _zone_fault(zone: Zone) -> str:
    if not zone.vertices:
        return "" if zone.radius > 0 else "a circle of no size, or a polygon without corners"
    if not 3 <= len(zone.vertices) <= MOST_VERTICES:
        return f"a polygon of {len(zone.vertices)} corners; 3 to {MOST_VERTICES} are possible"
    crossing = Polygon(list(zone.vertices)).crossing
    return f"its edges from corners {crossing[0]} and {crossing[1]} cross each other" if crossing else ""


def region_of(zones: Sequence[Zone]) -> Region:
    """The region within one of the groups of zones that do not exclude, and outside of all zones that do."""
    groups: dict[int, list[Area]] = {}
    for zone in zones:
        if not zone.excludes:
            groups.setdefault(zone.group, []).append(zone.area)
    include = tuple(areas[0] if len(areas) == 1 else Overlap(tuple(areas)) for areas in groups.values())
    return Region(include, tuple(zone.area for zone in zones if zone.excludes))


def near_home(plan: Fencing, home: Point, distance: float) -> Fencing:
    """The same fence, also bounded to ``distance`` [m] from home (x, y) [m, world frame]; a distance of 0 adds no bound."""
    if not distance:
        return plan
    disc, region = Disc(home, distance), plan.region
    include = tuple(Overlap((area, disc)) for area in region.include) or (disc,)
    return replace(plan, region=Region(include, region.exclude))
