"""A moment of the past as one browser looks at it: the model as it was then, which may run on."""

from collections.abc import Iterable

from google.protobuf.message import Message

from schemas.messages import Clock, Event, ExternalVehicle, FrameTransforms, NavState, SimObjects
from services.gcs.state.event_log import EventHistory
from services.gcs.state.history import OBJECTS, WINDSOCKS, Floats, Kept, Key, RecentHistory
from services.gcs.state.state import Model
from uvf.models.scenario import Scenario

EXTERNAL, TRUTH = "external", "truth"
"""Kinds of the history that are not kept under the name of a vehicle's field."""


class PastModel:
    """The state of the ground station at a moment of its history."""

    def __init__(self, site: Scenario, history: RecentHistory) -> None:
        self.model = Model(site)
        self._history = history
        self._shown: dict[Key, Kept] = {}
        self._t = float("inf")
        """Of the moment that the model is at [s, wall]."""
        self._gone: dict[str, int] = {}
        """How many points of each vehicle's way are in its track."""

    def go_to(self, t: float) -> None:
        """Brings the model to ``t`` [s, wall]; back to what was not yet heard then, too."""
        found = self._history.at(t)
        if t < self._t:
            self._forget(found)
        self._t = t
        new = [kept for key, kept in found.items() if self._shown.get(key) is not kept]
        self._shown = dict(found)
        self._draw_ways(t)
        self._hear(new)
        self.model.wall = t
        self._tell(t)

    def _forget(self, found: Iterable[Key]) -> None:
        known = set(found)
        for v in self.model.vehicles.values():
            v.track.clear()
            for what in list(v.heard_at):
                if (what, v.name) not in known:
                    setattr(v, what, None)
                    del v.heard_at[what]
            if "scan" not in v.heard_at:
                v.scan_points = None
            v.other_scans.clear()
        self._shown.clear()
        self._gone.clear()

    def _hear(self, new: list[Kept]) -> None:
        """Poses before the scans that were taken from them."""
        made = [(kept, kept.message) for kept in sorted(new, key=lambda kept: kept.key[0] == "scan")]
        for kept, message in made:
            what, name = kept.key
            if isinstance(message, Clock):
                self.model.clock = None  # another epoch is no new start here
                self.model.hear_clock(kept.t, message)
            elif what == WINDSOCKS and isinstance(message, FrameTransforms):
                self.model.hear_windsocks(message)
            elif isinstance(message, ExternalVehicle):
                self.model.hear_external_vehicles(kept.t, {name: message})
            elif not isinstance(message, SimObjects):
                self.model.hear(kept.t, what, {name: message})
        self._hear_objects(made)

    def _hear_objects(self, made: list[tuple[Kept, Message]]) -> None:
        if not any(kept.key[0] in (OBJECTS, TRUTH) for kept, _ in made):
            return
        lists = [kept.message for key, kept in self._shown.items() if key[0] == OBJECTS]
        strangers = {key[1]: kept.message for key, kept in self._shown.items() if key[0] == TRUTH and key[1] not in self.model.vehicles}
        self.model.hear_objects(
            [one for one in lists if isinstance(one, SimObjects)],
            {name: state for name, state in strangers.items() if isinstance(state, NavState)},
        )

    def _tell(self, t: float) -> None:
        log = self.model.log = EventHistory()
        for at, line in self._history.lines(t):
            log.write(line)
            if line.severity >= Event.WARNING:
                log.tell(at, line)

    def _draw_ways(self, t: float) -> None:
        for v in self.model.vehicles.values():
            way: list[Floats] = self._history.way(v.name, t)
            begun = self._gone.get(v.name, 0)
            if begun > len(way):  # the oldest have been forgotten meanwhile
                v.track.clear()
                begun = 0
            for position in way[begun:]:
                v.track.add(position)
            self._gone[v.name] = len(way)
