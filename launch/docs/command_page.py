"""``docs/reference/command-line.md``: every command with its arguments and options, from the typer application."""

from collections.abc import Iterator
from typing import Any

import typer

from launch.cli import app

HEAD = """# Command line

Generated from `launch/cli.py` and `launch/commands/` by `python -m launch.docs.pages`; do not edit.

Every command answers `--help`. An error is one line that says what is wrong, where, and how to mend it; the exit code is then 1 or 2.
"""


def render() -> str:
    """Renders the whole page."""
    return "\n".join((HEAD, *_command(typer.main.get_command(app), ""))) + "\n"


def _command(command: Any, path: str) -> Iterator[str]:
    inner = getattr(command, "commands", {})
    if not inner:
        yield from _page(command, path)
    elif path:
        yield from (f"## `uvf {path}` {{#{path}}}", "", command.help or "", "")
    for name, each in sorted(inner.items(), key=lambda item: (bool(getattr(item[1], "commands", {})), item[0])):
        yield from _command(each, f"{path} {name}".strip())


def _page(command: Any, path: str) -> Iterator[str]:
    level = "###" if " " in path else "##"
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    options = [p for p in command.params if p.param_type_name == "option" and not p.hidden and p.name != "help"]
    usage = " ".join((f"uvf {path}", *(["[OPTIONS]"] if options else []), *(_usage(a) for a in arguments)))
    yield from (f"{level} `uvf {path}` {{#{path.replace(' ', '-')}}}", "", " ".join((command.help or "").split()), "", f"`{usage}`", "")
    if arguments or options:
        yield from ("| argument or option | default | meaning |", "|---|---|---|")
        yield from (_row(_usage(a), a) for a in arguments)
        yield from (_row(_names(o), o) for o in options)
        yield ""


def _usage(argument: Any) -> str:
    name = str(argument.name).upper().replace("_", "-")
    return name if argument.required else f"[{name}]"


def _names(option: Any) -> str:
    return ", ".join([*option.opts, *option.secondary_opts]) + (f" {option.metavar}" if option.metavar else "")


def _row(name: str, parameter: Any) -> str:
    default = parameter.default
    shown = "" if default is None or default is False or callable(default) or default == [] else f"`{default}`"
    limits = " ".join((parameter.help or "").split()).replace("|", "\\|")
    return f"| `{name}` | {'required' if parameter.required else shown} | {limits} |"
