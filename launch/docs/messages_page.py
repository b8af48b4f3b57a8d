"""``docs/reference/messages.md``: the project's own message types, from the comments in ``schemas/proto``."""

import re
from collections.abc import Iterator
from pathlib import Path

from schemas.units import BLOCK, FIELD, PROTO

HEAD = """# Messages

Generated from `schemas/proto/uvf/v1/*.proto` by `python -m launch.docs.pages`; do not edit.

Types that begin with `foxglove.` are those of the package foxglove-schemas-protobuf, described in
[Foxglove's documentation](https://docs.foxglove.dev/docs/sdk/schemas). Which topic carries which type stands in [topics](topics.md).
"""
VALUE = re.compile(r"^\s*([A-Z]\w*) = (\d+);\s*(?://\s*(.*))?$")


def render() -> str:
    """Renders the whole page."""
    return "\n".join((HEAD, *(line for path in sorted(PROTO.glob("*.proto")) for line in _file(path)))) + "\n"


def _file(path: Path) -> Iterator[str]:
    yield from (f"## `{path.name}`", "")
    said: list[str] = []
    outer: list[str] = []
    tables: dict[str, list[str]] = {}  # by name; one inside another comes after it
    for line in path.read_text(encoding="utf-8").splitlines():
        text = line.strip()
        if text.startswith("//"):
            said.append(text.removeprefix("//").strip())
            continue
        if block := BLOCK.match(line):
            outer.append("" if block.group(2) == "oneof" else block.group(3))
            if not outer[-1]:  # its fields are the message's
                said = []
                continue
            head = ("field", "type", "meaning") if block.group(2) == "message" else ("value", "number", "meaning")
            about = [" ".join(said), ""] if said else []
            tables[_name(outer)] = [*about, f"| {' | '.join(head)} |", "|---|---|---|"]
        elif field := FIELD.match(line):
            many, kind, name, meaning = field.groups()
            tables[_name(outer)].append(f"| `{name}` | {f'{many} ' if many else ''}{kind} | {_joined(said, meaning)} |")
        elif value := VALUE.match(line):
            tables[_name(outer)].append(f"| `{value.group(1)}` | {value.group(2)} | {_joined(said, value.group(3))} |")
        elif text == "}" and outer:
            outer.pop()
        said = []
    for name, rows in tables.items():
        yield from ("", f"### {name}", "", *rows)
    yield ""


def _name(outer: list[str]) -> str:
    return ".".join(part for part in outer if part)


def _joined(said: list[str], about: str | None) -> str:
    return " ".join((*said, about or "")).strip().replace("|", "\\|")
