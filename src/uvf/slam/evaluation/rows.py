"""Text files of a few numbers a line, as relations and trajectories are written."""

from pathlib import Path

import numpy as np

from uvf.models.yaml_data import BadInput


def rows_of(path: Path, kind: str) -> list[tuple[str, list[float]]]:
    """(place, numbers) of each line that is neither empty nor a comment; units are the file's ([s], [m], [rad]).

    The numbers are empty where one of them is none. Raises BadInput with ``kind`` where the file cannot be read.
    """
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
