"""How the command line answers bad input."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from uvf.runtime.params import BadInput

_NO_NAMES = {errno.ENAMETOOLONG: "the name is too long for a file", errno.ELOOP: "the link leads round in a circle"}
_SHOWN = 60  # characters of a name


@contextmanager
def bad_input_is_one_line() -> Iterator[None]:
    """Exit code 2 and the line, instead of a traceback."""
    try:
        yield
    except BadInput as error:
        raise _refused(str(error)) from error
    except OSError as error:
        if error.errno not in _NO_NAMES:
            raise
        name = str(error.filename)
        shown = name if len(name) <= _SHOWN else f"{name[:_SHOWN]}..."
        raise _refused(f"{shown}: {_NO_NAMES[error.errno]}; name another") from error


def _refused(why: str) -> typer.Exit:
    """Says it in one line, whatever names of files and keys hold: nothing in it is obeyed by a terminal."""
    line = " ".join(why.split())
    typer.echo("uvf: " + "".join(c if c.isprintable() else ascii(c)[1:-1] for c in line), err=True)
    return typer.Exit(2)
