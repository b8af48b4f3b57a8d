"""Fence items on the wire and the fence in the system: polygons, circles, a return point."""

import math
from collections.abc import Sequence

from schemas.messages import Fence, FenceZone
from uvf.maths.zones import Polygon
from uvf.mavlink import dialect as mav
from uvf.mavlink.names import command_name
from uvf.models.mission.fence import MOST_VERTICES, MOST_ZONES
from uvf.runtime.mavlink.geo import GeoPosition
from uvf.runtime.mavlink.mission_items import BadItem, Body, packed, place_of, point_body, remembered_point, unpacked
from uvf.runtime.messages.convert import array

Item = mav.MAVLink_mission_item_int_message

POINT = mav.MAV_CMD_NAV_FENCE_RETURN_POINT
POLYGONS = {mav.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION: False, mav.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION: True}
CIRCLES = {mav.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION: False, mav.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION: True}
"""Commands, and whether they exclude."""
MOST_GROUP = 255


def checked(item: Item, facts: GeoPosition, home_z: float) -> Item:
    """The fence item, if it makes sense by itself. home_z: height of home [m, world]. Raises BadItem."""
    if item.command not in (POINT, *POLYGONS, *CIRCLES):
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is none of a fence")
    place_of(item, facts, home_z)
    if item.command in CIRCLES and not 0 < item.param1 <= 1e6:
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM1, f"radius {item.param1:g} is out of range")
    if item.command in POLYGONS and not 3 <= item.param1 <= MOST_VERTICES:
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM1, f"a polygon of {item.param1:g} corners; 3 to {MOST_VERTICES} are possible")
    if item.command != POINT and not (math.isnan(item.param2) or 0 <= item.param2 <= MOST_GROUP):
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM2, f"group {item.param2:g} is out of range")
    return item


def fence_of(items: Sequence[Item], base: Fence, facts: GeoPosition, home_z: float) -> Fence:
    """Fence of checked items, with floor, ceiling and action of ``base``, which are no items. home_z: height of home [m, world].

    Raises BadItem, which names the item.
    """
    fence = Fence(action=base.action, origin=[packed(item) for item in items])
    for limit in ("floor", "ceiling"):
        if base.HasField(limit):
            setattr(fence, limit, getattr(base, limit))
    at = 0
    while at < len(items):
        item = items[at]
        if item.command == POINT:
            fence.return_point.CopyFrom(place_of(item, facts, home_z))
        elif item.command in CIRCLES:
            zone = fence.zones.add(radius=item.param1, excludes=CIRCLES[item.command], group=_group(item))
            zone.centre.CopyFrom(place_of(item, facts, home_z))
        else:
            fence.zones.append(_polygon(at, items[at : at + int(item.param1)], facts, home_z))
        at += int(item.param1) if item.command in POLYGONS else 1
    if len(fence.zones) > MOST_ZONES:
        raise BadItem(mav.MAV_MISSION_NO_SPACE, f"{len(fence.zones)} zones; {MOST_ZONES} are possible")
    return fence


def _polygon(at: int, corners: Sequence[Item], facts: GeoPosition, home_z: float) -> FenceZone:
    """The polygon that begins with item ``at``."""
    first = corners[0]
    same = [(c.command, c.param1, _group(c)) == (first.command, first.param1, _group(first)) for c in corners]
    if len(corners) < first.param1 or not all(same):
        found = same.index(False) if False in same else len(corners)
        raise BadItem(mav.MAV_MISSION_INVALID, f"item {at}: a polygon of {first.param1:g} corners ends after {found}")
    places = [place_of(c, facts, home_z) for c in corners]
    if crossing := Polygon([(p.x, p.y) for p in places]).crossing:
        edges = f"{at + crossing[0]} and {at + crossing[1]}"
        raise BadItem(mav.MAV_MISSION_INVALID, f"item {at}: the polygon's edges from items {edges} cross each other")
    return FenceZone(vertices=places, excludes=POLYGONS[first.command], group=_group(first))


def _group(item: Item) -> int:
    return 0 if math.isnan(item.param2) else int(item.param2)


def bodies(fence: Fence, facts: GeoPosition, home_z: float) -> list[Body]:
    """Items of a fence: those that came over the wire, or those that a fence set elsewhere needs. home_z: height of home [m, world]."""
    if fence.origin:
        given = [unpacked(origin) for origin in fence.origin]
        return [remembered_point(body, fence.return_point, facts, home_z) if body[1] == POINT else body for body in given]
    found: list[Body] = []
    for zone in fence.zones:
        commands, first = (POLYGONS, len(zone.vertices)) if zone.vertices else (CIRCLES, zone.radius)
        command = next(number for number, excludes in commands.items() if excludes == zone.excludes)
        for point in zone.vertices or [zone.centre]:
            latitude, longitude, _ = facts.geodetic(array(point))
            head = (mav.MAV_FRAME_GLOBAL, command, 1, float(first), float(zone.group), 0.0, 0.0)
            found.append((*head, round(latitude * 1e7), round(longitude * 1e7), 0.0))
    if fence.HasField("return_point"):
        found.append(point_body(POINT, fence.return_point, facts, home_z))
    return found
