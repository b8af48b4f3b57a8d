"""What the surroundings decide: endpoints, folders and limits, each by one environment variable with a default; and what names mean.

Imports nothing heavy: a misspelt name is answered before any engine is loaded.
"""

import contextlib
import difflib
import math
import os
from pathlib import Path

from uvf.models.yaml_data import BadInput, load_yaml, nearest

ROOT = Path(__file__).resolve().parents[1]
GIGABYTE = 1_000_000_000


def runs_folder() -> Path:
    """The folder of recorded runs: UVF_RUNS, or ``runs/``."""
    return Path(os.environ.get("UVF_RUNS") or ROOT / "runs")


def runs_quota() -> float:
    """Size [bytes] that old runs may take together, from UVF_RUNS_QUOTA_GB. Raises BadInput."""
    text = os.environ.get("UVF_RUNS_QUOTA_GB") or "5"
    try:
        quota = float(text)
    except ValueError:
        quota = math.nan
    if not quota >= 0:
        raise BadInput(f"UVF_RUNS_QUOTA_GB={text}: not a number of gigabytes")
    return quota * GIGABYTE


def mission_path(name: str) -> Path:
    """The file of a mission given by its path or by its name in ``missions/``. Raises BadInput."""
    for path in (Path(name), ROOT / "missions" / f"{name}.yaml", ROOT / name):
        if path.is_file():
            return path
    _look_at(Path(name))
    if Path(name).exists():
        raise BadInput(f"{name}: is no file; name a mission file, or a mission in missions/")
    known = [p.stem for p in (ROOT / "missions").glob("*.yaml")]
    raise BadInput(f"no mission '{name}'; {nearest(Path(name).stem, known)}")


def log_path(path: Path, what: str = "log") -> Path:
    """The path of an existing log or folder of a run. Raises BadInput."""
    if path.exists():
        return path
    _look_at(path)
    close = difflib.get_close_matches(path.name, [p.name for p in path.parent.glob("*")], n=1)
    raise BadInput(f"no {what} {path}; " + (f"did you mean '{close[0]}'?" if close else f"runs are recorded in {runs_folder()}"))


def _look_at(path: Path) -> None:
    """Raises OSError for a link that leads round in a circle, which is not found either."""
    with contextlib.suppress(FileNotFoundError, NotADirectoryError):
        path.stat()


def benchmark_modules() -> dict[str, str]:
    """The module of each group of benchmarks; none where the folder is not there, as in an installed package. Raises BadInput."""
    path = ROOT / "benchmarks" / "groups.yaml"
    return load_yaml(path, dict[str, str]) if path.is_file() else {}


def benchmark_names() -> list[str]:
    """The names of the groups, for help texts: none of a file that is broken."""
    try:
        return sorted(benchmark_modules())
    except BadInput:
        return []


def benchmark_group(name: str) -> str:
    """The name of a group that is there. Raises BadInput."""
    groups = benchmark_modules()
    if name not in groups:
        raise BadInput(f"no benchmark group '{name}'; {nearest(name, groups)}")
    return name
