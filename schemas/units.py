"""Units of the fields of our own message types, from the comments in ``schemas/proto``: ``double pitch = 3;  // rad, nose up``."""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

PROTO = Path(__file__).parent / "proto" / "uvf" / "v1"
BLOCK = re.compile(r"^\s*(?:message|enum|oneof) (\w+) \{")
FIELD = re.compile(r"^\s*(?:(?:repeated|optional) )?[\w.]+ (\w+) = \d+[^;]*;\s*//\s*(.*)$")
UNIT = re.compile(r"(?:m/s\^2|m/s|rad/s|rad|kg/m\^3|Pa|Hz|kg|m|s|V|A|T|K|W)(?=$|[\s,;:])")


@lru_cache(maxsize=1)
def units() -> Mapping[tuple[str, str], str]:
    """(full name of a message type, field) -> its unit; fields without one are left out."""
    found: dict[tuple[str, str], str] = {}
    for path in sorted(PROTO.glob("*.proto")):
        outer: list[str] = []
        for line in path.read_text(encoding="utf-8").splitlines():
            if block := BLOCK.match(line):
                outer.append(block.group(1))
            elif line.strip() == "}" and outer:
                outer.pop()
            elif outer and (field := FIELD.match(line)) and (unit := UNIT.match(field.group(2))):
                found[f"uvf.v1.{'.'.join(outer)}", field.group(1)] = unit.group(0)
    return found
