"""``uvf check``: the wiring and the vehicles of a mission, before anything is started."""

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import yaml

from launch import catalogue, settings
from launch.scoring.scores import check_criteria
from launch.vehicles.mission_faults import mission_faults
from launch.worlds.check import hidden_markers
from schemas import topics
from schemas.topics import CLOCK, SYSTEM, Topic
from uvf.models.scenario import ROOT, MissionVehicle, Scenario, load_scenario
from uvf.models.yaml_data import BadInput, FileLocation, nearest
from uvf.runtime.bus.interface import matches
from uvf.runtime.contract.instances import ServiceInstance

SENSORS: dict[Topic[Any], str] = {
    topics.IMU: "imu",
    topics.SCAN: "lidar",
    topics.OTHER_SCANS: "other_lidars",
    topics.WHEELS: "encoders",
    topics.GNSS: "gnss",
    topics.SONAR: "sonars",
    topics.RANGE: "rangefinders",
    topics.AIR_DATA: "air_data",
    topics.IMAGE: "camera",
    topics.CAMERA_INFO: "camera",
    topics.VIEW.by("chase"): "chase",
    topics.VIEW.by("gimbal"): "gimbal",
    topics.GIMBAL_JOINTS: "gimbal",
}
"""What is written only about vehicles that carry the sensor."""


def check_mission(mission: str) -> list[str]:
    """The problems found in a mission, one line each. Raises BadInput for a file that is wrong in itself."""
    site = load_scenario(settings.mission_path(mission))
    check_criteria(site)
    hosts = catalogue.hosts(site, catalogue.needed(site))
    check_params(site, hosts)
    return [*wiring_problems(site, hosts), *mission_faults(site), *hidden_markers(site), *compose_problems(ROOT / "docker-compose.yml")]


def refuse_problems(site: Scenario, hosts: Sequence[ServiceInstance]) -> None:
    """Raises BadInput for the first problem that would make a run wait in vain."""
    check_params(site, hosts)
    for line in wiring_problems(site, hosts):
        raise BadInput(f"{site.mission_path}: {line}")


def check_params(site: Scenario, hosts: Sequence[ServiceInstance]) -> None:
    """Checks that every group of parameters in a vehicle's file belongs to a service that the vehicle has. Raises BadInput."""
    for member in site.members.values():
        services = {host.service.name for host in hosts if host.vehicle == member.name}
        for name in member.file.params:
            if name not in services:
                own = name in member.entry.params
                file, keys = (member.mission, ("vehicles", member.name)) if own else (str(member.folder / "vehicle.yaml"), ())
                place = FileLocation(file, (*keys, "params", name))
                raise BadInput(f"{place}: {member.name} has no service '{name}'; {nearest(name, services)}")


def wiring_problems(site: Scenario, hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """Yields wiring problems: one writer per key, every required input fed, every sensor simulated, steps on the clock's ticks."""
    yield from _names(hosts)
    yield from _writers(hosts)
    yield from _inputs(site, hosts)
    yield from _unread_sensors(site, hosts)
    yield from _rates(hosts)


def _owners(host: ServiceInstance, topic: Topic[Any]) -> Sequence[str]:
    if not topic.per_vehicle:
        return (SYSTEM,)
    return (host.vehicle,) if host.vehicle else host.writes_for


def _names(hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """No two services of a vehicle have one name: parameters, health and logs go by it."""
    count = Counter((host.vehicle or SYSTEM, host.service.name) for host in hosts)
    for (owner, name), times in sorted(count.items()):
        if times > 1:
            yield f"{owner}: {times} services are called '{name}'; rename one"


def _writers(hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """One writer per key."""
    writers: defaultdict[str, list[str]] = defaultdict(list)
    for host in hosts:
        for topic in host.service.outputs.values():
            for owner in _owners(host, topic):
                writers[topic.at(owner)].append(host.service.name)
    for key, names in sorted(writers.items()):
        if len(names) > 1:
            yield f"{key}: written by {' and '.join(sorted(names))}; one topic has one writer"


def _inputs(site: Scenario, hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """Every required input has a writer, and the vehicle the sensor that it comes from."""
    outputs = [(topic, owner) for host in hosts for topic in host.service.outputs.values() for owner in _owners(host, topic)]
    written = {topic.at(owner) for topic, owner in outputs if owner not in site.members or _has(site.members[owner], topic)}
    written.add(CLOCK.at(SYSTEM))
    for host in hosts:
        for name, declared in host.service.declared_inputs().items():
            owner = host.vehicle or SYSTEM
            source = (host.roles or {}).get(declared.role or "", owner)
            key = declared.topic.at("*" if declared.each_vehicle else source)
            if declared.required and not any(matches(key, w) or matches(w, key) for w in written):
                yield f"{host.service.name}: input '{name}' ({key}) is written by nobody{_mend(site, declared.topic, source)}"


def _has(member: MissionVehicle, topic: Topic[Any]) -> bool:
    return topic not in SENSORS or bool(getattr(member.file.sensors, SENSORS[topic]))


def _mend(site: Scenario, topic: Topic[Any], vehicle: str) -> str:
    if topic not in SENSORS or vehicle not in site.members:
        return ""
    return f"; give {vehicle} a sensor '{SENSORS[topic]}' in {site.members[vehicle].folder / 'vehicle.yaml'}"


def _unread_sensors(site: Scenario, hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """A sensor in a vehicle's file that no simulator knows would be missed only in the run."""
    given = {(owner, topic) for host in hosts for topic in host.service.outputs.values() for owner in _owners(host, topic)}
    for member in site.members.values():
        for topic, sensor in SENSORS.items():
            if getattr(member.file.sensors, sensor) and (member.name, topic) not in given:
                place = FileLocation(str(member.folder / "vehicle.yaml"), ("sensors", sensor))
                yield f"{place}: no simulator gives {topic.at(member.name)} for a vehicle of kind {member.file.kind}; take it out"


def _rates(hosts: Sequence[ServiceInstance]) -> Iterator[str]:
    """Steps fall on the clock's ticks, so that lockstep over the bus is the same as in one process."""
    for service in {h.service for h in hosts if h.service.clock == "sim"}:
        if Fraction(CLOCK.hz) % Fraction(service.hz).limit_denominator(1000) != 0:
            yield f"{service.name}: {service.hz:g} Hz does not divide the clock's {CLOCK.hz:g} Hz"


def compose_problems(path: Path) -> Iterator[str]:
    """Yields the differences between the stanzas of the compose file and the services."""
    if not path.exists():
        return
    stanzas = set(yaml.safe_load(path.read_text())["services"])
    wanted = {k.name for k in catalogue.KINDS} | set(catalogue.INFRASTRUCTURE)
    for name in sorted(wanted - stanzas):
        yield f"{path.name}: no stanza for {name}"
    for name in sorted(stanzas - wanted):
        yield f"{path.name}: stanza {name} is no service"
