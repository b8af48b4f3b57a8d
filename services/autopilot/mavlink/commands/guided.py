"""Commands that send a vehicle somewhere: go to, circle, fly higher or lower; and "guided" mission items."""

import math

from schemas.messages import AltitudeCommand, GoalRequest, Mode, OrbitRequest, SpeedCommand, Vector3, VehicleCommandRequest
from services.autopilot.mavlink.commands.actions import SOURCE, set_mode
from services.autopilot.mavlink.commands.places import (
    BadPlace,
    altitude_of,
    check_radius,
    frame_of,
    of_aircraft,
    place_in,
    place_of,
    refusing,
)
from services.autopilot.mavlink.connection.asking import Done
from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import VehicleConnection
from uvf.mavlink import dialect as mav

CIRCLES = (Mode.MODE_HOLD, Mode.MODE_ORBIT, Mode.MODE_RETURN)
"""Modes whose circle can be flown higher or lower as it is."""
COUNTERCLOCKWISE = 1.0  # exactly: MAVSDK has a yaw in radians in this parameter


def _reposition(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """All of the place left out = hold here; only an altitude = fly higher or lower; a part left out = as now."""
    speed, _, radius, direction, latitude, longitude, height = command.p
    done = ack.outcome("Go to refused")
    special = speed > 0 or radius > 0 or direction == COUNTERCLOCKWISE
    if radius < 0:
        ack(mav.MAV_RESULT_DENIED, "Go to refused: the radius is negative; the direction is parameter 4")
    elif not _may_change(command) and not _is_guided(line):
        ack(mav.MAV_RESULT_DENIED, f"Go to refused: the mode is {_mode_name(line)}, and the command may not change it")
    elif all(map(math.isnan, (latitude, longitude, height))) and not special:
        set_mode(line, Mode.MODE_HOLD, ack.outcome("Hold refused"))
    elif math.isnan(latitude) and math.isnan(longitude) and not special:
        _only_higher(line, command, ack)
    elif line.facts.is_ground:
        _drive(line, place_in(line, command), speed, ack)
    else:
        turn = -1.0 if direction == COUNTERCLOCKWISE else 1.0
        ring = turn * (radius if radius > 0 else line.latest.own["hold_radius"] if turn < 0 else 0.0)
        place = place_in(line, command)
        check_radius(radius)
        _check_height(line, place, height)
        speed = max(speed, 0.0) if math.isfinite(speed) else 0.0
        go_to(line, GoalRequest(position=place, yaw=math.nan, source=SOURCE, radius=ring, speed=speed), True, done)


def _may_change(command: ReceivedCommand) -> bool:
    flags = command.p[1]
    return math.isfinite(flags) and bool(int(flags) & mav.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE)


def _is_guided(line: VehicleConnection) -> bool:
    """Whether the vehicle can be sent somewhere without another mode."""
    status = line.latest.status
    return status is not None and status.mode == (Mode.MODE_MISSION if line.facts.is_ground else Mode.MODE_HOLD)


def _mode_name(line: VehicleConnection) -> str:
    status = line.latest.status
    return Mode.Name(status.mode).removeprefix("MODE_").capitalize() if status is not None else "unknown"


def _check_height(line: VehicleConnection, place: Vector3, asked: float) -> None:
    """Lower than it goes, the autopilot would stay at its height: no answer to somebody who has named one."""
    lowest = line.latest.own.get("min_altitude", -math.inf)
    if not math.isnan(asked) and place.z < lowest:
        raise BadPlace(mav.MAV_RESULT_DENIED, f"too low: {lowest + line.facts.origin.altitude:.0f} m above sea level at least")


def _drive(line: VehicleConnection, place: Vector3, speed: float, ack: Acknowledger) -> None:
    """A rover's speed is set once it is on its way."""
    body, done = line.facts.file.ground, ack.outcome("Go to refused")
    if body is not None and speed > body.max_linear:
        ack(mav.MAV_RESULT_DENIED, f"Go to refused: {speed:g} m/s cannot be driven: up to {body.max_linear:g} m/s can")
        return

    def on_its_way(accepted: bool, reason: str) -> None:
        if accepted and speed > 0:
            line.ask("order", VehicleCommandRequest(speed=SpeedCommand(speed=speed, over_ground=True), source=SOURCE), done)
        else:
            done(accepted, reason)

    go_to(line, GoalRequest(position=place, yaw=math.nan, source=SOURCE), True, on_its_way)


def _only_higher(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """A circle keeps its place. From another mode it holds first. To a rover it means "stay here": so QGroundControl pauses it."""
    if line.facts.is_ground:
        set_mode(line, Mode.MODE_HOLD, ack.outcome("Hold refused"))
        return
    z, done = altitude_of(line, frame_of(command), command.p[6]), ack.outcome("Change of altitude refused")
    request = VehicleCommandRequest(altitude=AltitudeCommand(altitude=z), source=SOURCE)

    def circles(accepted: bool, reason: str) -> None:
        if accepted:
            line.ask("order", request, done)
        else:
            done(False, reason)

    if _circles(line):
        circles(True, "")
    else:
        set_mode(line, Mode.MODE_HOLD, lambda accepted, why: line.when(lambda: _circles(line), circles) if accepted else done(False, why))


def _circles(line: VehicleConnection) -> bool:
    status = line.latest.status
    return status is not None and status.mode in CIRCLES and status.HasField("circle")


def _change_altitude(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Parameter 2 is the frame of parameter 1; it changes no mode."""
    altitude, frame = command.p[0], command.p[1]
    if not math.isfinite(altitude):
        ack(mav.MAV_RESULT_DENIED, "Change of altitude refused: an altitude is needed")
        return
    z = altitude_of(line, int(frame) if math.isfinite(frame) else mav.MAV_FRAME_GLOBAL, altitude)
    line.ask("order", VehicleCommandRequest(altitude=AltitudeCommand(altitude=z), source=SOURCE), ack.outcome("Change of altitude refused"))


def _orbit(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """Left out: the vehicle's own radius and speed, the circle of now if it orbits, else here. For ever: a number of turns is refused."""
    radius, speed, _, turns, latitude, longitude, height = command.p
    if turns > 0 or speed < 0:
        ack(mav.MAV_RESULT_DENIED, "Orbit refused: " + ("turns are counted in missions only" if turns > 0 else "the speed is negative"))
        return
    check_radius(radius)
    place, status = place_in(line, command), line.latest.status
    if status is not None and status.mode == Mode.MODE_ORBIT and status.HasField("circle"):
        now = status.circle
        if math.isnan(latitude) and math.isnan(longitude):
            place.x, place.y = now.centre.x, now.centre.y
        place.z = now.centre.z if math.isnan(height) else place.z
        radius = now.radius if math.isnan(radius) else radius
    _check_height(line, place, height)
    ring, pace = (0.0 if math.isnan(v) else v for v in (radius, speed))
    line.ask("orbit", OrbitRequest(centre=place, radius=ring, speed=pace, source=SOURCE), ack.outcome("Orbit refused"))


def go_to(line: VehicleConnection, goal: GoalRequest, may_change_mode: bool, done: Done) -> None:
    """Requests a goal. A rover's planner drives in mode Mission only: it is set first, if allowed, and reset if there is no path."""
    before = line.latest.status.mode if line.latest.status is not None else Mode.MODE_MISSION

    def in_mission() -> bool:
        return line.latest.status is not None and line.latest.status.mode == Mode.MODE_MISSION

    def changed(accepted: bool, reason: str) -> None:
        if accepted:
            line.when(in_mission, drive)
        else:
            done(False, reason)

    def drive(accepted: bool, reason: str) -> None:
        if accepted:
            line.ask("goal", goal, driven)
        else:
            driven(False, reason)

    def driven(accepted: bool, reason: str) -> None:
        if not accepted:
            set_mode(line, before, lambda back, why: None)
        done(accepted, reason)

    if line.facts.is_ground and may_change_mode and not in_mission():
        set_mode(line, Mode.MODE_MISSION, changed)
    else:
        line.ask("goal", goal, done)


def goal_of_item(line: VehicleConnection, item: mav.MAVLink_mission_item_int_message, done: Done) -> None:
    """Goes to a "guided" item (current = 2) of Mission Planner and MAVProxy."""
    try:
        place = place_of(line, item.frame, (item.x * 1e-7, item.y * 1e-7), math.nan if line.facts.is_ground else item.z)
        _check_height(line, place, math.nan if line.facts.is_ground else item.z)
    except BadPlace as bad:
        done(False, bad.reason)
        return
    go_to(line, GoalRequest(position=place, yaw=math.nan, source=SOURCE), True, done)


GUIDED: dict[int, Handler] = {
    mav.MAV_CMD_DO_REPOSITION: refusing("Go to", _reposition),
    mav.MAV_CMD_DO_CHANGE_ALTITUDE: of_aircraft("Change of altitude", refusing("Change of altitude", _change_altitude)),
    mav.MAV_CMD_DO_ORBIT: of_aircraft("Orbit", refusing("Orbit", _orbit)),
}
