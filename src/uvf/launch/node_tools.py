"""``uvf node``: who is alive, and who writes what for whom, from the liveliness tokens."""

from collections import defaultdict

import typer

from uvf.runtime.address import router_from
from uvf.runtime.bus import matches
from uvf.runtime.zenoh_bus import ZenohBus


def list_nodes() -> None:
    """One line for each living service instance."""
    with ZenohBus(router_from(), timeout=3.0) as bus:
        for token in bus.tokens("@node/**"):
            _, owner, service, boot = token.split("/")
            typer.echo(f"{owner:12} {service:18} boot {boot}")


def graph() -> None:
    """For each key: writers -> readers."""
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
