"""STOP ALL, as far as an autopilot elsewhere can be made to heed it: it holds, or disarms where it stands."""

import math

from schemas.messages import Event, Kind, Mode
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.requests import arm, hold
from uvf.runtime.state.stop_all import StopStatus

AGAIN_AFTER = 5.0  # s, after a refusal or no answer


class Stopping:
    """Makes an armed vehicle hold while STOP ALL is engaged, as often as that takes.

    Once it has held, whoever sets another mode there (a pilot with a transmitter) is let, and that is reported.
    """

    def __init__(self, autopilot: Autopilot) -> None:
        self._autopilot = autopilot
        self._begin()

    def _begin(self) -> None:
        self._due = -math.inf
        self._asking = self._accepted = self._holds = self._told = False

    def heed(self, stop: StopStatus) -> None:
        """One cycle with the present state of STOP ALL."""
        told = self._autopilot.told
        if not stop or self._autopilot.is_lost or not told.armed:
            if not self._asking:
                self._begin()
        elif not self._asking and not self._accepted and self._autopilot.wire.t >= self._due:
            self._asking = True
            if told.landed and told.kind != Kind.KIND_GROUND:
                arm(self._autopilot, False, False, self._after)
            else:
                hold(self._autopilot, self._after)
        elif self._accepted:
            self._watch()

    def _after(self, accepted: bool, reason: str) -> None:
        self._asking, self._accepted = False, accepted
        self._due = self._autopilot.wire.t + AGAIN_AFTER
        if accepted:
            self._autopilot.say(Event.NOTICE, "STOP ALL: the autopilot holds")
        elif not self._told:
            self._told = True
            self._autopilot.say(Event.CRITICAL, f"STOP ALL: the autopilot does not hold: {reason}; it is asked again")

    def _watch(self) -> None:
        told = self._autopilot.told
        held, self._holds = self._holds, told.mode == Mode.MODE_HOLD
        if held and not self._holds:
            name = told.modes.name_of(told.heartbeat.custom_mode)
            self._autopilot.say(Event.CRITICAL, f"STOP ALL is engaged, but somebody has taken the vehicle out of hold: mode {name}")
