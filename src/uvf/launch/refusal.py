"""How the command line answers bad input."""

from collections.abc import Iterator
from contextlib import contextmanager

import typer

from uvf.runtime.params import BadInput


@contextmanager
def bad_input_is_one_line() -> Iterator[None]:
    """Exit code 2 and the line, instead of a traceback."""
    try:
        yield
    except BadInput as error:
        typer.echo(f"uvf: {error}", err=True)
        raise typer.Exit(2) from error
