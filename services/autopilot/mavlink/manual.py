"""MANUAL_CONTROL: the sticks as a velocity of a ground vehicle, or as the surfaces of an aircraft."""

from schemas.convert import stamp
from schemas.messages import DriveCommand, Mode, SurfaceCommand
from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.facts import Facts, Latest

FULL = 1000.0
NOT_THERE = 2**15 - 1
BY_HAND = (Mode.MODE_MANUAL, Mode.MODE_STABILIZED, Mode.MODE_ALTITUDE, Mode.MODE_POSITION)


def drive_command(message: mav.MAVLink_manual_control_message, facts: Facts, latest: Latest) -> DriveCommand | None:
    """Throttle stick forward = forward; either stick right = right turn. Only a vehicle in a mode flown or driven by hand listens.

    A ground station with a virtual joystick sends sticks at rest all the time; in the other modes they mean nothing.
    """
    body = facts.file.ground
    if body is None or not _listens(message, latest):
        return None
    turn = sum(axis for axis in (message.y, message.r) if axis != NOT_THERE)
    return DriveCommand(
        timestamp=stamp(latest.sim_time),
        linear=_part(message.z) * body.max_linear,
        angular=-_part(turn) * body.max_angular,
    )


def surface_command(message: mav.MAVLink_manual_control_message, facts: Facts, latest: Latest) -> SurfaceCommand | None:
    """x forward = nose down, y right = roll right, r right = yaw right, z 0..1000 = throttle; full stick = the vehicle's limits."""
    body = facts.file.air
    if body is None or not _listens(message, latest):
        return None
    limits = body.controls
    return SurfaceCommand(
        timestamp=stamp(latest.sim_time),
        aileron=_stick(message.y) * limits.aileron.limit,
        elevator=_stick(message.x) * limits.elevator.limit,
        rudder=-_stick(message.r) * limits.rudder.limit,
        throttle=max(_part(message.z), 0.0),
    )


def _listens(message: mav.MAVLink_manual_control_message, latest: Latest) -> bool:
    return latest.status is not None and latest.status.mode in BY_HAND and message.z != NOT_THERE


def _stick(axis: int) -> float:
    """-1..1; 0 for a stick that is not there."""
    return _part(axis) if axis != NOT_THERE else 0.0


def _part(axis: int) -> float:
    return min(max(axis / FULL, -1.0), 1.0)
