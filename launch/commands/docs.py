"""``uvf docs``: the documentation as a site, served on loopback or built into a folder."""

import os
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput

HOST = "127.0.0.1"
MKDOCS = [sys.executable, "-m", "mkdocs"]


def serve_docs(port: int) -> NoReturn:
    """Serves the site at ``http://127.0.0.1:port`` until Ctrl-C, reloading edited pages; replaces this process."""
    os.chdir(ROOT)
    os.execve(sys.executable, [*MKDOCS, "serve", "--dev-addr", f"{HOST}:{port}"], _environment())


def build_docs(folder: Path) -> int:
    """Builds the site into ``folder``; a broken link, anchor or reference is an error. Returns an exit code. Raises BadInput."""
    if folder.exists() and not folder.is_dir():
        raise BadInput(f"{folder} is a file; name a folder")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "sitemap.xml").is_file():
        raise BadInput(f"{folder} holds something else than a site, which building would delete; name an empty folder")
    command = [*MKDOCS, "build", "--strict", "--site-dir", str(folder.resolve())]
    return subprocess.run(command, cwd=ROOT, env=_environment(), check=False).returncode


def _environment() -> dict[str, str]:
    return {**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "src")])}
