"""``uvf bench``: runs the cases of ``benchmarks/<group>.py``, prints a table a group, keeps the figures."""

import importlib
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Column, Table

from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import ROOT

Figures = dict[str, dict[str, float]]
Case = Callable[[Path | None], Figures]
WIDTH = 200  # columns, of a table that goes into a file
RESULTS = ROOT / "benchmarks" / "results.md"


def run_groups(names: Sequence[str], data: Path | None, json_file: Path | None, write: bool) -> None:
    """Groups, each followed by the cases wanted of it (none = all). Raises BadInput."""
    groups = [p.stem for p in (ROOT / "benchmarks").glob("*.py") if "CASES = " in p.read_text()]
    wanted: dict[str, list[str]] = {}
    for name in names:
        if name in groups:
            wanted[name] = []
        elif not wanted:
            raise BadInput(f"no benchmark group '{name}'; {nearest(name, groups)}")
        else:
            wanted[next(reversed(wanted))].append(name)
    figures: dict[str, Figures] = {group: _run(group, cases, data) for group, cases in wanted.items()}
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    for group, rows in figures.items():
        console.print(_table(group, rows))
        if write:
            RESULTS.write_text(replace_section(RESULTS.read_text() if RESULTS.exists() else "# Results\n", group, rows))
    if json_file:
        json_file.write_text(json.dumps({name: row for rows in figures.values() for name, row in rows.items()}, indent=1))


def _module(group: str) -> Any:
    return importlib.import_module(f"benchmarks.{group}")


def _run(group: str, wanted: Sequence[str], data: Path | None) -> Figures:
    """A name stands for the case of that name, or for all whose names begin with it and a colon."""
    cases = cases_of(_module(group), data)
    chosen: dict[str, Case] = {}
    for name in wanted:
        found = {case: cases[case] for case in cases if case == name or case.startswith(f"{name}:")}
        if not found:
            raise BadInput(f"no case '{name}' in {group}; {nearest(name, cases)}")
        chosen |= found
    rows: Figures = {}
    for case in (chosen or cases).values():
        rows |= case(data)
    return rows


def cases_of(module: Any, data: Path | None) -> dict[str, Case]:
    """What a group measures; CASES may be a function of the data folder, where the cases depend on it. Raises BadInput."""
    found: dict[str, Case] = module.CASES(data) if callable(module.CASES) else module.CASES
    return found


def _columns(figures: Figures) -> list[str]:
    return list(dict.fromkeys(metric for row in figures.values() for metric in row))


def _table(group: str, figures: Figures) -> Table:
    columns = _columns(figures)
    table = Table(Column(group, no_wrap=True), *columns)
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
