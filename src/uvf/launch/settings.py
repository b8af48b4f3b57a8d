"""What the surroundings decide: endpoints, folders and limits, each by one environment variable with a default."""

import os
from pathlib import Path

from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import ROOT

GIGABYTE = 1_000_000_000


def runs_folder() -> Path:
    return Path(os.environ.get("UVF_RUNS", str(ROOT / "runs")))


def runs_quota() -> float:
    """Bytes that old runs may take together. Raises BadInput."""
    text = os.environ.get("UVF_RUNS_QUOTA_GB", "5")
    try:
        return float(text) * GIGABYTE
    except ValueError as error:
        raise BadInput(f"UVF_RUNS_QUOTA_GB={text}: not a number of gigabytes") from error


def mission_path(name: str) -> Path:
    """A mission by its file's path or by its name in ``missions/``. Raises BadInput."""
    for path in (Path(name), ROOT / "missions" / f"{name}.yaml", ROOT / name):
        if path.is_file():
            return path
    known = [p.stem for p in (ROOT / "missions").glob("*.yaml")]
    raise BadInput(f"no mission '{name}'; {nearest(Path(name).stem, known)}")
