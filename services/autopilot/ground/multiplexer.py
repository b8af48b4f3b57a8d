"""Which of the many commands reaches the wheels: by mode, priority and age, with the reason."""

from collections.abc import Mapping
from dataclasses import dataclass

from schemas.messages import Mode

COMMAND_MAX_AGE = 0.5  # s

SOURCES: Mapping[int, tuple[str, ...]] = {
    Mode.MODE_MANUAL: ("teleop", "mavlink", "gcs", "client"),
    Mode.MODE_OFFBOARD: ("offboard", "client"),
    Mode.MODE_MISSION: ("planner",),
    Mode.MODE_RETURN: ("planner",),
    Mode.MODE_HOLD: (),
}
"""Modes of a ground vehicle and whose commands each lets through, the first that is fresh wins."""


@dataclass(frozen=True)
class Velocity:
    """A command as it came. t: when it was sent [s]; linear m/s, angular rad/s."""

    t: float
    linear: float
    angular: float


@dataclass(frozen=True)
class Choice:
    """What is let through: the source ("" = nobody, stand still), why, and the velocity."""

    source: str
    reason: str
    linear: float = 0.0
    angular: float = 0.0


def mode_name(mode: int) -> str:
    """``MISSION`` for ``MODE_MISSION``."""
    return Mode.Name(Mode.ValueType(mode)).removeprefix("MODE_")


def choose(t: float, mode: int, commands: Mapping[str, Velocity], obstacle: str) -> Choice:
    """The command that counts at ``t`` [s]. obstacle: why nothing may move (STOP ALL, disarmed), "" if it may."""
    if obstacle:
        return Choice("", obstacle)
    admitted = SOURCES[mode]
    if not admitted:
        return Choice("", f"mode {mode_name(mode)}")
    for source in admitted:
        command = commands.get(source)
        if command is not None and t - command.t <= COMMAND_MAX_AGE:
            return Choice(source, f"mode {mode_name(mode)}: {source}", command.linear, command.angular)
    return Choice("", f"mode {mode_name(mode)}: no fresh command from {', '.join(admitted)}")
