"""What an aircraft is asked to do beside its mode: take off to a height, speed, altitude, home, pictures."""

import math
from dataclasses import replace

from schemas.messages import AltitudeCommand, HomeCommand, PictureCommand, SpeedCommand, TakeoffCommand, VehicleCommandRequest
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from uvf.estimation.state import Estimate
from uvf.guidance.fence_plan import place_fault
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import AirParams

LOWEST_TAKEOFF = 5.0  # m above home, as ``takeoff_alt``
PACED = (FlightMode.MISSION, FlightMode.HOLD, FlightMode.ORBIT, FlightMode.RETURN)
"""Modes whose speed is free."""


def carry_out(order: VehicleCommandRequest, mode_manager: ModeManager, now: Estimate, params: AirParams) -> str:
    """Why it is refused; empty if it is done. Restarting is the service's own."""
    kind = order.WhichOneof("kind")
    if kind == "takeoff":
        return _take_off(order.takeoff, order.source, mode_manager)
    if kind == "speed":
        return _speed(order.speed, mode_manager, now, params)
    if kind == "altitude":
        return _altitude(order.altitude, mode_manager, params)
    if kind == "home":
        return _home(order.home, mode_manager, now)
    return _picture(order.picture, mode_manager, now) if kind == "picture" else "there is nothing in this order"


def _take_off(order: TakeoffCommand, source: str, mode_manager: ModeManager) -> str:
    if mode_manager.home is None or not math.isfinite(order.altitude):
        return "the altitude is none" if mode_manager.home is not None else "home is unknown"
    if order.altitude < mode_manager.home.height + LOWEST_TAKEOFF:
        return f"{order.altitude - mode_manager.home.height:.1f} m above home is too low: {LOWEST_TAKEOFF:g} m at least"
    return mode_manager.take_off(order.altitude, source)


def _speed(order: SpeedCommand, mode_manager: ModeManager, now: Estimate, params: AirParams) -> str:
    if mode_manager.blocked:
        return mode_manager.blocked
    if mode_manager.mode not in PACED or mode_manager.goes_down:
        return f"the speed is not free now: it is in {', '.join(mode.value for mode in PACED)}, but for take-off and landing"
    if not math.isfinite(order.speed) or order.speed < 0:
        return "the speed is none"
    if why := mode_manager.speed_override.fault(now, order.speed, order.over_ground, params):
        return why
    mode_manager.speed_override.take(order.speed, order.over_ground)
    return ""


def _altitude(order: AltitudeCommand, mode_manager: ModeManager, params: AirParams) -> str:
    if mode_manager.blocked:
        return mode_manager.blocked
    circling = mode_manager.circling
    if circling is None:
        return f"in mode {mode_manager.mode.value} the height is not free: it is in Hold, Orbit and Return"
    if not order.altitude >= params.min_altitude or math.isinf(order.altitude):
        return f"{order.altitude:g} m is too low: {params.min_altitude:g} m at least"
    place = replace(circling.circle.centre, height=order.altitude)
    fence = mode_manager.fence.fencing
    if not fence.is_open and (why := place_fault(place, fence, params, abs(circling.circle.radius))):
        return why
    circling.circle = replace(circling.circle, centre=place)
    return ""


def _home(order: HomeCommand, mode_manager: ModeManager, now: Estimate) -> str:
    if mode_manager.home is None:
        return "home is unknown"
    if not order.HasField("position") and mode_manager.is_blind:
        return "GNSS is lost: wait until it is back"
    at = order.position
    place = Place(at.y, at.x, at.z) if order.HasField("position") else Place(now.north, now.east, mode_manager.home.height)
    if not all(map(math.isfinite, (place.north, place.east, place.height))):
        return "home is no place: its coordinates are not finite"
    mode_manager.settle(place)
    return ""


def _picture(order: PictureCommand, mode_manager: ModeManager, now: Estimate) -> str:
    if not order.HasField("distance"):
        mode_manager.shutter.obey(PlanItem(ItemKind.TRIGGER, Place(now.north, now.east, now.height)))
        return ""
    if not 0 <= order.distance < math.inf:
        return "the distance between pictures is none"
    mode_manager.shutter.obey(PlanItem(ItemKind.TRIGGER_DISTANCE, Place(now.north, now.east, now.height), distance=order.distance))
    return ""
