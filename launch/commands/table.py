"""Renders the topic table into ``docs/reference/topics.md``: ``python -m launch.commands.table [--check]``."""

import sys

from launch.catalogue import INFRASTRUCTURE, KINDS
from schemas.topics import PREFIX, REQUESTS, TOPICS
from uvf.models.scenario import ROOT

PAGE = ROOT / "docs" / "reference" / "topics.md"


def render() -> str:
    """Renders the whole page."""
    lines = [
        "# Topics, requests and processes",
        "",
        "Made from `schemas/topics.py` and `launch/catalogue.py` by `python -m launch.commands.table`; do not edit.",
        f"Every key begins with `{PREFIX}/`; `<owner>` is a vehicle, `<source>` one of several writers.",
        "",
        "| topic | type | Hz | QoS | logged | what |",
        "|---|---|---|---|---|---|",
    ]
    for t in TOPICS.values():
        hz = f"{t.hz:g}" if t.hz else "on change"
        lines.append(f"| `{t.key}` | {t.message.DESCRIPTOR.full_name} | {hz} | {t.qos.value} | {'yes' if t.logged else 'no'} | {t.about} |")
    lines += ["", "| request | asks | answers | what |", "|---|---|---|---|"]
    for r in REQUESTS.values():
        lines.append(f"| `{r.key}` | {r.message.DESCRIPTOR.full_name} | {r.reply.DESCRIPTOR.full_name} | {r.about} |")
    lines += ["", "| process | clock | what |", "|---|---|---|"]
    lines += [f"| `{k.name}` | {k.clock} | {k.about} |" for k in KINDS]
    lines += ["", f"Beside them run {', '.join(f'`{name}`' for name in INFRASTRUCTURE)}."]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Writes the page, or with ``--check`` only compares it."""
    if "--check" not in sys.argv:
        PAGE.write_text(render())
    elif not PAGE.exists() or PAGE.read_text() != render():
        raise SystemExit("docs/reference/topics.md is not up to date; run python -m launch.commands.table")


if __name__ == "__main__":
    main()
