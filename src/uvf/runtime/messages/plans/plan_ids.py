"""Ids of plans: CRC-32 of what they say; 0 means an empty plan and no other."""

import zlib
from collections.abc import Sequence

from schemas.messages import Fence, MissionItem, RallyPoints


def mission_id(items: Sequence[MissionItem]) -> int:
    """Id of a mission's items."""
    crc = zlib.crc32(b"".join(item.SerializeToString(deterministic=True) for item in items))
    return (crc or 1) if items else 0


def fence_id(fence: Fence | None) -> int:
    """Id of a fence's zones and return point: floor, ceiling and action are parameters, no items."""
    if fence is None:
        return 0
    parts = [zone.SerializeToString(deterministic=True) for zone in fence.zones]
    parts += [fence.return_point.SerializeToString(deterministic=True)] if fence.HasField("return_point") else []
    return _id([*parts, *fence.origin])


def rally_id(rally: RallyPoints | None) -> int:
    """Id of the rally points."""
    if rally is None:
        return 0
    return _id([*(point.SerializeToString(deterministic=True) for point in rally.points), *rally.origin])


def _id(parts: list[bytes]) -> int:
    return (zlib.crc32(b"\n".join(parts)) or 1) if parts else 0
