"""The folders of past runs: one a run, ``latest`` beside them, the oldest removed when they take too much."""

import shutil
import time
from pathlib import Path

from uvf.launch import settings
from uvf.runtime.params import BadInput


def new_run() -> Path:
    """Makes ``runs/<date>_<time>/`` and points ``runs/latest`` to it. Raises BadInput."""
    base = settings.runs_folder()
    stamp = time.strftime("%Y-%m-%d_%H-%M-%S")
    try:
        base.mkdir(parents=True, exist_ok=True)
        prune(base, settings.runs_quota())
        folder = next(f for n in range(1000) if not (f := base / (stamp if n == 0 else f"{stamp}-{n}")).exists())
        folder.mkdir()
        latest = base / "latest"
        latest.unlink(missing_ok=True)
        latest.symlink_to(folder.name)
    except OSError as error:
        raise BadInput(f"{base}: {error.strerror}: runs cannot be kept there; choose another folder with UVF_RUNS") from error
    return folder


def prune(base: Path, quota: float) -> list[Path]:
    """Removes the oldest runs until the rest takes less than ``quota`` bytes; the newest always stays."""
    folders = sorted((f for f in base.iterdir() if f.is_dir() and not f.is_symlink()), key=lambda f: f.name)
    sizes = {f: sum(p.stat().st_size for p in f.rglob("*") if p.is_file()) for f in folders}
    removed = []
    while len(folders) > 1 and sum(sizes[f] for f in folders) > quota:
        oldest = folders.pop(0)
        shutil.rmtree(oldest)
        removed.append(oldest)
    return removed
