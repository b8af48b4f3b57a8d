"""Listens at one address, names the autopilots that are heard there, and has a vehicle made for each."""

from collections.abc import Callable, Mapping, Sequence

from schemas import topics
from schemas.messages import Link
from schemas.topics import SYSTEM
from services.mavlink_bridge.station import Station
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle
from uvf.runtime.contract.service import Service

PATIENCE = 5.0  # s, after which it is said that nobody is there
HESITATION = 1.2  # s, after which this bus has told whether the new one is its own
Found = Callable[[str, int], None]
"""Called with the name and system id of a new vehicle."""
Say = Callable[[str], None]


class Names:
    """Names of the autopilots: by system id as asked for; the first other one takes the free name; the rest append their id to it."""

    def __init__(self, free: str, by_system: Mapping[int, str]) -> None:
        self.free, self._by_system = free, dict(by_system)
        self._taken: int | None = None

    @property
    def asked_for(self) -> list[str]:
        """The free name and all names given to ids."""
        return [self.free, *self._by_system.values()]

    @property
    def systems(self) -> frozenset[int]:
        """The system ids that have been given a name."""
        return frozenset(self._by_system)

    def of(self, system: int) -> str:
        """The name of a system."""
        if system in self._by_system:
            return self._by_system[system]
        if self._taken is None:
            self._taken = system
        return self.free if self._taken == system else f"{self.free}_{system}"


def names_from(texts: Sequence[str]) -> Names:
    """Parses ``NAME`` (at most one) and ``NAME=SYSTEM``. Raises BadInput."""
    free = ""
    by_system: dict[int, str] = {}
    for text in texts:
        name, equals, number = text.partition("=")
        _check(text, name, number if equals else None)
        if equals and int(number) in by_system:
            raise BadInput(f"--name {text}: system {number} is called {by_system[int(number)]} already")
        if name in (free, *by_system.values()):
            raise BadInput(f"--name {text}: two vehicles of one name")
        if equals:
            by_system[int(number)] = name
        elif free:
            raise BadInput(f"--name {text}: one name without a system id is enough ({free}); write {name}=SYSTEM")
        else:
            free = name
    return Names(free or "mav", by_system)


def _check(text: str, name: str, number: str | None) -> None:
    id_is_good = number is None or (number.isdecimal() and 0 < int(number) < 255)
    if not (name.isidentifier() and name.isascii()) or name == SYSTEM or not id_is_good:
        raise BadInput(f"--name {text}: write NAME, or NAME=SYSTEM with a MAVLink system id from 1 to 254, as in plane2=3")


class Discovery(Service):
    """Reads the address for all vehicles there, on wall time; it publishes nothing."""

    name = "mavlink_discovery"
    hz = 50.0
    scope = "world"
    clock = "wall"

    class Inputs(Reads):
        """The links of this bus's own vehicles."""

        links: dict[str, Link] = each_vehicle(topics.LINK)

    def __init__(self, station: Station, names: Names, found: Found, say: Say) -> None:
        self._station, self._names, self._found, self._say = station, names, found, say
        station.expected = names.systems
        self._known: set[int] = set()
        self._is_patient = True

    def step(self, t: float, now: Inputs) -> Writes:
        """One cycle at ``t`` [s]: wall time since the start. A vehicle of this bus that speaks to the address, too, is ignored."""
        own = {link.port for link in now.links.values()}
        for line in self._station.poll(t, own):
            self._say(line)
        new = {system: one for system, one in self._station.autopilots.items() if system not in self._known}
        for system in [system for system, one in new.items() if one.peer[1] in own]:
            self._station.forget(system)
            new.pop(system)
        for system in [system for system, one in new.items() if t - one.since >= HESITATION]:
            self._known.add(system)
            self._found(self._names.of(system), system)
        if self._is_patient and not self._known and t > PATIENCE:
            self._is_patient = False
            self._say(f"no autopilot heard for {PATIENCE:g} s; listening on")
        return self.Outputs()

    def close(self) -> None:
        """Closes the link."""
        self._station.close()
