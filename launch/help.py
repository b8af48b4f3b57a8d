"""Help texts: what typer would print of itself and nobody can use is left out."""

from typing import Any

import typer

NO_TYPE = ""  # shown in the column of the types


def without_types_of_flags(command: Any) -> Any:
    """The command with all below it; options that take no value say no type, as ``<bool>``."""
    context = typer.Context(command)
    for parameter in command.get_params(context):
        if getattr(parameter, "is_flag", False):
            parameter.metavar = NO_TYPE
    for each in getattr(command, "commands", {}).values():
        without_types_of_flags(each)
    return command
