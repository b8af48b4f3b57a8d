"""Renders ``docs/reference/mavlink-parameters.md``: ``python -m services.autopilot.mavlink.parameters.parameter_page [--check]``."""

import sys
from collections.abc import Mapping

from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.mavlink.parameters.own_params import Own, own_params
from services.autopilot.mavlink.parameters.parameter_table import FILE, Kind, Parameter, Table, parameters_with
from uvf.models.scenario import ROOT
from uvf.models.vehicle.flight_params import FIXED, AirParams
from uvf.models.yaml_data import load_yaml

PAGE = ROOT / "docs" / "reference" / "mavlink-parameters.md"
COMMAND = "python -m services.autopilot.mavlink.parameters.parameter_page"
KINDS: Mapping[Kind, tuple[str, Mapping[str, Own]]] = {
    "fixed_wing": ("aircraft", own_params(AirParams(), FIXED)),
    "ground": ("rover", own_params(GroundAutopilotParams(), frozenset())),
}
HEAD = f"""# Parameters of ground stations

Made from `services/autopilot/mavlink/parameters/parameters.yaml` and the autopilots' parameters by `{COMMAND}`; do not edit.

A ground station sees PX4's names below, and the autopilot's own parameters under their names in capitals; what has both may be set
under either. It works at once, in flight too, and is kept on this machine for this mission (`UVF_STATE`) until
`MAV_CMD_PREFLIGHT_STORAGE` 2 resets all to the vehicle's file. A circle of Hold, Orbit and Return that was given no radius of its own
follows `NAV_LOITER_RAD`; a landing is planned with what is set when it begins, a corner of a mission with what is set shortly before.

| name | what | aircraft | rover |
|---|---|---|---|"""


def render() -> str:
    """Renders the whole page."""
    tables = {kind: {p.name: p for p in parameters_with(own, kind)} for kind, (_, own) in KINDS.items()}
    lines = [HEAD]
    for name, row in sorted(load_yaml(FILE, Table).parameters.items()):
        cells = [_standard(tables[kind].get(name), own) for kind, (_, own) in KINDS.items()]
        lines.append(f"| `{name}` | {row.about} | {' | '.join(cells)} |")
    for kind, (title, own) in KINDS.items():
        lines += ["", f"## The {title}'s own", "", "| name | what | range | PX4's name |", "|---|---|---|---|"]
        lines += [f"| `{one.name.upper()}` | {one.about} | {_own(one)} | {_alias(one, tables[kind])} |" for one in own.values()]
    return "\n".join(lines) + "\n"


def _standard(p: Parameter | None, own: Mapping[str, Own]) -> str:
    """What one of PX4's is in a kind of vehicle."""
    if p is None:
        return "-"
    if p.fixed:
        return f"fixed: {p.fixed}"
    if p.cases:
        return "; ".join(f"{number} {case.says}" for number, case in p.cases.items())
    return f"`{p.own}`, {_range(own[p.own])}"


def _own(one: Own) -> str:
    if one.fixed:
        return f"fixed: {one.fixed}"
    return ", ".join(f"{i} {choice}" for i, choice in enumerate(one.choices)) or _range(one)


def _range(one: Own) -> str:
    return f"{one.low:g} to {one.high:g}{' ' + one.unit if one.unit else ''}"


def _alias(one: Own, table: Mapping[str, Parameter]) -> str:
    """PX4's names of it; where they are too long for MAVLink, its own is none."""
    named = [p.name for p in table.values() if p.own == one.name or any(one.name in case.sets for case in p.cases.values())]
    named = [f"`{name}`" for name in named if name != one.name.upper()]
    return ", ".join(named) + ("" if one.name.upper() in table else " only")


def main() -> None:
    """Writes the page, or with ``--check`` only compares it."""
    if "--check" not in sys.argv:
        PAGE.write_text(render())
    elif not PAGE.exists() or PAGE.read_text() != render():
        raise SystemExit(f"docs/reference/mavlink-parameters.md is not up to date; run {COMMAND}")


if __name__ == "__main__":
    main()
