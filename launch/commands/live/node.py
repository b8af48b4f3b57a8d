"""``uvf node``: who is alive, and who writes what for whom, from the liveliness tokens."""

from collections import defaultdict

import typer

from schemas import topics
from schemas.messages import Process
from uvf.client import Client
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.interface import matches
from uvf.runtime.bus.zenoh_bus import ZenohBus


def list_nodes() -> None:
    """Prints a line for each living service instance, then one for each process under a launcher's supervision."""
    with ZenohBus(router_from(), timeout=3.0) as bus:
        nodes = [token.split("/")[1:] for token in bus.tokens("@node/**")]
        for owner, service, boot in nodes:
            typer.echo(f"{owner:12} {service:18} boot {boot}")
        client = Client(bus)
        for launcher in (service for _, service, _ in nodes if service.startswith("launcher")):
            for p in client.read("sys", topics.PROCESSES.by(launcher)).processes:
                state = Process.State.Name(p.state).lower()
                typer.echo(f"{'process':12} {p.name:18} {state}, pid {p.pid}, started again {p.restarts} times {p.reason}".rstrip())


def graph() -> None:
    """Prints for each key: writers -> readers."""
    with ZenohBus(router_from(), timeout=3.0) as bus:
        tokens = [token.split("/") for token in bus.tokens("@ep/**")]
    writers: defaultdict[str, set[str]] = defaultdict(set)
    readers: defaultdict[str, set[str]] = defaultdict(set)
    for _, owner, node, way, key, _ in tokens:
        where = key.replace("%", "/").replace("+", "*")
        (writers if way == "pub" else readers)[where].add(f"{node}({owner})")
    for key in sorted(writers):
        reading = {reader for wanted, names in readers.items() if matches(wanted, key) or matches(key, wanted) for reader in names}
        typer.echo(f"{key}: {', '.join(sorted(writers[key]))} -> {', '.join(sorted(reading)) or 'nobody'}")
