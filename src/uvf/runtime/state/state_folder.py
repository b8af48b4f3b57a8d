"""What outlives a run and belongs to this machine: keys, settings made over MAVLink. One folder, files that only the owner reads."""

import os
from collections.abc import Mapping
from pathlib import Path

from uvf.models.scenario import ROOT

STATE = "UVF_STATE"
PRIVATE = 0o600


def state_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """Folder of what outlives a run: UVF_STATE, by default ``state/`` beside ``runs/``; need not exist."""
    return Path(environment.get(STATE, str(ROOT / "state")))


def write_private(path: Path, data: bytes) -> None:
    """Replaces a file whole, readable by its owner alone (mode 0600). Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.part")
    part.unlink(missing_ok=True)
    with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, PRIVATE), "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)
