"""What tests run in a process of its own."""

import ctypes
import os
from pathlib import Path

import msgspec

from uvf.models.yaml_data import BadInput
from uvf.runtime.process.quiet import c_output_discarded
from uvf.runtime.process.subprocess_jobs import run_in_subprocess


class Body(msgspec.Struct):
    name: str
    mass: float


def pid() -> int:
    return os.getpid()


def pid_of_another() -> int:
    return run_in_subprocess(pid)


def heavier(body: Body, by: float) -> tuple[Body, list[str]]:
    return Body(body.name, body.mass + by), ["heavier"]


def refuse() -> None:
    raise BadInput("a line")


def fail() -> None:
    raise KeyError("no such table")


def shout() -> int:
    os.write(1, b"much ado")
    os.write(2, b"about nothing")
    return 1


def abort() -> None:
    with c_output_discarded():
        os.write(2, b"FATAL: no such table\n")
        ctypes.CDLL(None).abort()


def leave() -> None:
    os._exit(3)


def hang(file: str) -> None:
    """In code that hears nothing, with the interpreter's lock held."""
    Path(file).write_text(str(os.getpid()))
    ctypes.PyDLL(None).pause()
