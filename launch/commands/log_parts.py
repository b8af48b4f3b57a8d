"""What ``uvf log cut`` and ``uvf log page`` make of a recorded run: a part of its log, a page that plays it."""

import tempfile
from math import isinf
from pathlib import Path

import typer

from services.gcs.page.viser_replay import write_replay
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.excerpt import Span, excerpt
from uvf.runtime.log.folder import logs_of, refuse_log
from uvf.runtime.messages.step_times import NS

END = 2**63


def cut_log(run: Path, begin: float, end: float, out: Path | None) -> None:
    """Saves what a log, or all logs of a run's folder, have of a span [s, simulation] into ``out`` or beside it. Raises BadInput."""
    target = out or _beside(run, "-part.mcap")
    count = excerpt(logs_of(run), target, _span(begin, end))
    typer.echo(f"{count} messages saved into {target}")


def make_page(run: Path, begin: float, end: float, out: Path | None) -> None:
    """Writes the page that plays a span [s, simulation] of a run to ``out`` or beside it. Raises BadInput."""
    target = out or _beside(run, ".html")
    refuse_log(target, "a page")
    with tempfile.TemporaryDirectory() as folder:
        part = Path(folder) / "part.mcap"
        excerpt(logs_of(run), part, _span(begin, end))
        try:
            write_replay(part, target)
        except OSError as error:
            raise BadInput(f"{target}: {error.strerror}: choose another place") from error
    typer.echo(f"{target}: {target.stat().st_size / 1e6:.1f} MB; opens in any browser")


def _beside(run: Path, ending: str) -> Path:
    return run / f"run{ending}" if run.is_dir() else run.with_name(f"{run.stem}{ending}")


def _span(begin: float, end: float) -> Span:
    if end <= begin:
        raise BadInput(f"--to {end:g}: is not after --from {begin:g}")
    return Span(round(begin * NS), END if isinf(end) else round(end * NS))
