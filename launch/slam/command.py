"""What ``uvf slam`` does and prints."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from launch import settings
from launch.slam.known import known_of
from launch.slam.opening import open_log
from launch.slam.results import Made, write_results
from launch.slam.scoring import figures
from launch.slam.tables import Rows, all_tables, remarks
from uvf.models.params import Params
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.run import LogRun, run_over
from uvf.slam.logs.laser_log import LaserLog
from uvf.slam.methods import make_method, method_params
from uvf.slam.resumable import Noting

WIDTH = 110
"""Columns, of tables that go into a file."""
console = Console(width=None if sys.stdout.isatty() else WIDTH)
SHOWN_EVERY = 25  # readings


@dataclass(frozen=True)
class SlamJob:
    """The arguments of ``uvf slam``."""

    log: Path
    method: str
    values: tuple[str, ...]
    out: Path | None
    vehicle: str | None
    relations: Path | None
    resolution: float


def run_job(job: SlamJob) -> None:
    """Runs a SLAM method over a log and writes the results. Raises BadInput."""
    params = method_params(job.method, _values(job.values), "--set")
    log = open_log(job.log, job.vehicle)
    known = known_of(job.log, log, job.vehicle, job.relations)
    for note in (*log.notes, *known.notes):
        typer.echo(f"uvf: {note}", err=True)
    folder = job.out or settings.runs_folder() / "slam" / f"{log.name}-{job.method}"
    _make(folder)
    run = _watched(log, job.method, params)
    found = figures(run, known)
    write_results(run, known, Made(job.method, params, job.resolution), found, folder)
    for heading, rows in all_tables(found).items():
        console.print(_table(heading, rows))
    for line in remarks(found):
        typer.echo(line)
    typer.echo(f"results in {folder}")


def _make(folder: Path) -> None:
    """Before the run, which may take minutes. Raises BadInput."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadInput(f"--out {folder}: cannot be a folder: {error.strerror}") from error


def _values(words: tuple[str, ...]) -> dict[str, Any]:
    """NAME=VALUE: numbers, true and false as JSON has them, else text. Raises BadInput."""
    values: dict[str, Any] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not (name and equals):
            raise BadInput(f"--set {word}: write NAME=VALUE")
        try:
            values[name] = json.loads(value)
        except ValueError:
            values[name] = value
    return values


def _watched(log: LaserLog, name: str, params: Params) -> LogRun:
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed} of {task.total} readings"),
        TimeRemainingColumn(),
    )
    method = make_method(name, params)
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(f"{log.name}, {name}", total=len(log))

        def watch(done: int) -> None:
            if done % SHOWN_EVERY == 0:
                bar.update(task, completed=done)

        run = run_over(log, method, watch)
    for note in method.notes if isinstance(method, Noting) else []:
        typer.echo(f"uvf: {note}", err=True)
    return run


def _table(heading: str, rows: Rows) -> Table:
    table = Table(*rows[0], title=heading, title_justify="left")
    for row in rows[1:]:
        table.add_row(*row)
    return table
