"""What can be a place, a radius and a speed here, whoever names them: ground stations, programs and autopilots elsewhere."""

import math

from schemas.limits import PLACE
from schemas.messages import Vector3

HIGHEST = 1e5  # m, either way
LARGEST_RADIUS = PLACE
FASTEST = 200.0  # m/s, of a velocity that is asked for


def too_far(place: Vector3, from_where: str = "away from the field") -> str:
    """Why nobody is sent to a place (x, y, z) [m, world] so far away; empty if somebody may be."""
    away = math.hypot(place.x, place.y)
    return "" if away <= PLACE else f"that place is {away / 1e3:.4g} km {from_where}: name one within {PLACE / 1e3:g} km"


def too_high(place: Vector3) -> str:
    """Why nobody is sent to a place (x, y, z) [m, world] so high or low; empty if somebody may be."""
    return "" if abs(place.z) <= HIGHEST else f"that place is {place.z:.4g} m high: name one within {HIGHEST:g} m"


def far_off(place: Vector3) -> str:
    """Why no autopilot is sent to a place (x, y, z) [m, world]; empty if it may be."""
    return too_far(place, "from the world's origin") or too_high(place)


def too_wide(radius: float) -> str:
    """Why nothing circles with a radius [m], which may be negative; empty if it may."""
    return "" if abs(radius) <= LARGEST_RADIUS else f"a radius of {radius:.4g} m: name one within {LARGEST_RADIUS:g} m"
