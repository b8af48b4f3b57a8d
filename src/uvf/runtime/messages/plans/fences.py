"""Fences as messages: from mission files, and as the region that a message stands for."""

from math import inf

from schemas.messages import Fence, FenceZone, Vector3
from uvf.models.mission import fence as fences
from uvf.models.mission.fence import ACTIONS, OPEN, FenceAction, FenceFile, Fencing, Zone, region_of, zones_of


def fence_message(file: FenceFile, place: object) -> Fence:
    """Message of a fence file. Raises BadInput with ``place`` when the fence makes no sense."""
    zones = [_zone_message(zone) for zone in zones_of(file, place)]
    return Fence(zones=zones, floor=file.floor, ceiling=file.ceiling, action=ACTIONS[file.action].name)


def _zone_message(zone: Zone) -> FenceZone:
    if zone.vertices:
        return FenceZone(vertices=[Vector3(x=x, y=y) for x, y in zone.vertices], excludes=zone.excludes, group=zone.group)
    x, y = zone.centre
    return FenceZone(centre=Vector3(x=x, y=y), radius=zone.radius, excludes=zone.excludes, group=zone.group)


def fence_fault(message: Fence) -> str:
    """Why a fence makes no sense; empty if it does."""
    floor = message.floor if message.HasField("floor") else None
    ceiling = message.ceiling if message.HasField("ceiling") else None
    if why := fences.fence_fault(_zones(message), floor, ceiling):
        return why
    return "" if message.action in Fence.Action.values() else f"there is no action {message.action}"


def fencing(message: Fence) -> Fencing:
    """Fence of a message without fault; one that is disabled keeps out of nothing."""
    if message.disabled:
        return OPEN
    floor = message.floor if message.HasField("floor") else -inf
    ceiling = message.ceiling if message.HasField("ceiling") else inf
    p = message.return_point
    back = (p.x, p.y, p.z) if message.HasField("return_point") else None
    return Fencing(region_of(_zones(message)), floor, ceiling, FenceAction(message.action), back)


def _zones(message: Fence) -> list[Zone]:
    return [
        Zone([(v.x, v.y) for v in zone.vertices], (zone.centre.x, zone.centre.y), zone.radius, zone.excludes, zone.group)
        for zone in message.zones
    ]
