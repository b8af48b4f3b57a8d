"""Small maps drawn as text: # occupied, . free, ? unknown; the first line is the highest row."""

import numpy as np

VALUES = {"#": 100, ".": 0, "?": -1}


def drawn(text):
    """(rows, columns) int8, row 0 at the bottom."""
    lines = [line.strip() for line in text.strip().splitlines()]
    return np.array([[VALUES[c] for c in line] for line in reversed(lines)], dtype=np.int8)


def room(width, height, resolution=0.05):
    """A free room [m] with walls one cell thick, unknown outside."""
    cells = np.full((round(height / resolution), round(width / resolution)), -1, dtype=np.int8)
    cells[1:-1, 1:-1] = 100
    cells[2:-2, 2:-2] = 0
    return cells
