"""Where the logs of a run are, the one that is being recorded and those of the past."""

import os
from collections.abc import Mapping
from pathlib import Path

from uvf.models.yaml_data import BadInput
from uvf.runtime.log.reading import restarts_of

LOG_FOLDER = "UVF_LOG_FOLDER"


def log_folder(environment: Mapping[str, str] = os.environ) -> Path | None:
    """The folder with the run's logs, by UVF_LOG_FOLDER; None where nothing is said of one."""
    text = environment.get(LOG_FOLDER, "")
    return Path(text) if text else None


def run_folder(run: Path) -> Path:
    """The folder of a run that is named by its folder or by one of its logs."""
    return run if run.is_dir() else run.parent


def logs_of(run: Path) -> list[Path]:
    """The files of a run's folder in their order, or the one log that is named. Raises BadInput.

    Where the simulation was reset, those since then: what was before is found by the names of its files.
    """
    if not run.is_dir():
        return [run]
    found = sorted(run.glob("log-*.mcap"), key=lambda p: (len(p.name), p.name))
    if not found:
        raise BadInput(f"{run}: no log-*.mcap in this folder: name the folder of a run or a log")
    restarts = [restarts_of(log) for log in found]
    return [log for log, count in zip(found, restarts, strict=True) if count == restarts[-1]]
