"""The folders of past runs: one a run, ``latest`` beside them, the oldest removed when they take too much."""

import contextlib
import fcntl
import os
import re
import shutil
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from launch import settings
from uvf.models.yaml_data import BadInput

HELD = ".held"
_RUN = re.compile(r"(\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d)(?:-(\d+))?")


def new_run() -> Path:
    """Makes ``runs/<date>_<time>/``, marks it as in use and points ``runs/latest`` to it. Raises BadInput."""
    base = settings.runs_folder()
    stamp = time.strftime("%Y-%m-%d_%H-%M-%S")
    try:
        base.mkdir(parents=True, exist_ok=True)
        prune(base, settings.runs_quota())
        folder = _make(base, stamp)
        hold(folder)
        _point(base / "latest", folder)
    except OSError as error:
        raise BadInput(f"{base}: {error.strerror}: runs cannot be kept there; choose another folder with UVF_RUNS") from error
    return folder


@contextlib.contextmanager
def given_up_when_refused(folder: Path) -> Iterator[None]:
    """Removes the folder of a run that is refused before anything was recorded; ``latest`` is the run before it again."""
    try:
        yield
    except BadInput:
        base = settings.runs_folder()
        if folder.parent == base and not any(folder.rglob("*.mcap")):
            shutil.rmtree(folder, ignore_errors=True)
            (base / "latest").unlink(missing_ok=True)
            if before := _runs(base):
                _point(base / "latest", before[-1])
        raise


def _make(base: Path, stamp: str) -> Path:
    """Another run may begin in the same second."""
    for n in range(1000):
        folder = base / (stamp if n == 0 else f"{stamp}-{n}")
        with contextlib.suppress(FileExistsError):
            folder.mkdir()
            return folder
    raise FileExistsError(0, "a thousand runs in one second", str(base))


def _point(link: Path, folder: Path) -> None:
    """Replaced in one move, for another run may do the same now."""
    made = link.with_name(f"{link.name}.{os.getpid()}")
    made.unlink(missing_ok=True)
    made.symlink_to(folder.name)
    made.replace(link)


def hold(folder: Path) -> int:
    """Marks a folder as one that a living process writes to; closing the returned descriptor releases it.

    It is a lock, not a process number: the system releases it however the process ends, and it holds between containers.
    Raises OSError when nothing can be written there.
    """
    descriptor = os.open(folder / HELD, os.O_RDWR | os.O_CREAT, 0o644)
    with contextlib.suppress(OSError):  # a file system without locks: there nothing is ever removed
        fcntl.flock(descriptor, fcntl.LOCK_SH)
    return descriptor


def keep_quota(folder: Path, limit: float) -> list[Path]:
    """Removes the oldest runs beside ``folder``, then its own oldest logs; returns what was removed.

    limit [bytes]: that all runs may take together, or ``folder`` alone where it is no folder of a run.
    """
    base = settings.runs_folder().resolve()
    if folder.resolve().parent != base:
        return list(_remove_logs(folder, _size([folder]) - limit))
    removed = prune(base, limit)
    return removed + list(_remove_logs(folder, _size(_runs(base)) - limit))


def prune(base: Path, quota: float) -> list[Path]:
    """Removes the oldest runs until the rest takes at most ``quota`` [bytes]; returns the removed folders.

    Kept are the newest run, runs held by a living process, and everything else there that is no run.
    """
    folders = _runs(base)
    sizes = {folder: _size([folder]) for folder in folders}
    removed = []
    for folder in folders[:-1]:
        if sum(sizes.values()) <= quota:
            break
        if _remove(folder):
            del sizes[folder]
            removed.append(folder)
    return removed


def _runs(base: Path) -> list[Path]:
    """Oldest first."""
    if not base.is_dir():
        return []
    found = [(match[1], int(match[2] or 0), f) for f in base.iterdir() if (match := _RUN.fullmatch(f.name)) and f.is_dir()]
    return [folder for *_, folder in sorted(found)]


def _remove(folder: Path) -> bool:
    """False for a folder that somebody holds, or that belongs to another user."""
    try:
        descriptor = os.open(folder / HELD, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        shutil.rmtree(folder)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return True


def _remove_logs(folder: Path, surplus: float) -> Iterator[Path]:
    """The oldest logs of a run until ``surplus`` bytes are gone; the newest stays."""
    for log in sorted(folder.glob("log-*.mcap"), key=lambda p: (len(p.name), p.name))[:-1]:
        if surplus <= 0:
            return
        with contextlib.suppress(OSError):
            surplus -= log.stat().st_size
            log.unlink()
            yield log


def _size(folders: Iterable[Path]) -> int:
    """Bytes in all files below; what another process removes meanwhile counts nothing."""
    total = 0
    for folder in folders:
        for where, _, names in os.walk(folder):
            for name in names:
                with contextlib.suppress(OSError):
                    total += os.stat(os.path.join(where, name), follow_symlinks=False).st_size  # noqa: PTH116, PTH118
    return total
