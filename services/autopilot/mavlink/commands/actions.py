"""Commands for arming, modes and the mission."""

import math

from schemas.messages import ArmRequest, Fence, FenceRequest, Mode, ModeRequest, SetCurrentRequest
from services.autopilot.mavlink.connection.asking import Done
from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from services.autopilot.mavlink.telemetry.telemetry import mission_current
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink import modes

SOURCE = "mavlink"
FORCE = (2989.0, 21196.0)  # magic numbers of param 2: force arm, force disarm
LAST_ITEM = 0xFFFE


def set_mode(line: VehicleConnection, mode: Mode, done: Done) -> None:
    """Requests a mode from the autopilot; ``done`` hears the answer."""
    row = modes.row_of(mode)
    line.latest.intended_custom_mode = row.custom if row else 0
    line.ask("set_mode", ModeRequest(mode=mode, source=SOURCE), done)


def set_current(line: VehicleConnection, index: int, done: Done) -> None:
    """Jumps to a mission item, and reports it at once: clients repeat the request until they see it."""

    def told(accepted: bool, reason: str) -> None:
        if accepted:
            line.send(mission_current(line.latest, index))
        done(accepted, reason)

    line.ask("set_current", SetCurrentRequest(index=index, source=SOURCE), told)


def on_set_mode(line: VehicleConnection, message: mav.MAVLink_set_mode_message, sender: Sender) -> None:
    """Handles SET_MODE, which has no answer but the next HEARTBEAT; a refusal is reported as STATUSTEXT."""
    row = modes.from_custom(message.custom_mode)
    if row is None:
        line.text(mav.MAV_SEVERITY_WARNING, modes.unknown(message.custom_mode, line.facts.is_ground), sender.peer)
        return
    set_mode(line, row.mode, line.refusal(f"Mode {row.name}"))


def _to_mode(mode: Mode) -> Handler:
    def handler(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
        row = modes.row_of(mode)
        set_mode(line, mode, ack.outcome(f"{row.name if row else mode} refused"))

    return handler


def _do_set_mode(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    row = modes.from_command(command.p[1], command.p[2])
    if row is None:
        ack(mav.MAV_RESULT_DENIED, f"There is no such mode. {modes.there_are(line.facts.is_ground)}")
        return
    set_mode(line, row.mode, ack.outcome(f"Mode {row.name} refused"))


def _arm(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    wanted = command.p[0]
    if wanted not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Arming: parameter 1 is 1 to arm or 0 to disarm")
        return
    request = ArmRequest(arm=wanted == 1.0, force=command.p[1] in FORCE, source=SOURCE)
    line.ask("arm", request, ack.outcome("Arming denied" if request.arm else "Disarming denied"))


def _do_set_standard_mode(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    wanted = command.p[0]
    row = modes.from_standard(int(wanted)) if math.isfinite(wanted) else None
    if row is None:
        ack(mav.MAV_RESULT_DENIED, f"There is no standard mode {wanted:g} here")
        return
    set_mode(line, row.mode, ack.outcome(f"Mode {row.name} refused"))


def _pause_continue(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    if command.p[0] not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Pause: parameter 1 is 0 to pause or 1 to continue")
        return
    mode = Mode.MODE_MISSION if command.p[0] == 1.0 else Mode.MODE_HOLD
    set_mode(line, mode, ack.outcome("Continue refused" if command.p[0] else "Pause refused"))


def _set_mission_current(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    if not 0 <= command.p[0] <= LAST_ITEM:
        ack(mav.MAV_RESULT_DENIED, "Set waypoint: an item number is needed")
        return
    set_current(line, int(command.p[0]), ack.outcome("Set waypoint refused"))


def _mission_start(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
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


ACTIONS: dict[int, Handler] = {
    mav.MAV_CMD_NAV_RETURN_TO_LAUNCH: _to_mode(Mode.MODE_RETURN),
    mav.MAV_CMD_NAV_LAND: _to_mode(Mode.MODE_LAND),
    mav.MAV_CMD_DO_SET_MODE: _do_set_mode,
    mav.MAV_CMD_DO_SET_STANDARD_MODE: _do_set_standard_mode,
    mav.MAV_CMD_DO_PAUSE_CONTINUE: _pause_continue,
    mav.MAV_CMD_DO_SET_MISSION_CURRENT: _set_mission_current,
    mav.MAV_CMD_MISSION_START: _mission_start,
    mav.MAV_CMD_COMPONENT_ARM_DISARM: _arm,
}


def _enable(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """The floor alone (2) is no switch of its own: it counts only above it, and not while it lands."""
    if command.p[0] not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Fence: parameter 1 is 1 to enable or 0 to disable")
        return
    fence = Fence()
    fence.CopyFrom(line.latest.fence or Fence())
    fence.disabled = command.p[0] == 0.0
    line.ask("set_fence", FenceRequest(fence=fence, source=SOURCE), ack.outcome("Fence refused"))


FENCE_SWITCH: dict[int, Handler] = {mav.MAV_CMD_DO_FENCE_ENABLE: _enable}
