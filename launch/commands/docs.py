"""``uvf docs``: the documentation as a site, served on loopback or built into a folder."""

import os
import subprocess
import sys
from pathlib import Path

from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput

HOST = "127.0.0.1"


def serve_docs(port: int) -> int:
    """Serves the site at ``http://127.0.0.1:port`` until Ctrl-C; a page that is edited is shown anew. Returns an exit code."""
    return _mkdocs("serve", "--dev-addr", f"{HOST}:{port}")


def build_docs(folder: Path) -> int:
    """Builds the site into ``folder``; a broken link, anchor or reference is an error. Returns an exit code."""
    if folder.exists() and not folder.is_dir():
        raise BadInput(f"{folder} is a file; name a folder")
    if folder.is_dir() and any(folder.iterdir()) and not (folder / "sitemap.xml").is_file():
        raise BadInput(f"{folder} holds something else than a site, which building would delete; name an empty folder")
    return _mkdocs("build", "--strict", "--site-dir", str(folder.resolve()))


def _mkdocs(*arguments: str) -> int:
    settings = {**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "src")])}
    try:
        return subprocess.run([sys.executable, "-m", "mkdocs", *arguments], cwd=ROOT, env=settings, check=False).returncode
    except KeyboardInterrupt:
        return 0
