"""``uvf bench``: runs the cases of ``benchmarks/<group>.py``, prints one table, keeps the figures."""

import importlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import ROOT

Figures = dict[str, dict[str, float]]
Case = Callable[[Path | None], Figures]
RESULTS = ROOT / "benchmarks" / "results.md"


def run_group(group: str, wanted: Sequence[str], data: Path | None, json_file: Path | None, write: bool) -> None:
    """Runs the cases of one group (all when none is named). Raises BadInput."""
    groups = [p.stem for p in (ROOT / "benchmarks").glob("*.py") if p.stem != "__init__"]
    if group not in groups:
        raise BadInput(f"no benchmark group '{group}'; {nearest(group, groups)}")
    cases: dict[str, Case] = importlib.import_module(f"benchmarks.{group}").CASES
    for name in wanted:
        if name not in cases:
            raise BadInput(f"no case '{name}' in {group}; {nearest(name, cases)}")
    figures: Figures = {}
    for name in wanted or cases:
        figures |= cases[name](data)
    Console().print(_table(group, figures))
    if json_file:
        json_file.write_text(json.dumps(figures, indent=1))
    if write:
        RESULTS.write_text(replace_section(RESULTS.read_text() if RESULTS.exists() else "# Results\n", group, figures))


def _columns(figures: Figures) -> list[str]:
    return list(dict.fromkeys(metric for row in figures.values() for metric in row))


def _table(group: str, figures: Figures) -> Table:
    columns = _columns(figures)
    table = Table(group, *columns)
    for name, row in figures.items():
        table.add_row(name, *(f"{row[c]:.4g}" if c in row else "" for c in columns))
    return table


def replace_section(text: str, group: str, figures: Figures) -> str:
    """The results page with the section of one group renewed."""
    columns = _columns(figures)
    lines = [f"| {group} | {' | '.join(columns)} |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {n} | {' | '.join(f'{row[c]:.4g}' if c in row else '' for c in columns)} |" for n, row in figures.items()]
    section = f"\n## {group}\n\n" + "\n".join(lines) + "\n"
    before, found, after = text.partition(f"\n## {group}\n")
    rest = after.partition("\n## ")
    tail = f"\n## {rest[2]}" if found and rest[1] else ""
    return before.rstrip("\n") + "\n" + section + tail
