"""MANUAL_CONTROL of a ground vehicle: the sticks as a velocity."""

from schemas.convert import stamp
from schemas.messages import DriveCommand, Mode
from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.facts import Facts, Latest

FULL = 1000.0
NOT_THERE = 2**15 - 1


def drive_command(message: mav.MAVLink_manual_control_message, facts: Facts, latest: Latest) -> DriveCommand | None:
    """Throttle stick forward = forward; either stick right = right turn. Only a vehicle in manual mode listens.

    A ground station with a virtual joystick sends sticks at rest all the time; in the other modes they mean nothing.
    """
    body = facts.file.ground
    if body is None or latest.status is None or latest.status.mode != Mode.MODE_MANUAL or message.z == NOT_THERE:
        return None
    turn = sum(axis for axis in (message.y, message.r) if axis != NOT_THERE)
    return DriveCommand(
        timestamp=stamp(latest.sim_time),
        linear=_part(message.z) * body.max_linear,
        angular=-_part(turn) * body.max_angular,
    )


def _part(axis: int) -> float:
    return min(max(axis / FULL, -1.0), 1.0)
