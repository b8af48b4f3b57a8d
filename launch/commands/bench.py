"""``uvf bench``: runs the cases of the groups in ``benchmarks/groups.yaml``, prints a table a group, checks goals, keeps the figures."""

import importlib
import json
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.table import Column, Table

from launch.commands.bench_page import BenchmarkFacts, facts_now, notes_of, replace_section, verdicts
from launch.commands.bench_selection import EVERYTHING, Selection, check_known
from launch.settings import ROOT, benchmark_group, benchmark_modules
from uvf.models.yaml_data import BadInput, nearest

Figures = dict[str, dict[str, float]]
Case = Callable[[Path | None], Figures]
WIDTH = 200  # columns, of a table that goes into a file
RESULTS = ROOT / "benchmarks" / "results.md"


def run_groups(names: Sequence[str], data: Path | None, json_file: Path | None, write: bool, selection: Selection = EVERYTHING) -> None:
    """Runs benchmark groups, each followed by its wanted cases (none = all); names are looked up before anything runs. Raises BadInput."""
    wanted = _wanted(names)
    chosen = {group: _chosen(group, cases, data, selection) for group, cases in wanted.items()}
    selection.begin()
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    measured: Figures = {}
    for group, cases in chosen.items():
        before = facts_now([group, *wanted[group], *(["--data", "DIR"] if data else []), *selection.words()])
        rows = _run(group, cases, data)
        measured |= rows
        console.print(_table(group, rows))
        for line in verdicts(group, rows):
            console.print(line, markup=False, highlight=False)
        if write:
            _write(group, wanted[group], rows, before)
    if json_file:
        json_file.write_text(json.dumps(measured, indent=1))


def _wanted(names: Sequence[str]) -> dict[str, list[str]]:
    groups, wanted = benchmark_modules(), dict[str, list[str]]()
    for name in names:
        if name in groups or not wanted:
            wanted[benchmark_group(name)] = []
        else:
            wanted[next(reversed(wanted))].append(name)
    return wanted


def _write(group: str, cases: Sequence[str], rows: Figures, facts: BenchmarkFacts) -> None:
    """Some cases of a group have a section of their own, beside that of the whole group."""
    page = RESULTS.read_text(encoding="utf-8") if RESULTS.exists() else "# Results\n"
    lines = [facts.line(), *notes_of(group), *verdicts(group, rows)]
    RESULTS.write_text(replace_section(page, " ".join([group, *sorted(cases)]), rows, lines), encoding="utf-8")


def _chosen(group: str, wanted: Sequence[str], data: Path | None, selection: Selection) -> dict[str, Case]:
    """A name stands for the case of that name, or for all whose names begin with it and a colon. Raises BadInput."""
    module = importlib.import_module(benchmark_modules()[group])
    cases = cases_of(module, data, selection)
    chosen: dict[str, Case] = {}
    for name in wanted:
        found = {case: cases[case] for case in cases if case == name or case.startswith(f"{name}:")}
        if not found:
            raise BadInput(f"no case '{name}' in {group}; {nearest(name, cases)}")
        chosen |= found
    check_known(group, chosen or cases, getattr(module, "OPTIONS", {}), selection)
    return chosen or cases


def _run(group: str, cases: Mapping[str, Case], data: Path | None) -> Figures:
    """One plain line a step to stderr, so that a table that is piped away leaves the progress on the screen."""
    rows: Figures = {}
    for number, (name, case) in enumerate(cases.items(), 1):
        typer.echo(f"uvf: {group} {name} ({number} of {len(cases)})", err=True)
        begun = time.perf_counter()
        rows |= case(data)
        typer.echo(f"uvf: {group} {name} took {time.perf_counter() - begun:.1f} s", err=True)
    return rows


def cases_of(module: Any, data: Path | None, selection: Selection = EVERYTHING) -> dict[str, Case]:
    """The cases that a group measures; CASES may be a function of the data folder, or of that and the selection. Raises BadInput."""
    if not callable(module.CASES):
        found: dict[str, Case] = module.CASES
    elif hasattr(module, "OPTIONS"):
        found = module.CASES(data, selection)
    else:
        found = module.CASES(data)
    return found


def _table(group: str, figures: Figures) -> Table:
    columns = list(dict.fromkeys(metric for row in figures.values() for metric in row))
    table = Table(Column(group, no_wrap=True), *columns)
    for name, row in figures.items():
        table.add_row(name, *(f"{row[c]:.4g}" if c in row else "" for c in columns))
    return table
