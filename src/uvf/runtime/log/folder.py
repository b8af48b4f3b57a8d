"""Where the logs of a run are, the one that is being recorded and those of the past."""

import os
import re
from collections.abc import Mapping
from pathlib import Path

from uvf.models.yaml_data import BadInput
from uvf.runtime.log.reading import restarts_of

LOG_FOLDER = "UVF_LOG_FOLDER"
RECOVERED = "recovered"
_LOG = re.compile(r"log-(\d+)\.mcap")


def log_folder(environment: Mapping[str, str] = os.environ) -> Path | None:
    """The folder with the run's logs, by UVF_LOG_FOLDER; None where nothing is said of one."""
    text = environment.get(LOG_FOLDER, "")
    return Path(text) if text else None


def run_folder(run: Path) -> Path:
    """The folder of a run that is named by its folder or by one of its logs."""
    return run if run.is_dir() else run.parent


def log_name(number: int) -> str:
    """The name of a run's log by its number, from 0."""
    return f"log-{number:03}.mcap"


def next_number(folder: Path) -> int:
    """One more than the number of the folder's newest log; numbers of removed logs are not reused."""
    return 1 + max((int(m[1]) for p in folder.glob("*.mcap") if (m := _LOG.fullmatch(p.name))), default=-1)


def logs_of(run: Path) -> list[Path]:
    """The files of a run's folder in their order, or the one log that is named. Raises BadInput.

    Where the simulation was reset, those since then: what was before is found by the names of its files. One that was recovered stands
    for the broken one; parts that were cut out are found by their names, too.
    """
    if not run.is_dir():
        return [run]
    numbered = sorted((p for p in run.iterdir() if _LOG.fullmatch(p.name)), key=lambda p: (len(p.name), p.name))
    found = [_best(log) for log in numbered]
    if not found:
        raise BadInput(f"{run}: no log-*.mcap in this folder: name the folder of a run or a log")
    restarts = [restarts_of(log) for log in found]
    return [log for log, count in zip(found, restarts, strict=True) if count == restarts[-1]]


def _best(log: Path) -> Path:
    """The log, or what was recovered of it since it was last written."""
    recovered = recovered_path(log)
    return recovered if recovered.is_file() and recovered.stat().st_mtime >= log.stat().st_mtime else log


def recovered_path(log: Path) -> Path:
    """Where the readable part of a log that was cut off is saved."""
    return log.with_name(f"{log.stem}-{RECOVERED}.mcap")


def refuse_log(target: Path, what: str) -> None:
    """Raises BadInput where ``what`` is to be written over a log."""
    if target.suffix == ".mcap":
        raise BadInput(f"--out {target}: {what} is no log; give it another ending")
