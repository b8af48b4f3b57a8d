"""Units of the fields of our own message types, from the comments in ``schemas/proto``: ``double pitch = 3;  // rad, nose up``."""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

PROTO = Path(__file__).parent / "proto" / "uvf" / "v1"
BLOCK = re.compile(r"^(\s*)(message|enum|oneof) (\w+) \{")
FIELD = re.compile(r"^\s*(?:(repeated|optional) )?([\w.]+) (\w+) = \d+[^;]*;\s*(?://\s*(.*))?$")
"""Lines of a .proto file: (indent, kind, name) of a block; (how many, type, name, comment) of a field."""
UNIT = re.compile(r"(?:m/s\^2|m/s|rad/s|rad|kg/m\^3|Pa|Hz|kg|m|s|V|A|T|K|W)(?=$|[\s,;:])")


@lru_cache(maxsize=1)
def units() -> Mapping[tuple[str, str], str]:
    """(full name of a message type, field) -> its unit; fields without one are left out."""
    found: dict[tuple[str, str], str] = {}
    for path in sorted(PROTO.glob("*.proto")):
        outer: list[str] = []
        for line in path.read_text(encoding="utf-8").splitlines():
            if block := BLOCK.match(line):
                outer.append("" if block.group(2) == "oneof" else block.group(3))  # the fields of a oneof are the message's
            elif line.strip() == "}" and outer:
                outer.pop()
            elif outer and (field := FIELD.match(line)) and (unit := UNIT.match(field.group(4) or "")):
                found[f"uvf.v1.{'.'.join(filter(None, outer))}", field.group(3)] = unit.group(0)
    return found
