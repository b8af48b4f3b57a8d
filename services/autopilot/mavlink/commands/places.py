"""Places and altitudes that messages name: frames, parts that are left out, and what is no place here."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from schemas.messages import Vector3
from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import VehicleConnection
from uvf.mavlink import dialect as mav
from uvf.mavlink.names import bad_frame
from uvf.runtime.mavlink.geo import AMSL_FRAMES, HOME_FRAMES
from uvf.runtime.mavlink.limits import HIGHEST, too_far, too_wide


@dataclass
class BadPlace(Exception):
    """A position that is refused: the MAV_RESULT and the reason in words."""

    result: int
    reason: str


def altitude_of(line: VehicleConnection, frame: int, altitude: float) -> float:
    """Height z [m, world] of an ``altitude`` [m] in one of MAVLink's frames; NaN stays NaN. Raises BadPlace."""
    if frame not in AMSL_FRAMES + HOME_FRAMES:
        raise BadPlace(mav.MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME, bad_frame(frame))
    if abs(altitude) > HIGHEST:
        raise BadPlace(mav.MAV_RESULT_DENIED, f"an altitude of {altitude:.4g} m: name one within {HIGHEST:g} m")
    home = line.latest.home
    if frame in HOME_FRAMES and home is None:
        raise BadPlace(mav.MAV_RESULT_TEMPORARILY_REJECTED, "home is unknown")
    return altitude - line.facts.origin.altitude if frame in AMSL_FRAMES or home is None else altitude + float(home[2])


def place_of(line: VehicleConnection, frame: int, degrees: tuple[float, float], altitude: float) -> Vector3:
    """World position [m] of ``degrees`` (latitude, longitude) and ``altitude`` [m]; what is NaN stays as it is now.

    The altitude is in MAVLink's ``frame``. Raises BadPlace.
    """
    here = line.latest.position
    if here is None:
        raise BadPlace(mav.MAV_RESULT_TEMPORARILY_REJECTED, "own position is unknown")
    z = altitude_of(line, frame, altitude)
    now = line.facts.geodetic(here)
    latitude, longitude = (own if math.isnan(asked) else asked for own, asked in zip(now[:2], degrees, strict=True))
    if abs(latitude) > 90 or abs(longitude) > 180:
        raise BadPlace(mav.MAV_RESULT_DENIED, "latitude or longitude is out of range")
    place = line.facts.world(latitude, longitude, 0.0)
    if reason := too_far(place):
        raise BadPlace(mav.MAV_RESULT_DENIED, reason)
    place.z = float(here[2]) if math.isnan(z) else z
    return place


def place_in(line: VehicleConnection, command: ReceivedCommand) -> Vector3:
    """World position (x, y, z) [m] of a command's parameters 5 to 7; COMMAND_LONG has altitudes above sea level. Raises BadPlace."""
    return place_of(line, frame_of(command), (command.p[4], command.p[5]), command.p[6])


def check_radius(radius: float) -> None:
    """Raises BadPlace for a ``radius`` [m] that is too large; NaN = left out."""
    if not math.isnan(radius) and (reason := too_wide(radius)):
        raise BadPlace(mav.MAV_RESULT_DENIED, reason)


def frame_of(command: ReceivedCommand) -> int:
    """The MAV_FRAME of a command's position; a COMMAND_LONG is global."""
    return int(mav.MAV_FRAME_GLOBAL) if command.frame is None else command.frame


def refusing(what: str, handler: Callable[[VehicleConnection, ReceivedCommand, Acknowledger], None]) -> Handler:
    """Wraps a handler so that its BadPlace becomes the acknowledgement."""

    def handle(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        try:
            handler(line, command, ack)
        except BadPlace as bad:
            ack(bad.result, f"{what} refused: {bad.reason}")

    return handle


def of_aircraft(what: str, handler: Handler) -> Handler:
    """Wraps a handler so that a ground vehicle answers UNSUPPORTED."""

    def handle(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        if line.facts.is_ground:
            ack(mav.MAV_RESULT_UNSUPPORTED, f"{what} refused: a ground vehicle has none")
        else:
            handler(line, command, ack)

    return handle
