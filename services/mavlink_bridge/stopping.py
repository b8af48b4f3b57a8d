"""STOP ALL, as far as an autopilot elsewhere can be made to heed it: it holds, or disarms where it stands."""

from schemas.messages import Event, Kind
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.requests import arm, hold
from uvf.runtime.stop_all import StopStatus


class Stopping:
    """Sent once when it is engaged, and again when the autopilot comes back into touch meanwhile."""

    def __init__(self, autopilot: Autopilot) -> None:
        self._autopilot = autopilot
        self._sent = False

    def heed(self, stop: StopStatus) -> None:
        if not stop or self._autopilot.is_lost:
            self._sent = False
        elif not self._sent:
            self._sent = True
            self._stop()

    def _stop(self) -> None:
        told = self._autopilot.told
        if not told.armed:
            return
        if told.landed and told.kind != Kind.KIND_GROUND:
            arm(self._autopilot, False, False, self._after)
        else:
            hold(self._autopilot, self._after)

    def _after(self, accepted: bool, reason: str) -> None:
        word = "STOP ALL: the autopilot holds" if accepted else f"STOP ALL: the autopilot does not hold: {reason}"
        self._autopilot.say(Event.NOTICE if accepted else Event.CRITICAL, word)
