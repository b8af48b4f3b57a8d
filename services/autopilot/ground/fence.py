"""Keeps a ground vehicle within its fence: it stops before the edge, and may drive on in any direction that leads away from it."""

import math
from dataclasses import dataclass

from schemas.messages import MissionItem
from services.autopilot.ground.mission import DRIVABLE
from uvf.runtime.fence_file import Fencing

REACTION = 0.3  # s, until the wheels follow
MARGIN = 0.1  # m, kept from the edge beyond the vehicle's radius
NEARER = 1e-3  # m, that counts as coming nearer


@dataclass(frozen=True, slots=True)
class Place:
    """m, rad, world frame."""

    x: float
    y: float
    yaw: float


def stops(fencing: Fencing, here: Place, linear: float, keep: tuple[float, float]) -> bool:
    """Whether driving on at ``linear`` [m/s] would end nearer to the edge than allowed. keep: (radius [m], deceleration [m/s^2])."""
    if linear == 0.0 or not fencing.steers:
        return False
    radius, deceleration = keep
    way = math.copysign(abs(linear) * REACTION + linear**2 / (2 * deceleration), linear)
    end = (here.x + way * math.cos(here.yaw), here.y + way * math.sin(here.yaw))
    room = fencing.region.at(end)
    return room < radius + MARGIN and room < fencing.region.at((here.x, here.y)) - NEARER


def refusal(items: list[MissionItem], fencing: Fencing, radius: float) -> str:
    """Which item lies outside, or too near to the edge; empty if none does."""
    for i, item in enumerate(items):
        if item.kind in DRIVABLE and item.kind != MissionItem.RETURN:
            room = fencing.region.at((item.position.x, item.position.y))
            if room < radius + MARGIN:
                far = f"{-room:.1f} m outside of the fence" if room < 0 else f"{room:.1f} m from the fence, too near"
                return f"item {i}: ({item.position.x:.1f}, {item.position.y:.1f}) is {far}"
    return ""
