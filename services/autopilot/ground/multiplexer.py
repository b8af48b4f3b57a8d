"""Which of the many commands reaches the wheels: by mode, priority and age, with the reason."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

from schemas.messages import Mode
from services.autopilot.multiplexing import OFFBOARD, Order, holder, in_turn
from uvf.maths.kinematics import Twist
from uvf.runtime.messages.convert import mode_name

COMMAND_MAX_AGE = 0.5  # s
STANDING = Twist(0.0, 0.0)
CLOCK_TOLERANCE = 0.02  # s, one tick: a sender's clock may be that much ahead

SOURCES: Mapping[int, tuple[str, ...]] = {
    Mode.MODE_MANUAL: ("teleop", "mavlink", "gcs", "client", "executive"),
    Mode.MODE_OFFBOARD: tuple(source for rank in OFFBOARD for source in rank),
    Mode.MODE_MISSION: ("planner",),
    Mode.MODE_RETURN: ("planner",),
    Mode.MODE_HOLD: (),
}
"""Modes of a ground vehicle and whose commands each lets through, the first that is fresh wins."""
RANKS: Mapping[int, Order] = {mode: in_turn(sources) for mode, sources in SOURCES.items()} | {Mode.MODE_OFFBOARD: OFFBOARD}
"""But in Offboard, where some are equals: of these the one that holds."""


@dataclass(frozen=True)
class VelocityCommand:
    """A received velocity command. t: when it was sent [s]; lasts: how long it is valid [s]."""

    t: float
    twist: Twist
    lasts: float = COMMAND_MAX_AGE

    def is_fresh(self, t: float) -> bool:
        """Whether it is valid at ``t`` [s]: neither too old nor from the future, where it would never grow old."""
        return -CLOCK_TOLERANCE <= t - self.t <= self.lasts

    @property
    def is_finite(self) -> bool:
        """Whether it is a velocity at all."""
        return all(map(isfinite, self.twist))


@dataclass(frozen=True)
class ActiveCommand:
    """The command that is let through: its source ("" = none, stand still), the reason, the velocity.

    refused: commands that were fresh and admitted but not finite, "" if there are none.
    """

    source: str
    reason: str
    twist: Twist = STANDING
    refused: str = ""


def choose(t: float, mode: int, commands: Mapping[str, VelocityCommand], obstacle: str, held: str = "") -> ActiveCommand:
    """The command in force at ``t`` [s].

    obstacle: why nothing may move (STOP ALL, disarmed), "" if it may; held: the source in force before.
    """
    if obstacle:
        return ActiveCommand("", obstacle)
    admitted = SOURCES[mode]
    if not admitted:
        return ActiveCommand("", f"mode {mode_name(mode)}")
    fresh = {source: commands[source] for source in admitted if source in commands and commands[source].is_fresh(t)}
    refused = ", ".join(f"{source} ({_in_words(c.twist)})" for source, c in fresh.items() if not c.is_finite)
    source = holder([source for source, command in fresh.items() if command.is_finite], RANKS[mode], held)
    if source:
        return ActiveCommand(source, f"mode {mode_name(mode)}: {source}", fresh[source].twist, refused)
    if refused:
        return ActiveCommand("", f"mode {mode_name(mode)}: not a velocity: {refused}", refused=refused)
    return ActiveCommand("", f"mode {mode_name(mode)}: no fresh command from {', '.join(admitted)}")


def _in_words(twist: Twist) -> str:
    aside = f", {twist.lateral:g} m/s sideways" if twist.lateral else ""
    return f"{twist.linear:g} m/s, {twist.angular:g} rad/s{aside}"
