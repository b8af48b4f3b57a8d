"""Missions as messages, the same for every kind of vehicle: from a mission file."""

from schemas.messages import MissionItem, Vector3
from uvf.models.mission.file import Waypoint


def item_from_file(waypoint: Waypoint) -> MissionItem:
    """The mission item of a waypoint in a mission file."""
    return MissionItem(
        kind=waypoint.kind.upper(),
        position=Vector3(x=waypoint.x, y=waypoint.y, z=waypoint.z),
        acceptance_radius=waypoint.acceptance_radius,
        hold=waypoint.hold,
        radius=waypoint.radius,
        turns=waypoint.turns,
        speed=waypoint.speed,
        jump_to=waypoint.jump_to,
        repeat=waypoint.repeat,
        course=waypoint.course,
        to_altitude=waypoint.to_altitude,
        distance=waypoint.distance,
    )
