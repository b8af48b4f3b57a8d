"""Whether a mission can be flown by this aircraft, and what of it is flown otherwise than it is drawn.

Refused is what no way over ground can mend: circles tighter than the largest bank, speeds that it does not have. Legs too short for
their corners, corners too sharp to be rounded and courses that point the wrong way are flown all the same, with a longer way round.
"""

import itertools
import math
from collections.abc import Iterator, Sequence

from uvf.guidance import corners
from uvf.guidance.approach import approach_fault
from uvf.guidance.flight_plan import NO_JUMPS, ItemKind, NextItem, PlanItem, following
from uvf.guidance.route import Curve, Leg
from uvf.guidance.route_planning import RoutePlanner
from uvf.guidance.vector_field import turn_radius
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams


def fault(items: Sequence[PlanItem], params: AirParams) -> str:
    """Why a mission cannot be flown: which item, what, and how to mend it; empty if it can."""
    speeds = _speeds(items, params)
    faults = (_fault(item, len(items), speeds[i], params) or _landing_fault(items, i, params) for i, item in enumerate(items))
    return next((f"item {i} {why}" for i, why in enumerate(faults) if why), "")


def _fault(item: PlanItem, count: int, speed: float, params: AirParams) -> str:
    if params.law == "airship" and item.kind in (ItemKind.TAKEOFF, ItemKind.LAND):
        return f"is a {item.kind.name.lower()}: an airship does neither by itself; let it begin in the air, and leave this out"
    if item.kind is ItemKind.JUMP and item.jump_to >= count:
        return f"jumps to {item.jump_to}, but there are {count} items"
    if item.kind is ItemKind.SPEED and item.speed != 0 and not params.min_airspeed <= item.speed <= params.max_airspeed:
        return f"sets a speed of {item.speed:g} m/s; this aircraft flies {params.min_airspeed:g} to {params.max_airspeed:g} m/s"
    if item.kind is ItemKind.WAYPOINT and item.hold > 0 and item.course is not None:
        return "has a hold time and a course: it is circled, in every direction; leave one of both out"
    tightest = turn_radius(speed, params.bank_limit)
    if (item.kind is ItemKind.ORBIT or item.hold > 0) and 0 < abs(item.radius) < tightest:
        most = math.sqrt(abs(item.radius) * GRAVITY * math.tan(params.bank_limit))
        mend = f"or at most {most:.1f} m/s" if most >= params.min_airspeed else "(0 = the aircraft's own)"
        return f"is a circle of {abs(item.radius):g} m, too tight at {speed:g} m/s: give at least {math.ceil(tightest)} m {mend}"
    return ""


def _landing_fault(items: Sequence[PlanItem], index: int, params: AirParams) -> str:
    return approach_fault(items, index, params) if items[index].kind is ItemKind.LAND else ""


def _speeds(items: Sequence[PlanItem], params: AirParams) -> list[float]:
    """m/s through the air at each item, as far as it stands before it."""
    cruise = params.trim_airspeed
    sets = ((item.speed or cruise) if item.kind is ItemKind.SPEED else None for item in items)
    told = itertools.accumulate(sets, lambda v, told: v if told is None else told, initial=cruise)
    return [speed for _, speed in zip(items, told, strict=False)]


def advice(items: Sequence[PlanItem], params: AirParams) -> Iterator[tuple[str, str]]:
    """(what, why) for each waypoint that is not rounded by a corner of its own, and each slope that is too steep, in calm air."""
    speeds, stops = _speeds(items, params), [NextItem(i, NO_JUMPS, 0, None) for i in range(len(items))]
    for stop in stops:
        assert stop.index is not None
        item = items[stop.index]
        onward = following(items, stop) if item.flies_through else stop
        if onward.index is None or not items[onward.index].flies_through or item.course is not None:
            continue
        leg = Leg(item.place, items[onward.index].place)
        if why := _steep(leg, speeds[onward.index], params):
            yield f"item {onward.index}: its height is not reached on the way there", why
        planner = RoutePlanner(items, params, (0.0, 0.0), speeds[onward.index])
        exit_ = None if items[onward.index].course is not None else planner.with_exit(leg, onward).exit
        then = following(items, onward)
        if isinstance(exit_, Curve) and then.index is not None and items[then.index].course is None:
            yield (
                curve_text(onward.index),
                _why(leg, items[then.index], planner, items[onward.index]),
            )


def _steep(leg: Leg, speed: float, params: AirParams) -> str:
    """How a slope is steeper than the aircraft climbs or sinks; empty if it is not."""
    rate = (leg.end.height - leg.start.height) / max(leg.length, 1.0) * speed
    if -params.sink_max <= rate <= params.climb_max:
        return ""
    name, most = ("climb_max", params.climb_max) if rate > 0 else ("sink_max", params.sink_max)
    needed = abs(leg.end.height - leg.start.height) * speed / most
    return f"the slope is {abs(rate):.1f} m/s at {speed:g} m/s, {name} is {most:g} m/s: make the leg {math.ceil(needed)} m long, or slower"


def curve_text(index: int) -> str:
    """In words, that the waypoint ``index`` is not rounded by a corner of its own."""
    return f"item {index}: a curve is flown past it"


def _why(leg: Leg, then: PlanItem, planner: RoutePlanner, item: PlanItem) -> str:
    onto = Leg(leg.end, then.place)
    corner = corners.plan(leg.end.point, (leg.course, onto.course), planner.flying, (math.inf, math.inf))
    turn = f"a corner of {abs(math.degrees(math.remainder(onto.course - leg.course, math.tau))):.0f} degrees"
    if corner is None:
        return f"{turn} is too sharp to be rounded"
    if corner.cut(leg.end.point) > item.acceptance:
        return f"{turn} passes it at {corner.cut(leg.end.point):.0f} m; {item.acceptance:g} m are accepted"
    taken = f"{corner.before:.0f} and {corner.after:.0f} m"
    return f"{turn} takes {taken} of its legs at {planner.speed:g} m/s; they are {leg.length:.0f} and {onto.length:.0f} m"
