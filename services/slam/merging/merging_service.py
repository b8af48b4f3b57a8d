"""Sessions of vehicles that map -> one map of those that were at the same places, and where the map of each lies in it."""

from collections.abc import Iterable, Mapping

import numpy as np

from schemas import topics
from schemas.messages import Event, FrameTransform, Grid, MapSession
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import occupancy_grid, planar_frame, stamp
from uvf.slam.maps.session import MappingSession
from uvf.slam.maps.tiles import TileMap
from uvf.slam.merging.team import MapGroup, Team

PLACES = 4  # that are searched for in a step
RESOLUTION = 0.05  # m


class MergingService(Service):
    """Merges the vehicles' sessions, one a step; their relative start poses are unknown.

    The frame of a team is the map frame of its first vehicle, for which its map is published.
    """

    name = "merging"
    hz = 0.5
    scope = "world"

    class Inputs(Reads):
        """The vehicles' mapping sessions."""

        session: dict[str, MapSession] = each_vehicle(topics.MAP_SESSION)

    class Outputs(Writes):
        """Team maps, the place of each vehicle's map in them, and events."""

        map: dict[str, Grid] | None = topic(topics.TEAM_MAP)
        place: dict[str, FrameTransform] | None = topic(topics.TEAM_PLACE)
        events: dict[str, list[Event]] | None = topic(topics.EVENTS.by("merging"))

    def __init__(self) -> None:
        self._team = Team()
        self._taken: dict[str, MapSession] = {}
        self._told: dict[str, MapGroup] = {}
        self._maps: dict[str, TileMap] = {}

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: takes a new session, searches for common places, and publishes changed teams."""
        events = self._take(t, now.session)
        self._team.work(PLACES)
        teams = {group.names[0]: group for group in self._team.groups if len(group.names) > 1}
        news = [group for first, group in teams.items() if self._told.get(first) is not group]
        maps: dict[str, Grid] = {}
        places = {name: self._place(t, name, group.names[0]) for group in news for name in group.names}
        for group in news:
            told = events.setdefault(group.names[0], [])
            told += self._joined(t, group)
            try:
                maps |= self._map(t, group)
            except BadInput as error:
                told += [_event(t, Event.WARNING, "the map of the team cannot be drawn", str(error))]
        ended, alone = self._told.keys() - teams.keys(), _names(self._told.values()) - _names(teams.values())
        maps |= {first: _nothing(t, first) for first in ended if self._maps.pop(first, None)}
        places |= {name: self._place(t, name, name) for name in sorted(alone)}
        self._told = teams
        return self.Outputs(map=maps, place=places, events={name: told for name, told in events.items() if told})

    def _take(self, t: float, sessions: Mapping[str, MapSession]) -> dict[str, list[Event]]:
        """The session that has waited longest, if any is new."""
        new = [name for name, message in sessions.items() if self._taken.get(name) is not message]
        if not new:
            return {}
        name = min(new, key=lambda name: (name in self._taken, sessions[name].timestamp.ToNanoseconds(), name))
        self._taken[name] = sessions[name]
        try:
            self._team.follow(name, MappingSession.decoded(sessions[name].data, f"of {name}"))
        except BadInput as error:
            return {name: [_event(t, Event.WARNING, "the map cannot be put together with those of others", str(error))]}
        return {}

    def _map(self, t: float, group: MapGroup) -> dict[str, Grid]:
        """Of all keyframes, by its first vehicle; nothing where it would be as it was. Raises BadInput where it is too large."""
        first = group.names[0]
        tiles = self._maps.setdefault(first, TileMap(RESOLUTION))
        if not tiles.follow(self._team.session_of(group).keyframes):
            return {}
        cells, (x, y) = tiles.cells()
        return {first: occupancy_grid(cells, RESOLUTION, x, y, f"{first}/map", t)}

    def _joined(self, t: float, group: MapGroup) -> list[Event]:
        """Told where vehicles have come to it."""
        before = self._told.get(group.names[0])
        if before is not None and set(group.names) <= set(before.names):
            return []
        cause = f"{len(group.joint.crossings)} places fit; {group.quality:.0%} of what was seen twice is the same"
        return [_event(t, Event.INFO, f"the maps of {' and '.join(group.names)} are one", cause)]

    def _place(self, t: float, name: str, first: str) -> FrameTransform:
        return planar_frame(t, f"{first}/map", f"{name}/map", self._team.team_from_map(name))


def _names(groups: Iterable[MapGroup]) -> set[str]:
    return {name for group in groups for name in group.names}


def _nothing(t: float, first: str) -> Grid:
    """In the place of the map of a team that is no more."""
    return occupancy_grid(np.full((1, 1), -1, dtype=np.int8), RESOLUTION, 0.0, 0.0, f"{first}/map", t)


def _event(t: float, severity: Event.Severity, text: str, cause: str) -> Event:
    return Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source=MergingService.name)
