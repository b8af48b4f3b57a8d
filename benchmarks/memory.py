"""How much memory a process has taken at most."""

import re
from pathlib import Path


def peak_mb() -> float:
    """Peak of resident memory of this process so far (Linux)."""
    found = re.search(r"VmHWM:\s+(\d+)", Path("/proc/self/status").read_text())
    return int(found[1]) / 1e3 if found else 0.0
