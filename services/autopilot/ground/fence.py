"""Keeps a ground vehicle within its fence: it stops before the edge, and may drive on in any direction that leads away from it."""

import math
from dataclasses import dataclass

from schemas.messages import MissionItem, RallyPoints, Vector3
from services.autopilot.ground.mission import DRIVABLE
from uvf.maths.kinematics import Twist
from uvf.models.mission.fence import Fencing

REACTION = 0.3  # s, until the wheels follow
MARGIN = 0.1  # m, kept from the edge beyond the vehicle's radius
NEARER = 1e-3  # m, that counts as coming nearer


@dataclass(frozen=True, slots=True)
class GroundPose:
    """Planar pose: x, y [m] and yaw [rad] in the world frame."""

    x: float
    y: float
    yaw: float


def stops(fencing: Fencing, here: GroundPose, velocity: Twist, keep: tuple[float, float]) -> bool:
    """Whether driving on at this velocity would end nearer to the fence's edge than allowed.

    keep: (radius of the vehicle [m], deceleration [m/s^2]).
    """
    speed = math.hypot(velocity.linear, velocity.lateral)
    if speed == 0.0 or not fencing.steers:
        return False
    radius, deceleration = keep
    lasts = REACTION + speed / (2 * deceleration)  # s, at this speed
    ahead, aside, c, s = velocity.linear * lasts, velocity.lateral * lasts, math.cos(here.yaw), math.sin(here.yaw)
    end = (here.x + ahead * c - aside * s, here.y + ahead * s + aside * c)
    room = fencing.region.at(end)
    return room < radius + MARGIN and room < fencing.region.at((here.x, here.y)) - NEARER


def refusal(items: list[MissionItem], fencing: Fencing, radius: float) -> str:
    """Which mission item lies outside the fence or too near to its edge for a vehicle of ``radius`` [m]; empty if none does."""
    for i, item in enumerate(items):
        if item.kind in DRIVABLE and item.kind != MissionItem.RETURN and (why := _fault(item.position, fencing, radius)):
            return f"item {i}: {why}"
    return ""


def rally_refusal(rally: RallyPoints, fencing: Fencing, radius: float) -> str:
    """Which rally point a vehicle of ``radius`` [m] cannot drive to within the fence; empty if it can reach all."""
    for i, point in enumerate(rally.points):
        if not (math.isfinite(point.x) and math.isfinite(point.y)):
            return f"item {i} holds a number that is not finite"
        if why := _fault(point, fencing, radius):
            return f"item {i}: {why}"
    return ""


def _fault(place: Vector3, fencing: Fencing, radius: float) -> str:
    room = fencing.region.at((place.x, place.y))
    if room >= radius + MARGIN:
        return ""
    far = f"{-room:.1f} m outside of the fence" if room < 0 else f"{room:.1f} m from the fence, too near"
    return f"({place.x:.1f}, {place.y:.1f}) is {far}"
