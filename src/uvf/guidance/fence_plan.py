"""Whether missions, goals and fences go together."""

from collections.abc import Sequence

from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.guidance.vector_field import turn_radius
from uvf.maths.zones import Point
from uvf.models.mission.fence import Fencing
from uvf.models.vehicle.flight_params import AirParams

PATH_ROOM = 4.0  # m beyond fence_margin: an aircraft is not on its path to the metre
WIDER = 1.2  # than the tightest circle, in wind


class CachedFenceCheck:
    """``mission_fault``, computed once per mission, fence and parameters, for callers that ask many times a second."""

    def __init__(self) -> None:
        self._of: tuple[object, ...] = ()
        self._fault = ""

    def mission_fault(self, items: Sequence[PlanItem], fencing: Fencing, params: AirParams) -> str:
        """Which item leaves the fence, and why; empty if none does."""
        of = items, fencing, params
        if len(self._of) != len(of) or any(one is not other for one, other in zip(self._of, of, strict=True)):
            self._of, self._fault = of, mission_fault(items, fencing, params)
        return self._fault


def mission_fault(items: Sequence[PlanItem], fencing: Fencing, params: AirParams) -> str:
    """Which item leaves the fence, and why; empty if none does.

    Jumps are not followed: their items are checked where they stand.
    """
    if fencing.is_open:
        return ""
    before: Point | None = None
    for i, item in enumerate(items):
        if item.kind not in (ItemKind.WAYPOINT, ItemKind.ORBIT):
            before = None if item.kind in (ItemKind.JUMP, ItemKind.RETURN) else before
            continue
        if why := place_fault(item.place, fencing, params, 0.0 if item.flies_through else abs(item.radius or params.hold_radius)):
            return f"item {i}: {why}"
        here = (item.place.east, item.place.north)
        if before is not None and (out := fencing.region.leaves(before, here, params.fence_margin + PATH_ROOM)) is not None:
            return f"item {i}: the way there comes too near to the fence at ({out[0]:.0f}, {out[1]:.0f})"
        before = here
    return ""


def place_fault(place: Place, fencing: Fencing, params: AirParams, radius: float) -> str:
    """Why a circle of ``radius`` [m] about this place does not lie within the fence; empty if it does."""
    room = fencing.region.at((place.east, place.north))
    where = f"({place.east:.0f}, {place.north:.0f})"
    if room < 0:
        return f"{where} is {-room:.0f} m outside of the fence"
    if room < (needed := radius + params.fence_margin + PATH_ROOM):
        return f"{where} is {room:.0f} m from the fence, {needed:.0f} m are needed" + (f" to circle at {radius:.0f} m" if radius else "")
    low, high = fencing.floor + params.fence_height, fencing.ceiling - params.fence_height
    if not low <= place.height <= high:
        return f"its height of {place.height:.0f} m is not within {low:.0f} to {high:.0f} m, {params.fence_height:g} m inside of the fence"
    return ""


def fence_fit(fencing: Fencing, here: Place | None, airborne: bool, params: AirParams) -> str:
    """Why this fence cannot be kept by an aircraft that is ``here``; empty if it can."""
    if here is not None and airborne and fencing.region.at((here.east, here.north)) < 0:
        return "the aircraft is outside of it"
    if here is not None and airborne and not fencing.floor <= here.height <= fencing.ceiling:
        return f"the aircraft is at {here.height:.0f} m, outside of it"
    if fencing.ceiling - fencing.floor < 3 * params.fence_height:
        return f"floor and ceiling are {fencing.ceiling - fencing.floor:.0f} m apart, {3 * params.fence_height:g} m are needed"
    if (p := fencing.return_point) is not None and (why := place_fault(Place(p[1], p[0], p[2]), fencing, params, params.hold_radius)):
        return f"its return point: {why}"
    near = (here.east, here.north) if here is not None else (0.0, 0.0)
    needed = tightest(params) + params.fence_margin
    room = fencing.region.roomiest(near, needed)[1]
    return f"there is no room to circle in it: {room:.0f} m from every edge, {needed:.0f} m are needed" if room < needed else ""


def tightest(params: AirParams) -> float:
    """Radius [m] of the tightest circle that the aircraft can be asked to hold."""
    return WIDER * turn_radius(params.trim_airspeed, params.turn_bank)
