"""Modes flown by hand: whose surface commands are passed on to the servos, and what follows when nobody sends any."""

import math
from collections.abc import Mapping
from dataclasses import astuple, replace

from schemas.messages import SurfaceCommand
from services.autopilot.air.setpoints import ManualCommand
from services.autopilot.multiplexing import Multiplexer, in_turn
from uvf.control.commands import Surfaces
from uvf.control.cycle import clip
from uvf.runtime.messages.convert import seconds

SOURCES = ("teleop", "mavlink", "client")
"""The first one whose command is fresh wins."""
CLOCK_TOLERANCE = 0.02  # s, one tick: a sender's clock may be that much ahead
PATIENCE = 0.5  # s that the first command is waited for once the mode is Manual


class ManualSources(Multiplexer):
    """Of all senders, by their keys."""

    def __init__(self) -> None:
        super().__init__("commands by hand", in_turn(SOURCES))
        self._said: dict[str, SurfaceCommand] = {}

    def choose(self, t: float, said: Mapping[str, SurfaceCommand | None], longest: float) -> ManualCommand | None:
        """The command that counts at ``t`` [s]; None without one of the last ``longest`` [s], whose input may be stale by then.

        One with a number that is not finite is none.
        """
        self._said |= {source: m for source, m in said.items() if m is not None}
        fresh: dict[str, ManualCommand] = {}
        for source, m in self._said.items():
            if -CLOCK_TOLERANCE <= t - seconds(m.timestamp) <= longest:
                asked = Surfaces(m.aileron, m.elevator, m.rudder, m.throttle, m.flap, m.brake, m.brake_difference)
                if all(map(math.isfinite, astuple(asked))):
                    fresh[source] = ManualCommand(source, _within(asked))
        return fresh.get(self.pick(fresh))


def _within(s: Surfaces) -> Surfaces:
    """Throttle and brake within 0..1, the flap not above its wing; how far a surface goes is the servos' own limit."""
    throttle, brake = (min(max(lever, 0.0), 1.0) for lever in (s.throttle, s.brake))
    return replace(s, throttle=throttle, flap=max(s.flap, 0.0), brake=brake, brake_difference=clip(s.brake_difference, 1.0))


class ManualControlState:
    """Whether somebody flies by hand."""

    def __init__(self) -> None:
        self._held = False
        self._left = PATIENCE

    def take(self) -> None:
        """Mode Manual begins: somebody is about to speak."""
        self._left = PATIENCE

    def hold(self, hand: ManualCommand | None, dt: float) -> None:
        """Takes what is asked for by hand in this cycle of ``dt`` [s]; None = nothing."""
        self._held = hand is not None
        self._left = 0.0 if self._held else self._left - dt

    @property
    def abandoned(self) -> bool:
        """Whether nobody flies by hand: the last command has gone stale, or none came within ``PATIENCE`` [s]."""
        return not self._held and self._left <= 0.0
