"""Commands that make the vehicle do something: arm, modes, go to, mission."""

import math

from schemas.convert import vector
from schemas.messages import ArmRequest, GoalRequest, Mode, ModeRequest, SetCurrentRequest
from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink import modes
from services.autopilot.mavlink.commands import Acknowledger, Command, Handler
from services.autopilot.mavlink.line import Done, Line
from services.autopilot.mavlink.telemetry import mission_current

SOURCE = "mavlink"
FORCE = (2989.0, 21196.0)  # magic numbers of param 2: force arm, force disarm
LAST_ITEM = 0xFFFE
HIGHEST = 1e5  # m
AMSL_FRAMES = (mav.MAV_FRAME_GLOBAL, mav.MAV_FRAME_GLOBAL_INT)
HOME_FRAMES = (mav.MAV_FRAME_GLOBAL_RELATIVE_ALT, mav.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT)


def set_mode(line: Line, mode: Mode, done: Done) -> None:
    row = modes.row_of(mode)
    line.latest.intended_custom_mode = row.custom if row else 0
    line.ask("set_mode", ModeRequest(mode=mode, source=SOURCE), done)


def set_current(line: Line, index: int, done: Done) -> None:
    """Jumps to a mission item, and says so at once: clients repeat the wish until they see it."""

    def told(accepted: bool, reason: str) -> None:
        if accepted:
            line.send(mission_current(line.latest, index))
        done(accepted, reason)

    line.ask("set_current", SetCurrentRequest(index=index, source=SOURCE), told)


def on_set_mode(line: Line, message: mav.MAVLink_set_mode_message) -> None:
    """SET_MODE has no answer but the next HEARTBEAT; a refusal is said in words."""
    row = modes.from_custom(message.custom_mode)
    if row is None:
        line.text(mav.MAV_SEVERITY_WARNING, f"There is no mode {message.custom_mode:#010x}")
        return

    def done(accepted: bool, reason: str) -> None:
        if not accepted:
            line.text(mav.MAV_SEVERITY_WARNING, f"Mode {row.name} refused: {reason or 'no reason given'}")

    set_mode(line, row.mode, done)


def _to_mode(mode: Mode) -> Handler:
    def handler(line: Line, command: Command, ack: Acknowledger) -> None:
        row = modes.row_of(mode)
        set_mode(line, mode, ack.outcome(f"{row.name if row else mode} refused"))

    return handler


def _do_set_mode(line: Line, command: Command, ack: Acknowledger) -> None:
    row = modes.from_command(command.p[1], command.p[2])
    if row is None:
        ack(mav.MAV_RESULT_DENIED, "There is no such mode")
        return
    set_mode(line, row.mode, ack.outcome(f"Mode {row.name} refused"))


def _arm(line: Line, command: Command, ack: Acknowledger) -> None:
    wanted = command.p[0]
    if wanted not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Arming: parameter 1 is 1 to arm or 0 to disarm")
        return
    request = ArmRequest(arm=wanted == 1.0, force=command.p[1] in FORCE, source=SOURCE)
    line.ask("arm", request, ack.outcome("Arming denied" if request.arm else "Disarming denied"))


def _takeoff(line: Line, command: Command, ack: Acknowledger) -> None:
    if math.isfinite(command.p[6]) and command.p[6] != 0:
        ack(mav.MAV_RESULT_DENIED, "Takeoff: an altitude of one's own is not supported; leave it out")
        return
    set_mode(line, Mode.MODE_TAKEOFF, ack.outcome("Takeoff refused"))


def _pause_continue(line: Line, command: Command, ack: Acknowledger) -> None:
    if command.p[0] not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Pause: parameter 1 is 0 to pause or 1 to continue")
        return
    mode = Mode.MODE_MISSION if command.p[0] == 1.0 else Mode.MODE_HOLD
    set_mode(line, mode, ack.outcome("Continue refused" if command.p[0] else "Pause refused"))


def _set_mission_current(line: Line, command: Command, ack: Acknowledger) -> None:
    if not 0 <= command.p[0] <= LAST_ITEM:
        ack(mav.MAV_RESULT_DENIED, "Set waypoint: an item number is needed")
        return
    set_current(line, int(command.p[0]), ack.outcome("Set waypoint refused"))


def _mission_start(line: Line, command: Command, ack: Acknowledger) -> None:
    """From item ``p1`` if that is given; the last item (``p2``) is always the mission's own."""
    first = command.p[0]

    def jumped(accepted: bool, reason: str) -> None:
        if accepted:
            set_mode(line, Mode.MODE_MISSION, ack.outcome("Mission refused"))
        else:
            ack(mav.MAV_RESULT_TEMPORARILY_REJECTED, f"Mission refused: {reason}")

    if 0 < first <= LAST_ITEM:
        set_current(line, int(first), jumped)
    else:
        jumped(True, "")


def _reposition(line: Line, command: Command, ack: Acknowledger) -> None:
    """All of the place left out = hold here; a part left out = as now. COMMAND_LONG has altitudes above sea level."""
    latitude, longitude, height = command.p[4:7]
    if all(math.isnan(v) for v in (latitude, longitude, height)):
        set_mode(line, Mode.MODE_HOLD, ack.outcome("Hold refused"))
        return
    here = line.latest.position
    frame = mav.MAV_FRAME_GLOBAL if command.frame is None else command.frame
    if frame not in AMSL_FRAMES + HOME_FRAMES:
        ack(mav.MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME, f"Go to: frame {frame} is not supported")
        return
    if here is None or line.latest.home is None:
        ack(mav.MAV_RESULT_TEMPORARILY_REJECTED, "Go to refused: own position or home is unknown")
        return
    if abs(latitude) > 90 or abs(longitude) > 180 or abs(height) > HIGHEST:
        ack(mav.MAV_RESULT_DENIED, "Go to: latitude, longitude or altitude is out of range")
        return
    now = line.facts.geodetic(here)
    if frame in HOME_FRAMES:
        height += line.facts.geodetic(line.latest.home)[2]
    place = [now[i] if math.isnan(v) else v for i, v in enumerate((latitude, longitude, height))]
    goal = GoalRequest(position=line.facts.world(*place), yaw=math.nan, source=SOURCE)
    may_change_mode = math.isfinite(command.p[1]) and int(command.p[1]) & mav.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
    _go_to(line, goal, bool(may_change_mode), ack.outcome("Go to refused"))


def _go_to(line: Line, goal: GoalRequest, may_change_mode: bool, done: Done) -> None:
    """A rover's planner drives in mode Mission only: changed to first, if that may be, and back if there is no way."""
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


def goal_of_item(line: Line, item: mav.MAVLink_mission_item_int_message, done: Done) -> None:
    """A "guided" item (current = 2) of Mission Planner and MAVProxy: go there; horizontal place from the item."""
    here = line.latest.position
    if here is None or abs(item.x) > 900_000_000 or abs(item.y) > 1_800_000_000 or abs(item.z) > HIGHEST:
        done(False, "own position unknown, or the place is out of range")
        return
    place = line.facts.world(item.x * 1e-7, item.y * 1e-7, 0.0)
    target = vector(here)
    target.x, target.y = place.x, place.y
    if not line.facts.is_ground and math.isfinite(item.z) and line.latest.home is not None:
        base = float(line.latest.home[2]) if item.frame in HOME_FRAMES else -line.facts.origin.altitude
        target.z = item.z + base
    _go_to(line, GoalRequest(position=target, yaw=math.nan, source=SOURCE), True, done)


ACTIONS: dict[int, Handler] = {
    mav.MAV_CMD_NAV_RETURN_TO_LAUNCH: _to_mode(Mode.MODE_RETURN),
    mav.MAV_CMD_NAV_LAND: _to_mode(Mode.MODE_LAND),
    mav.MAV_CMD_NAV_TAKEOFF: _takeoff,
    mav.MAV_CMD_DO_SET_MODE: _do_set_mode,
    mav.MAV_CMD_DO_REPOSITION: _reposition,
    mav.MAV_CMD_DO_PAUSE_CONTINUE: _pause_continue,
    mav.MAV_CMD_DO_SET_MISSION_CURRENT: _set_mission_current,
    mav.MAV_CMD_MISSION_START: _mission_start,
    mav.MAV_CMD_COMPONENT_ARM_DISARM: _arm,
}
