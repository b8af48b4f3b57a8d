"""RRT* with a Dubins vehicle on two city maps of DATA/movingai, beside OMPL's RRTstar in the same wall time.

A cell is a metre. The vehicle is a point that turns no tighter than ``RADIUS``; start and goal are drawn on cells that a wide way joins,
with headings that leave room to drive on. Both have the same state space and the same ground: a point is free where its cell is.
OMPL runs as its Python wheel offers it: a Python function says whether a state is valid, which is most of its time, its settings are the
defaults, it looks at states ``RESOLUTION`` m apart, and the wheel has no seed for its planners. Own time includes all preparation but
the field of clearances.
``success %``: of all pairs and seeds; ``held %``: of the ways found, those that are free at every tenth of a metre and never turn
tighter, by a check that knows neither planner; ``median / line``: median of the length over the distance, of all that was found;
``both / line``: the same of pairs and seeds where either planner found a way; ``peer``: own length over OMPL's there, median.
``cut short`` is the own way after ``CUTS`` tries to cut it short, in the same time. Without OMPL its rows are left out.
"""

import importlib
import itertools
import sys
import time
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from math import cos, dist, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from launch.commands.bench import Figures
from uvf.maths.curves.dubins_words import dubins_segments
from uvf.maths.curves.segments import MOST, Triple, sampled
from uvf.models.yaml_data import BadInput
from uvf.planning.sampling import Budget, Ground, clearance_field, disc, dubins, rrt_star, shortened

Floats = NDArray[np.float64]
Way = tuple[float, Floats]
"""Length [m], and configurations (n, 3) at a tenth of a cell."""

MAPS = ("Berlin_0_256", "Boston_2_512")
RADIUS = 4.0  # m
RESOLUTION = 0.5  # m
SECONDS = 1.0
PAIRS, SEEDS = 8, 2
ROOM = 2.0  # m about start and goal
APART = 0.4  # of the map's side, at least
CUTS = 300
ENDLESS = 10**9  # iterations


def read_map(path: Path) -> NDArray[np.bool_]:
    """Which cells (rows, columns) of a Moving AI map are occupied. Raises BadInput without the file."""
    if not path.is_file():
        raise BadInput(f"no {path}: give the folder of benchmark data with --data")
    lines = path.read_text().splitlines()[4:]
    return np.array([[letter not in ".G" for letter in line] for line in lines])


def pairs(ground: Ground, count: int) -> list[tuple[Triple, Triple]]:
    """Starts and goals far apart with ``ROOM`` about them and free ground ahead of the start and behind the goal."""
    rng, found = np.random.default_rng(7), list[tuple[Triple, Triple]]()
    values = ground.field.values
    cells = np.argwhere(values > ROOM)
    while len(found) < count:
        (r0, c0), (r1, c1) = cells[rng.integers(len(cells), size=2)].tolist()
        start = (c0 + 0.5, r0 + 0.5, float(rng.uniform(-pi, pi)))
        goal = (c1 + 0.5, r1 + 0.5, float(rng.uniform(-pi, pi)))
        if dist(start[:2], goal[:2]) < APART * max(values.shape) or not (_ahead(values, start, 1.0) and _ahead(values, goal, -1.0)):
            continue
        if rrt_star(ground, dubins(RADIUS), (start, goal), Budget(0), 0).reason.startswith("no way was found"):
            found.append((start, goal))
    return found


def _ahead(values: NDArray[np.float32], at: Triple, direction: float) -> bool:
    for s in np.arange(0.0, 2.0 * RADIUS, 0.5) * direction:
        row, column = int(at[1] + s * sin(at[2])), int(at[0] + s * cos(at[2]))
        if not (0 <= row < values.shape[0] and 0 <= column < values.shape[1] and values[row, column] > 0.0):
            return False
    return True


def own(ground: Ground, cuts: int, query: tuple[Triple, Triple], seed: int) -> Way | None:
    """By UVF, with so many tries to cut the way short."""
    space, until = dubins(RADIUS), time.perf_counter() + SECONDS
    path = rrt_star(ground, space, query, Budget(ENDLESS, SECONDS - (0.05 if cuts else 0.0)), seed).path
    if path is None:
        return None
    if cuts and time.perf_counter() < until:
        path = shortened(ground, space, path, cuts, seed)
    return path.length, path.sampled(0.1)[:, :3]


def ompl(ground: Ground, query: tuple[Triple, Triple], seed: int) -> Way | None:
    """By OMPL's Python wheel, as its own examples use it; only where there is one."""
    base, geometric, util = (importlib.import_module(f"ompl.{part}") for part in ("base", "geometric", "util"))
    util.setLogLevel(util.LOG_ERROR)
    free, (rows, columns) = (ground.field.values > 0.0).tolist(), ground.field.values.shape
    space, bounds = base.DubinsStateSpace(RADIUS), base.RealVectorBounds(2)
    for axis, high in enumerate((columns, rows)):
        bounds.setLow(axis, 0.0)
        bounds.setHigh(axis, float(high))
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)

    def is_valid(state: Any) -> bool:
        x, y = state.getX(), state.getY()
        return 0.0 <= x < columns and 0.0 <= y < rows and bool(free[int(y)][int(x)])

    setup.setStateValidityChecker(is_valid)
    ends = []
    for x, y, heading in query:
        state = space.allocState()
        state.setX(x)
        state.setY(y)
        state.setYaw(heading)
        ends.append(state)
    setup.setStartAndGoalStates(*ends, 1e-3)
    information = setup.getSpaceInformation()
    information.setStateValidityCheckingResolution(RESOLUTION / space.getMaximumExtent())
    setup.setPlanner(geometric.RRTstar(information))
    setup.solve(SECONDS)
    if not setup.haveExactSolutionPath():
        return None
    path = setup.getSolutionPath()
    states = [(s.getX(), s.getY(), s.getYaw()) for s in path.getStates()]
    parts, curve = [], np.zeros((MOST, 2))
    for a, b in itertools.pairwise(states):
        length = dubins_segments(a, b, RADIUS, curve)
        parts.append(sampled(a, curve, np.linspace(0.0, length, max(int(np.ceil(length / 0.1)), 1) + 1))[:, :3])
    return float(path.length()), np.vstack(parts)


def holds(ground: Ground, query: tuple[Triple, Triple], way: Floats) -> bool:
    """Whether configurations (n, 3) lie on free cells, turn no tighter than allowed, and lead from the start to the goal."""
    on_free = (ground.field.values[way[:, 1].astype(int), way[:, 0].astype(int)] > 0.0).all()
    steps = np.hypot(*np.diff(way[:, :2], axis=0).T)
    turns = np.abs(np.remainder(np.diff(way[:, 2]) + pi, 2 * pi) - pi)
    turns_enough = (turns <= steps / RADIUS * 1.001 + 1e-6).all() and steps.max(initial=0.0) <= 0.1001
    off = [dist(way[i, :2], end[:2]) for i, end in ((0, query[0]), (-1, query[1]))]
    return bool(on_free and turns_enough and max(off) < 2e-3)


def city(name: str, data: Path | None) -> Figures:
    """A row for each planner on one map."""
    occupied = read_map((data or Path()) / "movingai" / "maps" / "cities" / f"{name}.map")
    ground = Ground(clearance_field(occupied, 1.0), disc(0.0))
    queries = [(query, seed) for query in pairs(ground, PAIRS) for seed in range(SEEDS)]
    planners: dict[str, Callable[[tuple[Triple, Triple], int], Way | None]] = {
        "RRT*": partial(own, ground, 0),
        "RRT*, cut short": partial(own, ground, CUTS),
    }
    if find_spec("ompl") is None:
        sys.stderr.write("uvf: no OMPL: its rows are left out (pip install ompl)\n")
    else:
        ompl(ground, queries[0][0], 0)  # once, so that loading it takes none of the time
        planners["OMPL RRTstar"] = partial(ompl, ground)
    own(ground, CUTS, *queries[0])
    ways = {planner: [find(*asked) for asked in queries] for planner, find in planners.items()}
    peer = ways.get("OMPL RRTstar", [])
    return {f"{name}: {planner}": _row(ground, queries, found, peer) for planner, found in ways.items()}


def _row(
    ground: Ground, queries: list[tuple[tuple[Triple, Triple], int]], found: list[Way | None], peer: list[Way | None]
) -> dict[str, float]:
    lines = [dist(query[0][:2], query[1][:2]) for query, _ in queries]
    solved = [(way, query, line) for way, (query, _), line in zip(found, queries, lines, strict=True) if way]
    row = {
        "runs": float(len(queries)),
        "success %": 100.0 * len(solved) / len(queries),
        "held %": 100.0 * float(np.mean([holds(ground, query, way[1]) for way, query, _ in solved])) if solved else np.nan,
        "median / line": float(np.median([way[0] / line for way, _, line in solved])) if solved else np.nan,
    }
    both = [(a[0], b[0], line) for a, b, line in zip(found, peer, lines, strict=False) if a and b]
    if both:
        row["both / line"] = float(np.median([a / line for a, _, line in both]))
        row["peer"] = float(np.median([a / b for a, b, _ in both]))
    return row


CITIES = {name: partial(city, name) for name in MAPS}
"""The cases."""
