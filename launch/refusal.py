"""How the command line answers bad input."""

import errno
import math
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import typer

from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.validation import escaped

_NO_NAMES = {errno.ENAMETOOLONG: "the name is too long for a file", errno.ELOOP: "the link leads round in a circle"}
_POSSIBLE = re.compile(r" \(Possible options: (.*)\)$")
_BEYOND = {"less_than_equal": ("above", "le"), "greater_than_equal": ("below", "ge")}
_NO_NUMBER = {"float_parsing": "number", "int_parsing": "whole number", "int_from_float": "whole number"}
_WORD, _SHOWN = 255, 60
"""Characters of a word: what is longer than a file's name can be is shown by its beginning."""


@contextmanager
def bad_input_is_one_line() -> Iterator[None]:
    """Turns BadInput into one line and exit code 2 instead of a traceback."""
    try:
        yield
    except BadInput as error:
        raise _refused(str(error)) from error
    except OSError as error:
        if error.errno not in _NO_NAMES:
            raise
        raise _refused(f"{_shortened(str(error.filename))}: {_NO_NAMES[error.errno]}; name another") from error


@contextmanager
def usage_is_one_line() -> Iterator[None]:
    """Turns a missing or misspelt argument, option or command into one line, and ends the process."""
    try:
        yield
    except typer.Abort as error:
        typer.echo("Aborted!", err=True)
        raise SystemExit(1) from error
    except typer.TyperException as error:
        said = _in_our_words(error).strip().replace(". Did you", "; did you")
        if said:  # else it was the help, printed already
            context = getattr(error, "ctx", None)
            command = context.command_path if context is not None else "uvf"
            _refused(f"{said[0].lower()}{said[1:].rstrip('.')}; try '{command} --help'")
        raise SystemExit(2) from error


def _in_our_words(error: typer.TyperException) -> str:
    """Typer's message; options that come near are asked about, and a number that is refused stands beside its limit."""
    said = _POSSIBLE.sub(lambda found: f"; did you mean {' or '.join(found[1].split(', '))}?", error.format_message())
    errors = getattr(error.__cause__, "errors", None)  # of pydantic, by which typer checks numbers
    ours = _of_a_number(errors()[0], getattr(getattr(error, "param", None), "metavar", None)) if errors is not None else ""
    return said.replace(str(getattr(error, "message", said)), ours) if ours else said


def _of_a_number(found: Mapping[str, Any], unit: str | None) -> str:
    """``20 m is above 5 m``; empty for what is no matter of numbers. unit: what the option's help calls its value."""
    kind, value = found["type"], found["input"]
    if kind in _NO_NUMBER:
        return f"'{value}' is no {_NO_NUMBER[kind]}"
    if kind not in _BEYOND:
        return ""
    where, key = _BEYOND[kind]
    of_unit = f" {unit}" if unit else ""
    return f"{value}{of_unit} is {where} {found['ctx'][key]:g}{of_unit}"


def within(low: float, high: float = math.inf) -> Callable[[float | None], float | None]:
    """A typer callback that accepts finite numbers from ``low`` to ``high`` [unit of the option]: typer's own limits let NaN through."""
    limits = f"at least {low:g}" if math.isinf(high) else f"from {low:g} to {high:g}"

    def checked(value: float | None) -> float | None:
        if value is not None and not (math.isfinite(value) and low <= value <= high):
            raise typer.BadParameter(f"{value:g}: give a number {limits}")
        return value

    return checked


def counted(count: int, what: str) -> str:
    """A number of things in words: ``1 fault``, ``2 faults``."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _refused(why: str) -> typer.Exit:
    """Says it in one line, whatever names of files and keys hold: nothing in it is obeyed by a terminal."""
    line = " ".join(_shortened(word) for word in why.split())
    typer.echo(f"uvf: {escaped(line)}", err=True)
    return typer.Exit(2)


def _shortened(word: str) -> str:
    return word if len(word) <= _WORD else f"{word[:_SHOWN]}..."
