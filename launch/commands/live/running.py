"""The running system as commands of the shell ask it: what it refuses or leaves unanswered is one line and an exit code."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer

from uvf.models.yaml_data import BadInput

Vehicle = Annotated[str, typer.Argument(help="A vehicle of the running system.")]
Metre = Annotated[float, typer.Argument(help="m, world frame.")]
SOURCE = "cli"
NUMBERS = {"ignore_unknown_options": True}
"""For typer: -1.5 is a number, not an option."""


@contextmanager
def running_system() -> Iterator[Any]:
    """A ``Client``; silence, and bad input, end the command with one line and exit code 2."""
    from uvf.client import connect
    from uvf.runtime.bus.wire import Malformed

    try:
        with connect() as run:
            yield run
    except TimeoutError as error:
        later = "; while the clock is paused it is done, and answered, at the next step" if "no answer" in str(error) else ""
        typer.echo(f"uvf: {error}{later}", err=True)
        raise typer.Exit(2) from error
    except (BadInput, Malformed) as error:
        typer.echo(f"uvf: {error}", err=True)
        raise typer.Exit(2) from error


def tell_refusals(replies: list[Any]) -> None:
    """Ends the command with the reasons of those that refuse, if there are any, and exit code 1."""
    if reasons := dict.fromkeys(reply.reason for reply in replies if not reply.accepted):
        typer.echo(f"uvf: {'; '.join(reasons)}", err=True)
        raise typer.Exit(1)
