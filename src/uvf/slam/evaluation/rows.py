"""Text files of a few numbers a line, as relations and trajectories are written."""

from pathlib import Path

import numpy as np

from uvf.models.yaml_data import BadInput


def rows_of(path: Path, kind: str) -> list[tuple[str, list[float]]]:
    """(place, numbers) of each line that is neither empty nor a comment; no numbers where one is none. Raises BadInput for ``kind``."""
    try:
        lines = path.read_text(encoding="ascii", errors="replace").splitlines()
    except OSError as error:
        raise BadInput(f"{kind} {path}: {error.strerror}") from error
    return [(f"{path}:{n}", _numbers(line)) for n, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]


def _numbers(line: str) -> list[float]:
    try:
        numbers = [float(word) for word in line.split()]
    except ValueError:
        return []
    return numbers if np.isfinite(numbers).all() else []
