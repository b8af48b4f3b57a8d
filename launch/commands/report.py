"""What ``uvf report`` prints."""

from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from launch.commands.run import criteria_table
from launch.reports.recorded_run import recorded_run
from launch.reports.report import folder_beside, vehicle_figures, write_report
from uvf.runtime.messages.validation import escaped


def report_run(path: Path, out: Path | None) -> None:
    """Writes the report of a run into ``out`` or beside its logs, and prints the figures of its vehicles. Raises BadInput."""
    with recorded_run(path) as run:
        written = write_report(run, out or folder_beside(path))
        console = Console()
        if run.note:
            typer.echo(f"uvf: {escaped(run.note)}", err=True)
        for name, history in run.vehicles.items():
            made = Table("flight of" if history.is_aircraft else "drive of", escaped(name))
            for figure in vehicle_figures(history):
                made.add_row(figure.name, figure.value)
            console.print(made)
        if run.verdicts:
            console.print(criteria_table(run.verdicts))
        for each in written:
            typer.echo(str(each))
