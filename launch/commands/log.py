"""``uvf log``: recorded runs."""

from math import inf
from pathlib import Path
from typing import Annotated

import typer

from launch import settings
from launch.refusal import bad_input_is_one_line

log_app = typer.Typer(no_args_is_help=True, help="Look at recorded runs.")


def known_log(path: Path) -> Path:
    """Resolves the path of a log or exits with one line."""
    with bad_input_is_one_line():
        return settings.log_path(path)


LogArgument = Annotated[Path, typer.Argument(help="An MCAP log.", callback=known_log)]
KeyArgument = Annotated[str, typer.Argument(help="As burger/nav/pose; * stands for one part.")]
RunArgument = Annotated[Path, typer.Argument(metavar="LOG", help="An MCAP log, or a run's folder, as runs/latest.", callback=known_log)]


@log_app.command("info")
def log_info(log: RunArgument) -> None:
    """Topics, counts, length, gaps and hash of a log."""
    from launch.commands.log_tools import describe_log

    with bad_input_is_one_line():
        describe_log(log)


@log_app.command("events")
def log_events(log: RunArgument) -> None:
    """What happened, in order: time, vehicle, severity, text, cause."""
    from launch.commands.log_contents import event_lines

    with bad_input_is_one_line():
        for line in event_lines(log):
            typer.echo(line)


@log_app.command("echo")
def log_echo(
    log: RunArgument,
    key: KeyArgument,
    count: Annotated[int, typer.Option("-n", min=0, help="Stop after so many; 0 = all.")] = 0,
) -> None:
    """Print the messages of a topic, as 'uvf topic echo' does."""
    from launch.commands.log_contents import message_lines

    with bad_input_is_one_line():
        for line in message_lines(log, key, count):
            typer.echo(line)


FromOption = Annotated[float, typer.Option("--from", min=0.0, help="Simulation time in s at which it begins.")]
ToOption = Annotated[float, typer.Option("--to", min=0.0, help="Simulation time in s at which it ends.")]


@log_app.command("cut")
def log_cut(
    log: RunArgument,
    begin: FromOption = 0.0,
    end: ToOption = inf,
    out: Annotated[Path | None, typer.Option(help="By default <log>-part.mcap.")] = None,
) -> None:
    """Save a part of a log, or of a run that is still being recorded, as a log of its own."""
    from launch.commands.log_parts import cut_log

    with bad_input_is_one_line():
        cut_log(log, begin, end, out)


@log_app.command("page")
def log_page(
    log: RunArgument,
    begin: FromOption = 0.0,
    end: ToOption = inf,
    out: Annotated[Path | None, typer.Option(help="By default <log>.html.")] = None,
) -> None:
    """Make a page of a log, or of a part of it, that plays in any browser: one file, without a server."""
    from launch.commands.log_parts import make_page

    with bad_input_is_one_line():
        make_page(log, begin, end, out)


@log_app.command("export")
def log_export(
    log: RunArgument,
    keys: Annotated[list[str] | None, typer.Argument(help="Topics, as burger/nav/pose or */truth/state; all, where none is given.")] = None,
    parquet: Annotated[bool, typer.Option("--parquet/--csv", help="Which kind of files.")] = False,
    out: Annotated[Path | None, typer.Option(help="Folder to write into; by default csv/ or parquet/ beside the log.")] = None,
) -> None:
    """Save the messages as tables for pandas, MATLAB or a spreadsheet: a file a topic, a column a field."""
    from launch.commands.log_export import export_log

    with bad_input_is_one_line():
        export_log(log, keys or [], "parquet" if parquet else "csv", out)


@log_app.command("layout")
def log_layout(
    log: RunArgument,
    out: Annotated[Path | None, typer.Option(help="By default foxglove.json beside the log.")] = None,
) -> None:
    """Save a layout for Foxglove or Lichtblick that shows this log's maps, tracks, modes and curves."""
    from launch.commands.log_export import save_layout

    with bad_input_is_one_line():
        save_layout(log, out)


@log_app.command("recover")
def log_recover(log: LogArgument, out: Annotated[Path | None, typer.Option(help="By default <log>-recovered.mcap.")] = None) -> None:
    """Save what can be saved of a log that was cut off."""
    from launch.commands.log_tools import recover_log

    with bad_input_is_one_line():
        recover_log(log, out)
