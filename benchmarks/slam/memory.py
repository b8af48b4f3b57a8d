"""Memory that a SLAM method takes in made-up open country, 2 km without a loop, seen by a lidar of 60 m.

In a process of its own; ``growth MB`` is what its peak of resident memory is above that of the started process, log included, and
``off m`` where the method has the vehicle then.
"""

import json
import sys
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.measuring.memory import in_own_process, peak_mb
from benchmarks.slam.evaluation.driven import Driven, Wear, drive, route
from benchmarks.slam.evaluation.open_country import scattered
from launch.commands.bench import Figures
from uvf.slam.methods import METHODS, make_method, method_params
from uvf.slam.reading import Beams

LIDAR = Beams((0.2, 0.0), np.radians(np.arange(-180.0, 180.0, 1.0)), 0.3, 60.0)
ROAD = np.array(((0.0, 0.0), (500.0, 0.0), (500.0, 500.0), (0.0, 500.0), (0.0, 1000.0)))  # m
EACH = 150.0  # m^2 of country with one thing in it
SPARSE = 6  # of so many sweeps, 0.72 m apart then, one is kept
EVERY = 500.0  # m driven between two rows


def country() -> Driven:
    """2 km through open country, with a sweep each SPARSE places."""
    things = scattered(ROAD, EACH, np.random.default_rng(1))
    return drive(route(ROAD)[::SPARSE], things, LIDAR, Wear(), 1)


def grown(name: str) -> Figures:
    """A row each 500 m."""
    before, driven = peak_mb(), country()
    method = make_method(name, method_params(name, {}, "defaults"))
    way = np.hypot(*np.diff(driven.map_from_base[:, :2], axis=0, prepend=0.0).T).cumsum()
    rows: Figures = {}
    for metres, true, reading in zip(way, driven.map_from_base, driven.log, strict=True):
        told = method.add(reading).map_from_base
        if metres >= EVERY * (len(rows) + 1):
            off = float(np.hypot(told[0] - true[0], told[1] - true[1]))
            rows[f"{name}, {metres:.0f} m"] = {"peak MB": peak_mb(), "growth MB": peak_mb() - before, "off m": off}
    return rows


def measure(name: str, _: Path | None = None) -> Figures:
    """Memory [MB] of one method, in a process of its own."""
    rows: Figures = in_own_process("benchmarks.slam.memory", name)
    return rows


CASES = {name: partial(measure, name) for name in METHODS}

if __name__ == "__main__":
    sys.stdout.write(json.dumps(grown(sys.argv[1])) + "\n")
