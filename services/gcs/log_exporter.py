"""Files of a minute of the run, made of its log in another process: the log itself, or a page that plays it."""

import contextlib
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from services.gcs.export import ExportState
from services.gcs.page.viser_replay import write_replay
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.excerpt import Span, excerpt
from uvf.runtime.log.folder import LOG_FOLDER, logs_of
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess

PATH = "/export/"
FLUSH = 1.5  # s until what has been recorded is in the file
NS = 10**9


class LogExporter:
    """Makes files of the logs in a folder, one at a time. files: those to be served, by their paths on the server."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._made = tempfile.TemporaryDirectory(prefix="uvf-export-")
        self.state = ExportState()
        self.files: dict[str, Path] = {}

    def begin(self, kind: str, ended: float, length: float) -> None:
        """As ``Exporter`` says."""
        if self.state.making:
            return
        self.state = ExportState(making=kind)
        until = time.time_ns() - round(ended * NS)
        threading.Thread(target=self._make, args=(kind, until - round(length * NS), until), daemon=True).start()

    def _make(self, kind: str, since: int, until: int) -> None:
        wait = until + round(FLUSH * NS) - time.time_ns()
        time.sleep(max(wait / NS, 0.0))
        name = time.strftime("minute-%Y-%m-%d_%H-%M-%S", time.localtime(until / NS))
        target = Path(self._made.name) / f"{name}.{kind}"
        try:
            run_in_subprocess(make_file, str(self._folder), str(target), kind, since, until)
            size = target.stat().st_size
        except (BadInput, Died, OSError) as error:
            self.state = ExportState(fault=str(error))
            return
        for old in self.files.values():
            with contextlib.suppress(OSError):
                old.unlink()
        self.files.clear()
        self.files[PATH + target.name] = target
        self.state = ExportState(name=target.name, path=PATH + target.name, size=size)

    def close(self) -> None:
        """As ``Exporter`` says."""
        self._made.cleanup()


def make_file(folder: str, target: str, kind: str, since: int, until: int) -> None:
    """Makes a file of the logs of a run in a process of its own. since, until: ns since 1970. Raises BadInput."""
    log = Path(target).with_suffix(".mcap")
    excerpt(logs_since(Path(folder), since), log, Span(since, until, recorded=True))
    if kind == "html":
        write_replay(log, Path(target))
        log.unlink()


def logs_since(folder: Path, since: int) -> Sequence[Path]:
    """Logs in their order to which something was written after ``since`` [ns since 1970]. Raises BadInput where there is none.

    Each begins with all that stood then.
    """
    if not folder.is_dir():
        raise BadInput(f"{folder}: is no folder with the log of a run; set {LOG_FOLDER} to one")
    found = [path for path in logs_of(folder) if path.stat().st_mtime_ns >= since]
    if not found:
        raise BadInput(f"{folder}: holds no log of that time")
    return found
