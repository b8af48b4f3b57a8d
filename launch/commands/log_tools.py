"""What ``replay``, ``log info`` and ``log recover`` print."""

import signal
from collections import Counter
from contextlib import nullcontext
from pathlib import Path
from threading import Event

import typer

from launch import catalogue, settings
from launch.commands.log_contents import tell_cut_off
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.log.folder import logs_of, recovered_path
from uvf.runtime.log.reading import log_begin, log_metadata
from uvf.runtime.log.recovery import recover
from uvf.runtime.log.replay import into_service, logged_site, onto_bus
from uvf.runtime.log.run_samples import is_cut_off, run_samples, whole_log

SHOWN = 20


def replay_onto_bus(log: Path, rate: float) -> int:
    """Replays a log onto the bus at ``rate`` [simulation s per s] until its end or Ctrl-C; returns the exit code. Raises BadInput."""
    log_begin(log)  # what is wrong with it, before a router is looked for
    stop = Event()
    signal.signal(signal.SIGINT, lambda *_: stop.set())
    with ZenohBus(router_from(), blocking=True, timeout=5.0) as bus:
        count = onto_bus(log, bus, rate, lambda: not stop.is_set(), _to_stderr)
    typer.echo(f"{count} messages replayed")
    return 0


def replay_into(log: Path, service: str, vehicle: str | None, mission: str | None) -> int:
    """Replays a log into a service and prints the output fields that differ; 0 when there are none, else 1. Raises BadInput."""
    with nullcontext(load_scenario(settings.mission_path(mission))) if mission else logged_site(log) as site:
        hosts = _hosts_named(service, site, vehicle, runs_programs=mission is not None)
        if begin := log_begin(log):
            typer.echo(
                f"the log begins at {begin / 1e9:.1f} s: {service} begins there like one that is started again, so some differ by that"
            )
        count = 0
        for difference in (line for host in hosts for line in into_service(log, host, warn=_to_stderr)):
            count += 1
            if count <= SHOWN:
                typer.echo(str(difference))
    what = ", ".join(f"{h.service.name} of {h.vehicle or 'all vehicles'}" for h in hosts)
    typer.echo(f"{what}: {count} differences" if count else f"{what}: output is identical")
    return 1 if count else 0


def _to_stderr(line: str) -> None:
    typer.echo(line, err=True)


def _hosts_named(name: str, site: Scenario, vehicle: str | None, runs_programs: bool) -> list[ServiceInstance]:
    """By the name that ``uvf service`` takes (all that it runs) or that ``uvf node list`` shows (that one). Raises BadInput.

    runs_programs: not where a log brings them along: whoever opens a stranger's log shall not run a stranger's code.
    """
    if vehicle is not None and vehicle not in site.members:
        raise BadInput(f"no vehicle '{vehicle}' in {site.mission_path.name}; {nearest(vehicle, site.members)}")
    kinds = [k for k in catalogue.needed(site) if k.clock == "sim" and (runs_programs or k.needs != "program")]
    if any(k.name == name for k in kinds):
        return catalogue.hosts(site, [catalogue.kind(name)], vehicle)
    every = catalogue.hosts(site, kinds)
    hosts = [h for h in every if h.service.name == name and vehicle in (None, h.vehicle)]
    if not hosts:
        whose = f" of '{vehicle}'" if vehicle else ""
        known = {k.name for k in kinds} | {h.service.name for h in every if vehicle in (None, h.vehicle)}
        hint = "; a program is run with --mission only" if not runs_programs and any(m.entry.program for m in site.members.values()) else ""
        raise BadInput(f"no service '{name}'{whose} in {site.mission_path.name} to replay into; {nearest(name, known)}{hint}")
    return hosts


def describe_log(run: Path) -> None:
    """Prints the topics of a log, or of all logs of a run's folder, with type, count and rate [Hz], its length and its metadata.

    Of one that was cut off, as far as it is whole. Raises BadInput.
    """
    counts: Counter[str] = Counter()
    sizes: Counter[str] = Counter()
    types: dict[str, str] = {}
    end_ns = 0
    for sample in run_samples(run):
        counts[sample.key] += 1
        sizes[sample.key] += len(sample.payload)
        types[sample.key] = sample.type_name
        end_ns = max(end_ns, sample.stamp_ns)
    logs = logs_of(run)
    with whole_log(logs[0]) as first:
        begin = log_begin(first) / 1e9
    end = end_ns / 1e9
    width = max(map(len, counts), default=0)
    for key in sorted(counts):
        rate = counts[key] / max(end - begin, 1e-9)
        typer.echo(f"{key:{width}}  {types[key]:28}  {counts[key]:7} messages  {rate:6.1f} Hz  {sizes[key] / 1000:8.0f} kB")
    typer.echo(f"{counts.total()} messages, " + (f"from {begin:.1f} s to {end:.1f} s" if begin else f"{end:.1f} s"))
    if not is_cut_off(logs[-1]):
        for name, value in log_metadata(logs[-1]).items():
            typer.echo(f"{name}: {value}")
    tell_cut_off(run)


def recover_log(log: Path, out: Path | None) -> None:
    """Saves the readable part of a log that was cut off into ``out`` or beside it."""
    target = out or recovered_path(log)
    typer.echo(f"{recover(log, target, lambda line: typer.echo(line, err=True))} messages saved into {target}")
