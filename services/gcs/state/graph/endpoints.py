"""Which services live, and what each declares to publish and to read: from the liveliness tokens of their processes."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

from schemas.topics import SYSTEM
from services.gcs.state.refusals import PageRefusals
from uvf.runtime.bus.interface import matches
from uvf.runtime.messages.spawned import name_fault
from uvf.runtime.messages.validation import is_text

MOST_SERVICES, MOST_ENDPOINTS, MOST_TOKENS = 128, 2000, 8000
LENGTH = 200  # letters of a key
SERVICE_NAME = re.compile(r"[a-z][a-z0-9_-]{0,39}")
WAYS = ("pub", "sub", "need")


class DeclaredEndpoint(NamedTuple):
    """A key that a service publishes (pub), reads (sub) or cannot do without (need); ``*`` stands for any vehicle or source."""

    way: str
    key: str
    type_name: str


@dataclass
class LivingService:
    """A service as its tokens tell of it; name: ``owner/service``."""

    name: str
    boot: int = 0
    """Which process it lives in."""
    endpoints: frozenset[DeclaredEndpoint] = frozenset()
    gone_at: float | None = None
    """When its tokens were seen to have vanished [s, wall]; None while it lives."""
    unseen: int = 0
    """Looks in a row that did not find it."""

    @property
    def owner(self) -> str:
        """Its vehicle, or ``sys``."""
        return self.name.partition("/")[0]

    @property
    def kind(self) -> str:
        """Its name without its owner."""
        return self.name.partition("/")[2]


@dataclass
class _Told:
    boot: int = 0
    endpoints: set[DeclaredEndpoint] = field(default_factory=set)


LOOKS = 2
"""In a row that must miss a service before it counts as gone: one may be lost on a busy machine."""


class ServiceBook:
    """All services that live or have lived."""

    def __init__(self, refused: PageRefusals) -> None:
        self.services: dict[str, LivingService] = {}
        self._refused = refused

    def hear(self, t: float, tokens: Sequence[str]) -> None:
        """Takes a list of all tokens that there are at ``t`` [s, wall]."""
        told = self._told(tokens)
        for name, one in told.items():
            known = self.services.get(name)
            if known is None:
                if not self._has_room():
                    self._refused.add("services", name, f"more than {MOST_SERVICES} services are on the bus: not all are shown")
                    continue
                known = self.services[name] = LivingService(name)
            known.boot, known.endpoints, known.gone_at, known.unseen = one.boot or known.boot, frozenset(one.endpoints), None, 0
        for name in self.services.keys() - told.keys():
            gone = self.services[name]
            gone.unseen += 1
            if gone.unseen >= LOOKS and gone.gone_at is None:
                gone.gone_at = t

    def _told(self, tokens: Sequence[str]) -> dict[str, _Told]:
        told: dict[str, _Told] = {}
        count = 0
        for token in tokens[:MOST_TOKENS]:
            name, boot, endpoint = parsed(token)
            if not name:
                self._refused.add("tokens", token, "a liveliness token on the bus is not understood and not shown")
                continue
            if name not in told and len(told) >= 2 * MOST_SERVICES:
                continue
            one = told.setdefault(name, _Told())
            one.boot = boot or one.boot
            if endpoint is not None and count < MOST_ENDPOINTS:
                one.endpoints.add(endpoint)
                count += 1
        return told

    def _has_room(self) -> bool:
        """A service that has gone makes room."""
        if len(self.services) >= MOST_SERVICES:
            oldest = min((s for s in self.services.values() if s.gone_at is not None), key=lambda s: s.gone_at or 0.0, default=None)
            if oldest is None:
                return False
            del self.services[oldest.name]
        return True


@lru_cache(4096)
def parsed(token: str) -> tuple[str, int, DeclaredEndpoint | None]:
    """(service, process, endpoint) that a token tells of; ("", 0, None) for one that is not understood."""
    match token.split("/") if len(token) <= 2 * LENGTH else []:
        case ["@node", owner, service, boot] if _is_service(owner, service) and re.fullmatch("[0-9a-f]{1,16}", boot):
            return f"{owner}/{service}", int(boot, 16), None
        case ["@ep", owner, service, way, where, type_name] if _is_service(owner, service) and way in WAYS and is_text(where, LENGTH):
            endpoint = DeclaredEndpoint(way, where.replace("%", "/").replace("+", "*"), type_name[:80])
            return (f"{owner}/{service}", 0, endpoint) if is_text(type_name) else ("", 0, None)
    return "", 0, None


def _is_service(owner: str, service: str) -> bool:
    return (owner == SYSTEM or not name_fault(owner)) and SERVICE_NAME.fullmatch(service) is not None


class EndpointIndex:
    """Finds the endpoints that match a key; those with ``*`` by the number of their parts and the last of these."""

    def __init__(self, services: Iterable[LivingService]) -> None:
        self._exact: dict[str, list[tuple[LivingService, DeclaredEndpoint]]] = {}
        self._wide: dict[tuple[int, str], list[tuple[LivingService, DeclaredEndpoint]]] = {}
        for service in services:
            for endpoint in sorted(service.endpoints):
                parts = endpoint.key.split("/")
                exact = self._exact.setdefault(endpoint.key, []) if "*" not in parts else None
                there = exact if exact is not None else self._wide.setdefault((len(parts), parts[-1]), [])
                there.append((service, endpoint))

    @property
    def named(self) -> Iterable[str]:
        """The keys that somebody names as they are, without ``*``."""
        return self._exact

    def at(self, key: str) -> list[tuple[LivingService, DeclaredEndpoint]]:
        """The services that write or read the key, with the endpoint by which they do."""
        parts = key.split("/")
        wide = (*self._wide.get((len(parts), parts[-1]), ()), *self._wide.get((len(parts), "*"), ()))
        return [*self._exact.get(key, ()), *(pair for pair in wide if matches(pair[1].key, key))]
