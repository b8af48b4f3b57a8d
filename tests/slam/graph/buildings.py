"""Drives through made-up buildings, and how far a method is off the truth there."""

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.slam.evaluation.building import corridors
from benchmarks.slam.evaluation.driven import Driven, Wear, drive, route
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.evaluation.run import LogRun, run_over
from uvf.slam.graph.method import GraphSlam
from uvf.slam.reading import Beams

HALF_ROUND = Beams((0.0, 0.0), np.radians(np.linspace(-90.0, 90.0, 181)), 0.1, 30.0)
SHORT = Beams((0.0, 0.0), np.radians(np.arange(360.0)), 0.1, 3.5)
BAD = Wear(0.05, -0.1, 0.02, (0.06, 0.1, 0.015))


def rectangle(width, height):
    """Centre lines of four corridors."""
    return np.array(((0.0, 0.0, width, 0.0), (width, 0.0, width, height), (width, height, 0.0, height), (0.0, height, 0.0, 0.0)))


def round_trip(size, beams=HALF_ROUND, wear=None, seed=1, tail=8.0):
    """Once around a rectangle of corridors, and ``tail`` [m] of it again."""
    (w, h), lines = size, rectangle(*size)
    corners = np.array(((0.0, 0.0), (w, 0.0), (w, h), (0.0, h), (0.0, 0.0), (tail, 0.0)))
    return drive(route(corners), corridors(lines, np.random.default_rng(seed)), beams, wear or Wear(), seed)


def bend(beams=HALF_ROUND, seed=1, readings=160):
    """Along a corridor and around its corner: no place is seen twice."""
    lines = np.array(((0.0, 0.0, 12.0, 0.0), (12.0, 0.0, 12.0, 8.0)))
    poses = route(np.array(((0.0, 0.0), (12.0, 0.0), (12.0, 8.0))))[:readings]
    return drive(poses, corridors(lines, np.random.default_rng(seed)), beams, Wear(), seed)


def changed(driven: Driven, change) -> Driven:
    """change: (number of the reading, reading) -> the reading that comes in its place."""
    readings = [change(i, reading) for i, reading in enumerate(driven.log.readings)]
    return replace(driven, log=replace(driven.log, readings=readings))


@dataclass(frozen=True)
class Mapped:
    """online, final: (n, 3) how far each pose is off, seen from the true one [m, m, rad]."""

    slam: GraphSlam
    run: LogRun
    online: np.ndarray
    final: np.ndarray

    @property
    def far_off(self):
        """m, of the final poses."""
        return float(np.hypot(self.final[:, 0], self.final[:, 1]).max())

    @property
    def turned_off(self):
        """rad, of the final poses."""
        return float(np.abs(self.final[:, 2]).max())


def mapped(driven: Driven) -> Mapped:
    slam = GraphSlam()
    run = run_over(driven.log, slam)
    back = inverted(driven.map_from_base)
    return Mapped(slam, run, composed(back, run.online), composed(back, run.final))


def false_loops(found: Mapped, driven: Driven):
    """Believed loops that tie places more than 0.5 m or 0.2 rad apart from where they are."""
    first = {}
    for i, placed in enumerate(found.slam._placed):
        first.setdefault(placed.node, i)
    true = driven.map_from_base[[first[k] for k in range(len(found.slam.nodes))]]
    rows, weights = found.slam.graph.edges.rows, found.slam.graph.weights
    loops = rows.robust & (weights > 0.5)
    i, j = rows.ends[loops].T
    off = composed(inverted(composed(inverted(true[i]), true[j])), rows.measured[loops])
    return int(((np.hypot(off[:, 0], off[:, 1]) > 0.5) | (np.abs(off[:, 2]) > 0.2)).sum())
