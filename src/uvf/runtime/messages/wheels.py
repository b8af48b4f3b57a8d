"""Velocities, wheel speeds and counts as messages: of vehicles with two sides by side, of those that drive sideways wheel by wheel."""

from collections.abc import Sequence

from google.protobuf.timestamp_pb2 import Timestamp

from schemas.messages import DriveCommand, WheelCommand, WheelTicks
from uvf.maths.kinematics import Twist
from uvf.runtime.messages.convert import stamp

SIDES = 2


def drive_command(twist: Twist, timestamp: Timestamp | None = None) -> DriveCommand:
    """A velocity of the body as a message; without a timestamp who sends it stamps it."""
    return DriveCommand(timestamp=timestamp, linear=twist.linear, angular=twist.angular, lateral=twist.lateral)


def wheel_command(t: float, speeds: Sequence[float], steering: float = 0.0) -> WheelCommand:
    """Speeds [rad/s] and steering [rad] as a message stamped ``t`` [s]."""
    if len(speeds) == SIDES:
        return WheelCommand(timestamp=stamp(t), left=speeds[0], right=speeds[1], steering=steering)
    return WheelCommand(timestamp=stamp(t), each=speeds)


def speeds_of(command: WheelCommand) -> tuple[float, ...]:
    """Speeds [rad/s] of a message; as many as its sender has written."""
    return tuple(command.each) or (command.left, command.right)


def wheel_ticks(t: float, counts: Sequence[int], radians_per_tick: float) -> WheelTicks:
    """Counts since the start as a message stamped ``t`` [s]."""
    if len(counts) == SIDES:
        return WheelTicks(timestamp=stamp(t), left=counts[0], right=counts[1], radians_per_tick=radians_per_tick)
    return WheelTicks(timestamp=stamp(t), each=counts, radians_per_tick=radians_per_tick)


def counts_of(ticks: WheelTicks) -> tuple[int, ...]:
    """Counts of a message; as many as its sender has written."""
    return tuple(ticks.each) or (ticks.left, ticks.right)
