"""What there is of a minute of the run to take away, and who makes it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from uvf.runtime.log.folder import LOG_FOLDER


@dataclass(frozen=True)
class ExportState:
    """What there is of files to take away."""

    why_not: str = ""
    """Why there can be none."""
    making: str = ""
    """The kind that is being made: mcap or html."""
    name: str = ""
    path: str = ""
    """Where the page gets the last one that was made; "" where there is none."""
    size: int = 0  # bytes
    fault: str = ""
    """Why the last one could not be made."""


class Exporter(Protocol):
    """Makes files of a part of the run."""

    @property
    def state(self) -> ExportState:
        """How far it is."""
        ...

    def begin(self, kind: str, ended: float, length: float) -> None:
        """Begins with a file (mcap or html) of the ``length`` [s] that ended ``ended`` [s] ago; does nothing while it makes one."""
        ...

    def close(self) -> None:
        """Removes the files."""
        ...


class NoExporter:
    """Where nothing records the run."""

    files: Mapping[str, Path] = {}
    state = ExportState(why_not=f"nothing records this run: 'uvf up' does; or set {LOG_FOLDER} to the folder of 'uvf record'")

    def begin(self, kind: str, ended: float, length: float) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Does nothing."""
