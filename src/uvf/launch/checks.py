"""``uvf check``: the wiring of a mission, before anything is started."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import yaml

from schemas.topics import CLOCK, SYSTEM, Topic
from uvf.launch import catalogue, settings
from uvf.launch.scores import check_criteria
from uvf.runtime.bus import matches
from uvf.runtime.site import ROOT, Host, load_site


def check_mission(mission: str) -> list[str]:
    """The problems found, a line each. Raises BadInput for a file that cannot be read."""
    site = load_site(settings.mission_path(mission))
    check_criteria(site)
    hosts = catalogue.hosts(site, catalogue.needed(site))
    return [*_writers(hosts), *_inputs(hosts), *_rates(hosts), *compose_problems(ROOT / "docker-compose.yml")]


def _owners(host: Host, topic: Topic[Any]) -> Sequence[str]:
    if not topic.per_vehicle:
        return (SYSTEM,)
    return (host.vehicle,) if host.vehicle else host.writes_for


def _writers(hosts: Sequence[Host]) -> Iterator[str]:
    """One writer per key."""
    writers: defaultdict[str, list[str]] = defaultdict(list)
    for host in hosts:
        for topic in host.service.outputs.values():
            for owner in _owners(host, topic):
                writers[topic.at(owner)].append(host.service.name)
    for key, names in sorted(writers.items()):
        if len(names) > 1:
            yield f"{key}: written by {' and '.join(sorted(names))}; one topic has one writer"


def _inputs(hosts: Sequence[Host]) -> Iterator[str]:
    """Every required input has a writer."""
    written = {topic.at(o) for h in hosts for topic in h.service.outputs.values() for o in _owners(h, topic)}
    written.add(CLOCK.at(SYSTEM))
    for host in hosts:
        for name, declared in host.service.declared_inputs().items():
            owner = host.vehicle or SYSTEM
            key = declared.topic.at("*" if declared.each_vehicle else (host.roles or {}).get(declared.role or "", owner))
            if declared.required and not any(matches(key, w) or matches(w, key) for w in written):
                yield f"{host.service.name}: input '{name}' ({key}) is written by nobody"


def _rates(hosts: Sequence[Host]) -> Iterator[str]:
    """Steps fall on the clock's ticks, so that lockstep over the bus is the same as in one process."""
    for service in {h.service for h in hosts if h.service.clock == "sim"}:
        if Fraction(CLOCK.hz) % Fraction(service.hz).limit_denominator(1000) != 0:
            yield f"{service.name}: {service.hz:g} Hz does not divide the clock's {CLOCK.hz:g} Hz"


def compose_problems(path: Path) -> Iterator[str]:
    """The stanzas of the compose file are the services."""
    if not path.exists():
        return
    stanzas = set(yaml.safe_load(path.read_text())["services"])
    wanted = {k.name for k in catalogue.KINDS} | set(catalogue.INFRASTRUCTURE)
    for name in sorted(wanted - stanzas):
        yield f"{path.name}: no stanza for {name}"
    for name in sorted(stanzas - wanted):
        yield f"{path.name}: stanza {name} is no service"
