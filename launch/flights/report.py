"""``uvf report``: a page of plots and a table of figures for each aircraft of a run."""

from pathlib import Path

from rich.table import Table

from launch.flights.figures import figures
from launch.flights.history import History, histories
from launch.flights.page import draw
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.folder import logs_of

FOLDER = "report"


def flights(run: Path) -> list[History]:
    """The aircraft in the folder of a run or in one log. Raises BadInput."""
    found = [h for h in histories(logs_of(run)).values() if h.is_aircraft]
    if not found:
        raise BadInput(f"{run}: there is no aircraft in this log: nothing to report")
    return found


def folder_beside(run: Path) -> Path:
    """The folder of a run's report, beside its logs."""
    return (run if run.is_dir() else run.parent) / FOLDER


def write(aircraft: list[History], target: Path) -> list[Path]:
    """Writes a picture for each aircraft and ``report.md`` with all figures; returns the files written. Raises BadInput."""
    try:
        target.mkdir(parents=True, exist_ok=True)
        pages = [target / f"{history.name}.png" for history in aircraft]
        for history, page in zip(aircraft, pages, strict=True):
            draw(history, page)
        text = target / "report.md"
        text.write_text(_text(aircraft), encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{target}: {error.strerror}: choose another folder with --out") from error
    return [*pages, text]


def _text(aircraft: list[History]) -> str:
    lines = ["# Flight report", ""]
    for history in aircraft:
        lines += [f"## {history.name}", "", "| figure | value |", "|---|---|"]
        lines += [f"| {figure.name} | {figure.value} |" for figure in figures(history)]
        lines += ["", f"![Plots of the flight]({history.name}.png)", ""]
    return "\n".join(lines)


def table(history: History) -> Table:
    """The figures of one flight as a table for the terminal."""
    made = Table("flight of", history.name)
    for figure in figures(history):
        made.add_row(figure.name, figure.value)
    return made
