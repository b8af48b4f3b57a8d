"""What ``uvf run`` prints."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from statistics import median

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from launch import settings
from launch.campaign import SeedRun, run_seeds, success_interval
from launch.changed_mission import changed_mission, load_changed
from launch.run import Result, run_lockstep
from launch.runs import given_up_when_refused, new_run
from launch.scoring.last_words import why
from launch.scoring.scores import Verdict
from launch.vehicles.mission_faults import warnings
from schemas import topics
from uvf.models.scenario import load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.folder import log_name
from uvf.runtime.log.reading import is_log
from uvf.runtime.messages.validation import escaped

TICK = 1 / topics.CLOCK.hz  # s

console = Console()


def run_and_report(mission: str, until: float | None, log: Path | None, changes: list[str]) -> int:
    """Runs in lockstep up to ``until`` [s, simulation] with a progress bar and prints the score; 0 when every criterion holds, else 1.

    Raises BadInput.
    """
    base = settings.mission_path(mission)
    until = _until(until, load_changed(base, changes).mission.duration)
    if log is not None:
        _check_log(log)
        return _run(base, changes, until, log)
    folder = new_run()
    with given_up_when_refused(folder):
        return _run(base, changes, until, folder / log_name(0))


def _run(base: Path, changes: list[str], until: float, log: Path) -> int:
    site = load_scenario(changed_mission(base, changes, log.parent))
    for line in warnings(site):
        typer.echo(f"uvf: {line}", err=True)
    with _progress(site.mission_path.stem, until) as (bar, advance):

        def watch(t: float) -> bool:
            if round(t * 100) % 50 == 0:
                advance(t)
            return True

        try:
            result = run_lockstep(site, until, log, watch, lambda line: bar.console.print(line, markup=False))
        except KeyboardInterrupt:
            typer.echo(f"stopped; what was recorded until then is in {log}", err=True)
            raise
    _print_result(result, log)
    return 0 if result.passed and not result.recording_error else 1


def _check_log(log: Path) -> None:
    """Raises BadInput for what would be lost under a log."""
    if log.is_file() and log.stat().st_size and not is_log(log):
        raise BadInput(f"--log {log}: is there and is no log; choose another name")
    if log.is_file() and log.stat().st_size:
        typer.echo(f"uvf: {log}: the log that was there is replaced", err=True)


def run_campaign(mission: str, seeds: int, until: float | None, changes: list[str]) -> int:
    """Runs with several seeds and prints success rate and spread; 0 when all have passed, else 1. Raises BadInput."""
    base = settings.mission_path(mission)
    until = None if until is None else _until(until, math.inf)
    for line in warnings(load_changed(base, changes)):
        typer.echo(f"uvf: {line}", err=True)
    folder = new_run()
    path = changed_mission(base, changes, folder)
    runs: list[SeedRun] = []
    with given_up_when_refused(folder), _progress(f"{path.stem}, {seeds} seeds", seeds, "runs") as (_, advance):
        for run in run_seeds(path, seeds, until, folder):
            runs.append(run)
            advance(len(runs))
    _print_campaign(sorted(runs, key=lambda run: run.seed))
    return 0 if all(run.passed for run in runs) else 1


def _until(given: float | None, duration: float) -> float:
    until = given if given is not None else duration
    if not TICK <= until < math.inf:
        raise BadInput(f"--until {until:g}: how long to simulate, {TICK:g} s at least")
    return until


@contextmanager
def _progress(title: str, total: float, unit: str = "s") -> Iterator[tuple[Progress, Callable[[float], None]]]:
    """A progress bar, and what moves it."""
    text = TextColumn("{task.completed:.0f} of {task.total:.0f} " + unit)
    with Progress(TextColumn("{task.description}"), BarColumn(), text, TimeRemainingColumn(), console=console, transient=True) as bar:
        task = bar.add_task(title, total=total)
        yield bar, lambda done: bar.update(task, completed=done)


def shown(text: str) -> str:
    """Text of a log or a mission as a cell of a table on the terminal: neither control characters nor markup are obeyed."""
    return escape(escaped(text))


def criteria_table(verdicts: Sequence[Verdict]) -> Table:
    """The criteria of a mission with what was measured."""
    table = Table("subject", "measure", "value", "limit", "", "decided by")
    for column in table.columns[:2]:
        column.overflow = "fold"  # names of measures are looked up, also on a narrow terminal
    for verdict in verdicts:
        row = (shown(verdict.subject), verdict.criterion.measure, f"{verdict.found.value:.3g}", verdict.limits)
        table.add_row(*row, verdict.word, shown(verdict.found.circumstances))
    return table


def _print_result(result: Result, log: Path) -> None:
    if result.verdicts:
        console.print(criteria_table(result.verdicts))
    for line in (*result.told.crashes, *result.undone, *why(result.verdicts, result.told)):
        typer.echo(escaped(line))
    typer.echo(f"simulated {result.simulated:g} s in {result.wall:.1f} s: {result.factor:.1f} x real time")
    typer.echo(f"log {log}: {result.messages} messages, hash {result.log_hash}")
    for failure in result.failures:
        typer.echo(failure, err=True)
    if result.recording_error:
        typer.echo(result.recording_error, err=True)


def _print_campaign(runs: list[SeedRun]) -> None:
    table = Table("subject", "measure", "limit", "least", "median", "most", "passed")
    for same in zip(*(run.verdicts for run in runs), strict=True):
        values = sorted(verdict.found.value for verdict in same)
        spread = (f"{value:.3g}" for value in (values[0], median(values), values[-1]))
        first, passed = same[0], sum(verdict.passed for verdict in same)
        table.add_row(escaped(first.subject), first.criterion.measure, first.limits, *spread, f"{passed} of {len(runs)}")
    console.print(table)
    for run in runs:
        for line in run.complaints:
            typer.echo(escaped(line))
    passed = sum(run.passed for run in runs)
    low, high = success_interval(passed, len(runs))
    factor = sum(run.simulated for run in runs) / sum(run.wall for run in runs)
    typer.echo(f"{passed} of {len(runs)} passed: {100 * passed / len(runs):.0f} %, 95 % interval {100 * low:.0f} to {100 * high:.0f} %")
    typer.echo(f"each simulated {sum(run.simulated for run in runs) / len(runs):.0f} s on average, {factor:.1f} x real time")
