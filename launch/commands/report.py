"""What ``uvf report``, ``uvf compare`` and ``uvf plot`` print."""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Column, Table

from launch.commands.log_contents import tell_cut_off
from launch.commands.run import criteria_table, shown
from launch.reports.comparison import criteria_rows, labels_of, write_comparison
from launch.reports.curves import draw_curves
from launch.reports.recorded_run import RecordedRun, recorded_run
from launch.reports.report import vehicle_figures, write_report
from uvf.runtime.log.folder import run_folder
from uvf.runtime.messages.validation import escaped

REPORT, COMPARISON, PLOT = "report", "compare", "plot.png"


def report_run(path: Path, out: Path | None) -> None:
    """Writes the report of a run into ``out`` or beside its logs, and prints the figures of its vehicles. Raises BadInput."""
    with recorded_run(path) as run:
        written = write_report(run, out or run_folder(path) / REPORT)
        console = Console()
        _warn(run)
        for name, history in run.vehicles.items():
            made = Table("flight of" if history.is_aircraft else "drive of", escaped(name))
            for figure in vehicle_figures(history):
                made.add_row(figure.name, figure.value)
            console.print(made)
        if run.verdicts:
            console.print(criteria_table(run.verdicts))
        for each in written:
            typer.echo(str(each))


def compare_runs(paths: Sequence[Path], out: Path | None) -> None:
    """Writes the comparison of runs into ``out`` or beside the first one's logs, and prints their criteria. Raises BadInput."""
    with ExitStack() as stack:
        runs = [stack.enter_context(recorded_run(path)) for path in paths]
        for run in runs:
            _warn(run)
        page = write_comparison(runs, out or run_folder(paths[0]) / COMPARISON)
        table = Table(*(Column(name, overflow="fold") for name in ("subject", "measure", "limit", *map(shown, labels_of(runs)))))
        for row in criteria_rows(runs):
            table.add_row(*map(shown, row))
        if table.row_count:
            Console().print(table)
        typer.echo(str(page))


def _warn(run: RecordedRun) -> None:
    """What speaks against taking its figures for those of the mission."""
    for line in (run.note, run.stopped_at and f"{run.path}: {run.stopped_at}", *run.failures):
        if line:
            typer.echo(f"uvf: {escaped(line)}", err=True)


def plot_fields(run: Path, fields: Sequence[str], out: Path | None) -> None:
    """Draws fields of messages over time into ``out`` or beside the logs, and prints what they were. Raises BadInput."""
    target = out or run_folder(run) / PLOT
    for name, (t, values) in draw_curves(run, fields, target).items():
        told = f"{len(t)} values from {values.min():.6g} to {values.max():.6g}, the last {values[-1]:.6g}" if len(t) else "no values"
        typer.echo(f"{escaped(name)}: {told}")
    typer.echo(str(target))
    tell_cut_off(run)
