"""Which events are said aloud: those that are new, and that no message of MAVLink's own tells."""

import math
import re
from collections.abc import Sequence

from schemas.messages import Event
from services.autopilot.mavlink.connection.facts import VehicleState
from uvf.runtime.messages.convert import seconds

NEWS = 5.0  # s of simulation time: what happened while this link was starting again is still news
MOST_HELD = 50
TOLD_OTHERWISE = re.compile(r"mission item \d+ reached|camera trigger \d+")
"""MISSION_ITEM_REACHED tells of the one, a survey has hundreds of the other."""


class EventNews:
    """Selects the events to report: the bus hands old events to whoever comes later, and a restarted link must not repeat them."""

    def __init__(self) -> None:
        self._since: float | None = None
        """Older ones [s, simulation] are no news; None until the time is known."""
        self._held: list[Event] = []

    def of(self, latest: VehicleState, events: Sequence[Event]) -> list[Event]:
        """The new ones of these events, and of those that came before the time was known."""
        events = [*self._held, *events][-MOST_HELD:]
        if latest.clock is None and latest.nav is None and latest.status is None:
            self._held = events
            return []
        self._held = []
        now = latest.sim_time
        if self._since is None:
            self._since = now - NEWS
        elif now < self._since:
            self._since = -math.inf  # the simulation has begun anew
        return [event for event in events if seconds(event.timestamp) >= self._since and not TOLD_OTHERWISE.match(event.text)]
