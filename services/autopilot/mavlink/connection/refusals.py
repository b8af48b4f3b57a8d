"""Refusals in the words of who flies: what a service's border says of a message is meant for who writes services."""

import re

BROKEN = re.compile(r"\S+: broken [\w.]+: (?P<field>[a-z_0-9.\[\]]+): (?P<why>.*)", re.DOTALL)
ELSE_BROKEN = re.compile(r"\S+: (broken [\w.]+: |\d+ bytes, ).*", re.DOTALL)
INDEX = re.compile(r"\[(\d+)\]")


def plain(reason: str) -> str:
    """The reason of a refusal in words for a station's user; a leading index becomes that of an item."""
    if found := BROKEN.fullmatch(reason):
        index, name = INDEX.search(found["field"]), _named(found["field"])
        item = f"item {index[1]}: " if index is not None else ""
        return f"{item}the {name} cannot be that ({found['why']})"
    if ELSE_BROKEN.fullmatch(reason):
        return "it is too large, or has a number that cannot be"
    return reason


def _named(field: str) -> str:
    """The last part of a path that is a word; of a vector the vector."""
    parts = [part for part in INDEX.sub("", field).split(".") if part not in ("x", "y", "z")]
    return parts[-1].replace("_", " ")
