"""Dubins and Reeds-Shepp lengths beside OMPL's, from DATA/dubins: errors over the turning radius, and what one takes.

Figures of the files have nine digits: with radii of 0.5 to 50 m that alone makes up to 2e-7 of the radius. ``end`` is how far the ends of
the paths lie from their goals, over the radius. ``single`` is one call from Python, ``batch`` one of many; both are the best of five
rounds, in wall time of one thread.
"""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from launch.commands.bench import Figures
from uvf.maths.curves.dubins_words import dubins_length, dubins_lengths, dubins_segments
from uvf.maths.curves.reeds_shepp_words import reeds_shepp_length, reeds_shepp_lengths, reeds_shepp_segments
from uvf.maths.curves.segments import MOST, Triple, end_of
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

ROUNDS = 5
LARGE = 100_000  # pairs of a batch


def best_time(run: Callable[[], object], times: int) -> float:
    """Wall time [us] of each of so many ``times`` that ``run`` stands for, in the best of ``ROUNDS``."""
    spent = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        run()
        spent.append(time.perf_counter() - begun)
    return min(spent) / times * 1e6


def compared(
    rows: Floats,
    lengths: Callable[[Floats, Floats, float], Floats],
    length: Callable[[Triple, Triple, float], float],
    segments: Callable[[Triple, Triple, float, Floats], float],
) -> dict[str, float]:
    """One row: ``rows`` (n, 8) are radius, start, goal and OMPL's length."""
    out, errors, ends = np.zeros((MOST, 2)), [], []
    for radius in np.unique(rows[:, 0]).tolist():
        these = rows[rows[:, 0] == radius]
        errors.append(np.abs(lengths(these[:, 1:4], these[:, 4:7], radius) - these[:, 7]).max() / radius)
        for row in these.tolist():
            segments((row[1], row[2], row[3]), (row[4], row[5], row[6]), radius, out)
            x, y, _ = end_of((row[1], row[2], row[3]), out)
            ends.append(np.hypot(x - row[4], y - row[5]) / radius)
    many = np.resize(rows, (LARGE, rows.shape[1]))
    starts, goals = np.ascontiguousarray(many[:, 1:4]), np.ascontiguousarray(many[:, 4:7])
    pairs = [(tuple(row[1:4]), tuple(row[4:7])) for row in rows.tolist()]
    return {
        "n": float(len(rows)),
        "largest error / radius": float(max(errors)),
        "end / radius": float(max(ends)),
        "us single": best_time(lambda: [length(start, goal, 25.0) for start, goal in pairs], len(pairs)),
        "us batch": best_time(lambda: lengths(starts, goals, 25.0), LARGE),
    }


def measure(data: Path | None) -> Figures:
    """A row for each kind of curve. Raises BadInput without the files."""
    folder = (data or Path()) / "dubins"
    figures: Figures = {}
    for name, lengths, length, segments in (
        ("dubins", lambda a, b, radius: dubins_lengths(a, b, radius)[0], dubins_length, dubins_segments),
        ("reeds_shepp", reeds_shepp_lengths, reeds_shepp_length, reeds_shepp_segments),
    ):
        path = folder / f"{name}_ompl.csv"
        if data is None or not path.is_file():
            raise BadInput(f"no {path}: give the folder of benchmark data with --data")
        figures[name] = compared(np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2), lengths, length, segments)
    return figures
