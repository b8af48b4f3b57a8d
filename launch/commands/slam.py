"""``uvf slam``: a SLAM method run over a recorded log."""

from pathlib import Path
from typing import Annotated

import typer

from launch.refusal import bad_input_is_one_line

DEFAULT_METHOD = "graph"


def slam(
    log: Annotated[Path, typer.Argument(help="A CARMEN log (.clf, .log), a log of a run (.mcap) or a run's folder.")],
    method: Annotated[str, typer.Option(help="By its name, such as graph or odometry.")] = DEFAULT_METHOD,
    values: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A parameter of the method.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder of the results; by default runs/slam/LOG-METHOD.")] = None,
    vehicle: Annotated[str | None, typer.Option(help="Of a run with several.")] = None,
    relations: Annotated[Path | None, typer.Option(help="Score by this file instead of those beside the log.")] = None,
    resolution: Annotated[float, typer.Option(min=0.01, max=1.0, metavar="m", help="Side of the map's cells.")] = 0.05,
) -> None:
    """Map a recorded log: trajectory, map and report in a folder; scored by what lies beside the log."""
    from launch.slam.command import SlamJob, run_job

    with bad_input_is_one_line():
        run_job(SlamJob(log, method, tuple(values or ()), out, vehicle, relations, resolution))
