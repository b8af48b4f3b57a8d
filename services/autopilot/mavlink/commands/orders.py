"""Commands beside the mode: take-off, speed, go-around, landing sequence, home, pictures, beginning anew."""

import math
from collections.abc import Sequence

from schemas.messages import (
    GoAroundRequest,
    HomeCommand,
    MissionItem,
    Mode,
    PictureCommand,
    RebootCommand,
    SpeedCommand,
    TakeoffCommand,
    VehicleCommandRequest,
)
from services.autopilot.mavlink.commands.actions import SOURCE, set_current, set_mode
from services.autopilot.mavlink.commands.places import BadPlace, altitude_of, frame_of, of_aircraft, place_in, place_of, refusing
from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from services.autopilot.mavlink.telemetry.navigation import global_origin
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.geo import HOME_FRAMES
from uvf.runtime.mavlink.mission_items import CRUISE, NO_CHANGE

RISE = 10.0  # m above where it is: an altitude below that is meant above home, not above sea level
SPEED_TYPES = {mav.SPEED_TYPE_AIRSPEED: False, mav.SPEED_TYPE_GROUNDSPEED: True}
RESTART = 1.0


def _takeoff(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Without an altitude to the autopilot's own height."""
    altitude, frame = command.p[6], _frame_of_takeoff(line, command)
    if math.isnan(altitude):
        set_mode(line, Mode.MODE_TAKEOFF, ack.outcome("Takeoff refused"))
        return
    z, here, home = altitude_of(line, frame, altitude), line.latest.position, line.latest.home
    if here is None or home is None:
        ack(mav.MAV_RESULT_TEMPORARILY_REJECTED, "Takeoff refused: own position or home is unknown")
    elif frame not in HOME_FRAMES and z < here[2] + RISE:
        above_sea = float(home[2]) + line.facts.origin.altitude
        ack(
            mav.MAV_RESULT_DENIED,
            f"Takeoff refused: the altitude is above sea level (home is at {above_sea:.0f} m), {altitude:g} m is too low",
        )
    else:
        line.ask("order", VehicleCommandRequest(takeoff=TakeoffCommand(altitude=z), source=SOURCE), ack.outcome("Takeoff refused"))


def _frame_of_takeoff(line: VehicleConnection, command: ReceivedCommand) -> int:
    """Of a COMMAND_LONG: PX4 takes its altitude from the sea; MAVSDK and MAVProxy give any other autopilot one above home."""
    generic = line.facts.generic and command.frame is None
    return int(mav.MAV_FRAME_GLOBAL_RELATIVE_ALT) if generic else frame_of(command)


def _change_speed(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Over ground for rovers whatever the type; -1 = no change, -2 = cruise."""
    kind, speed = command.p[0], command.p[1]
    over_ground = SPEED_TYPES.get(int(kind)) if math.isfinite(kind) else False
    if over_ground is None:
        ack(mav.MAV_RESULT_DENIED, f"Change of speed refused: there is no type {kind:g} here, 0 is airspeed, 1 ground speed")
    elif math.isnan(speed) or speed == NO_CHANGE:
        ack(mav.MAV_RESULT_ACCEPTED)
    elif speed <= 0 and speed != CRUISE:
        ack(mav.MAV_RESULT_DENIED, f"Change of speed refused: {speed:g} m/s is none")
    else:
        order = SpeedCommand(speed=0.0 if speed == CRUISE else speed, over_ground=over_ground or line.facts.is_ground)
        line.ask("order", VehicleCommandRequest(speed=order, source=SOURCE), ack.outcome("Change of speed refused"))


def _go_around(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """It climbs to the height of its approach circle; an altitude in parameter 1 does not count, as in PX4."""
    line.ask("go_around", GoAroundRequest(source=SOURCE), ack.outcome("Go-around refused"))


def _land_start(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Goes on with the mission where its landing begins: at DO_LAND_START, or else at the item that lands."""
    index = landing_begins(line.latest.mission.items if line.latest.mission is not None else ())
    if index is None:
        ack(mav.MAV_RESULT_DENIED, "Landing refused: the mission has none")
        return

    def jumped(accepted: bool, reason: str) -> None:
        if accepted:
            set_mode(line, Mode.MODE_MISSION, ack.outcome("Landing refused"))
        else:
            ack.outcome("Landing refused")(False, reason)

    set_current(line, index, jumped)


def landing_begins(plan: Sequence[MissionItem]) -> int | None:
    """Index of the item at which the landing begins; None without a landing."""
    kinds = [item.kind for item in plan]
    return next((kinds.index(kind) for kind in (MissionItem.LAND_START, MissionItem.LAND) if kind in kinds), None)


def _set_home(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Parameter 1 = 1: here. Without an altitude at the height of the home before."""
    done = ack.outcome("New home refused")
    if command.p[0] == 1.0:
        line.ask("order", VehicleCommandRequest(home=HomeCommand(), source=SOURCE), done)
        return
    if math.isnan(command.p[4]) or math.isnan(command.p[5]):
        ack(mav.MAV_RESULT_DENIED, "New home refused: latitude and longitude are needed")
        return
    place = place_in(line, command)
    if math.isnan(command.p[6]):
        place.z = float(line.latest.home[2]) if line.latest.home is not None else 0.0
    line.ask("order", VehicleCommandRequest(home=HomeCommand(position=place), source=SOURCE), done)


def on_set_home_position(line: VehicleConnection, m: mav.MAVLink_set_home_position_message) -> None:
    """Handles SET_HOME_POSITION, which has no answer but the next HOME_POSITION; a refusal is reported as STATUSTEXT."""
    done = line.refusal("New home")
    try:
        place = place_of(line, mav.MAV_FRAME_GLOBAL, (m.latitude * 1e-7, m.longitude * 1e-7), m.altitude * 1e-3)
    except BadPlace as bad:
        done(False, bad.reason)
        return
    line.ask("order", VehicleCommandRequest(home=HomeCommand(position=place), source=SOURCE), done)


def on_set_origin(line: VehicleConnection, m: mav.MAVLink_set_gps_global_origin_message, sender: Sender) -> None:
    """Handles SET_GPS_GLOBAL_ORIGIN: the origin is the world's, and is sent instead."""
    line.text(mav.MAV_SEVERITY_WARNING, "The origin is that of the world file and stays", sender.peer)
    if (origin := global_origin(line.facts, line.latest, line.t)) is not None:
        line.send(origin, sender.peer)


def _picture(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """DO_DIGICAM_CONTROL: parameter 5 = shoot. IMAGE_START_CAPTURE: parameter 3 = how many; one is possible."""
    wanted = command.p[4] if command.number == mav.MAV_CMD_DO_DIGICAM_CONTROL else command.p[2]
    if not _has_camera(line):
        ack(mav.MAV_RESULT_UNSUPPORTED, "Picture refused: there is no camera")
    elif wanted != 1.0:
        ack(mav.MAV_RESULT_DENIED, "Picture refused: one at a time, or by distance")
    else:
        line.ask("order", VehicleCommandRequest(picture=PictureCommand(), source=SOURCE), ack.outcome("Picture refused"))


def _pictures(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Parameter 1: m between pictures, 0 = no more."""
    distance = command.p[0]
    if not _has_camera(line):
        ack(mav.MAV_RESULT_UNSUPPORTED, "Pictures refused: there is no camera")
    elif not distance >= 0:
        ack(mav.MAV_RESULT_DENIED, "Pictures refused: the distance between them is none")
    else:
        line.ask("order", VehicleCommandRequest(picture=PictureCommand(distance=distance), source=SOURCE), ack.outcome("Pictures refused"))


def _has_camera(line: VehicleConnection) -> bool:
    sensors = line.facts.sensors
    return not line.facts.is_ground and (sensors.camera is not None or sensors.gimbal is not None)


def _reboot(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """The autopilot begins anew; the aircraft stays where it is, and so do the link and its clock."""
    if command.p[0] != RESTART:
        ack(mav.MAV_RESULT_UNSUPPORTED, "Reboot refused: parameter 1 = 1 starts the autopilot anew; nothing else can be switched off here")
        return
    line.ask("order", VehicleCommandRequest(reboot=RebootCommand(), source=SOURCE), ack.outcome("Reboot refused"))


def _terminate(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    ack(mav.MAV_RESULT_UNSUPPORTED, "Flight termination is not built in: disarming by force stops the motor, and the aircraft glides")


ORDERS: dict[int, Handler] = {
    mav.MAV_CMD_NAV_TAKEOFF: of_aircraft("Takeoff", refusing("Takeoff", _takeoff)),
    mav.MAV_CMD_DO_CHANGE_SPEED: _change_speed,
    mav.MAV_CMD_DO_GO_AROUND: of_aircraft("Go-around", _go_around),
    mav.MAV_CMD_DO_LAND_START: _land_start,
    mav.MAV_CMD_DO_SET_HOME: refusing("New home", _set_home),
    mav.MAV_CMD_DO_DIGICAM_CONTROL: _picture,
    mav.MAV_CMD_IMAGE_START_CAPTURE: _picture,
    mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST: _pictures,
    mav.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN: _reboot,
    mav.MAV_CMD_DO_FLIGHTTERMINATION: _terminate,
}
