"""What a ground vehicle is asked to do beside its mode: speed and home."""

from math import isfinite

from schemas.messages import HomeCommand, SpeedCommand, VehicleCommandRequest
from services.autopilot.ground.mission import MissionEngine, Point
from uvf.models.vehicle.file import GroundBody


def carry_out(order: VehicleCommandRequest, engine: MissionEngine, here: Point | None, body: GroundBody) -> str:
    """Carries out an order, other than a reboot; returns why it is refused, "" if it is done. here: x, y [m, world]."""
    kind = order.WhichOneof("kind")
    if kind == "speed":
        return _speed(order.speed, engine, body)
    if kind == "home":
        return _home(order.home, engine, here)
    return f"a ground vehicle has no {kind}" if kind is not None else "there is nothing in this order"


def _speed(order: SpeedCommand, engine: MissionEngine, body: GroundBody) -> str:
    if not 0 <= order.speed <= body.max_linear:
        return f"{order.speed:g} m/s cannot be driven: up to {body.max_linear:g} m/s can"
    engine.speed = order.speed
    return ""


def _home(order: HomeCommand, engine: MissionEngine, here: Point | None) -> str:
    place = (order.position.x, order.position.y) if order.HasField("position") else here
    if place is None:
        return "its own position is unknown"
    if not all(map(isfinite, place)):
        return "home is no place: its coordinates are not finite"
    engine.home = place
    return ""
