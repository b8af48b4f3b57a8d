"""How much memory a process has taken at most, and processes that are measured alone."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from uvf.models.scenario import ROOT


def peak_mb() -> float:
    """Peak of resident memory of this process so far (Linux)."""
    found = re.search(r"VmHWM:\s+(\d+)", Path("/proc/self/status").read_text())
    return int(found[1]) / 1e3 if found else 0.0


def in_own_process(module: str, *arguments: str) -> Any:
    """What ``python -m MODULE ARGUMENTS`` has printed as JSON on its last line."""
    done = subprocess.run((sys.executable, "-m", module, *arguments), cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])
