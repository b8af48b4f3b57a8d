"""Puts the autopilot's parameters into the text of a vehicle.yaml, which keeps all its other lines."""

import re
from collections.abc import Mapping

from uvf.models.yaml_data import BadInput, FileLocation

SERVICE = "autopilot_air"


def with_params(text: str, figures: Mapping[str, float], place: FileLocation) -> str:
    """The text of a vehicle.yaml with these autopilot parameters, each in its own unit (rad, m/s, s, [-]), replaced or added.

    Raises BadInput.
    """
    lines = text.rstrip("\n").splitlines()
    begin = next((i for i, line in enumerate(lines) if re.fullmatch(rf"  {SERVICE}:\s*(#.*)?", line)), None)
    if begin is None:
        if f"{SERVICE}:" in text:
            raise BadInput(f"{place}: write '{SERVICE}:' on a line of its own under 'params:', two blanks in, and a parameter a line below")
        begin = _new_block(lines, place)
    left = dict(figures)
    end = begin + 1
    while end < len(lines) and (not lines[end].strip() or lines[end].startswith("    ")):
        if (found := re.match(r"    (\w+):\s*[^#]*?(\s*#.*)?$", lines[end])) and found[1] in left:
            lines[end] = f"    {found[1]}: {left.pop(found[1]):.5g}{found[2] or ''}"
        end += 1
    lines[end:end] = [f"    {name}: {value:.5g}" for name, value in left.items()]
    return "\n".join(lines) + "\n"


def _new_block(lines: list[str], place: FileLocation) -> int:
    """Adds the autopilot's block; its line. Raises BadInput."""
    params = next((i for i, line in enumerate(lines) if re.match(r"params:", line)), None)
    if params is None:
        lines += ["", "params:"]
        params = len(lines) - 1
    if not (found := re.fullmatch(r"params:\s*(?:\{\s*\})?\s*(#.*)?", lines[params])):
        raise BadInput(f"{place}: write 'params:' on a line of its own, and each service below, two blanks in")
    lines[params] = " ".join(filter(None, ("params:", found[1])))
    lines.insert(params + 1, f"  {SERVICE}:")
    return params + 1
