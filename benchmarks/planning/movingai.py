"""Global planners on Moving AI's grids, every query of every scenario that the data folder holds.

Times are CPU time of the planning thread, so that what else the machine does counts little. A row a map, one for each size of maps, one
for all: ``optimal %`` of the queries have the length that the scenario states (within 1e-4 of it, or 0.006 where the file rounds),
``lost`` were not answered, ``ms`` is the mean, ``p99 ms`` of A*. ``shut %`` of drawn pairs that no way joins were refused as such.
``theta %`` is by how much Theta*'s paths are longer than the shortest path there is, of which ``theta n`` queries tell: the visibility
graph's, which bends at obstacles' very corners where Theta* bends at centres of cells, half a diagonal away.
Then a row for each planner by name, with a turning radius of 2 cells, on the map nearest to ``MIDDLE`` cells: ``ratio`` is the mean length
over the shortest path's.
"""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.measuring.timing import on_thread
from benchmarks.planning.grid_maps import Scenario, scenarios
from launch.commands.bench import Figures
from launch.commands.bench_selection import Selection
from uvf.planning.costmap.inflation import cost_factors
from uvf.planning.global_planners.planner import GlobalPathPlanner, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planners import PLANNERS, make_global_planner
from uvf.planning.search.grid_search import GridPath, GridSearch

Cell = tuple[int, int]
Search = Callable[[Cell, Cell], GridPath | None]

RELATIVE, ROUNDED = 1e-4, 0.006
"""Share of the length; cells, of files that state lengths with two decimals."""
ANY_ANGLE = 25  # queries a map for Theta*
SECONDS = 1.0
"""For a shortest path; on maps with ten thousands of corners it takes longer, and only what is found in time is counted."""
SHUT = 20  # pairs a map that no way joins
MIDDLE = 256 * 256
QUERIES = 20  # for each planner by name
SIZES = ((100_000, "up to 100k cells"), (200_000, "up to 200k cells"), (10**9, "more cells"))
FLAT = GlobalPlannerSettings(cost_travel_multiplier=0.0, minimum_turning_radius=2.0)


def measure(selection: Selection, data: Path | None) -> Figures:
    """All rows. Raises BadInput."""
    rows: Figures = {}
    every = list(scenarios(data))
    raw = {(one.family, one.name): _of_map(one) for one in every}
    for one in every:
        rows[f"movingai: {one.family}/{one.name}"] = _row([raw[one.family, one.name]]) | {"cells": float(one.cells.size)}
    low = 0
    for high, name in SIZES:
        if some := [raw[one.family, one.name] for one in every if low < one.cells.size <= high]:
            rows[f"movingai: {name}"] = _row(some)
        low = high
    rows["movingai: all"] = _row(list(raw.values()))
    return rows | _by_name(min(every, key=lambda one: abs(one.cells.size - MIDDLE)))


def _of_map(one: Scenario) -> dict[str, list[float]]:
    """What each query has given."""
    costs, factors = one.costmap(), cost_factors(0.0)
    grid = GridSearch(costs.values, factors)
    raw: dict[str, list[float]] = {name: [] for name in ("astar", "astar ok", "jps", "jps ok", "lost", "theta", "shut")}
    tolerance = np.maximum(RELATIVE * one.lengths, ROUNDED)
    for name, search in (("astar", grid.astar), ("jps", grid.jump_points)):
        search(_cell(one.ends[-1, :2]), _cell(one.ends[-1, 2:]))
        for ends, length, slack in zip(one.ends, one.lengths, tolerance, strict=True):
            ms, found = on_thread(partial(search, _cell(ends[:2]), _cell(ends[2:])))
            raw[name].append(ms)
            raw[f"{name} ok"].append(float(found is not None and abs(found.cost - length) <= slack))
            raw["lost"].append(float(found is None))
    raw["theta"] = _theta(one, any_angle=make_global_planner("theta_star", costs, FLAT))
    raw["shut"] = _shut(one, make_global_planner("astar", costs, FLAT))
    return raw


def _theta(one: Scenario, any_angle: GlobalPathPlanner) -> list[float]:
    """By how many per cent Theta* is longer than the shortest path."""
    exact, excess = make_global_planner("visibility_graph", one.costmap(), FLAT), list[float]()
    for asked in _spread(one, ANY_ANGLE):
        query = replace(asked, seconds=SECONDS)
        shortest, found = exact.plan(query).length, any_angle.plan(query).length
        if 0.0 < shortest < np.inf:
            excess.append(100.0 * (found / shortest - 1.0))
    return excess


def _shut(one: Scenario, planner: GlobalPathPlanner) -> list[float]:
    """Whether each pair of passable cells that no way joins is refused as such. The parts are found by a search to everywhere."""
    rng, refused = np.random.default_rng(1), list[float]()
    ways = GridSearch(one.costmap().values, cost_factors(0.0)).cost_to_go(_cell(one.ends[0, :2]))
    here, apart = np.argwhere(np.isfinite(ways.cost)), np.argwhere(np.isinf(ways.cost) & (one.cells == 0))
    for _ in range(SHUT if len(apart) else 0):
        pair = [_pose(cells[rng.integers(len(cells))]) for cells in (here, apart)]
        refused.append(float(planner.plan(PathQuery(pair[0], pair[1])).refusal is Refusal.NO_VALID_PATH))
    return refused


def _row(parts: list[dict[str, list[float]]]) -> dict[str, float]:
    def of(name: str) -> list[float]:
        return [value for part in parts for value in part[name]]

    row = {
        "queries": float(len(of("astar"))),
        "lost": sum(of("lost")),
        "A* optimal %": 100.0 * float(np.mean(of("astar ok"))),
        "A* ms": float(np.mean(of("astar"))),
        "p99 ms": float(np.percentile(of("astar"), 99)),
        "JPS optimal %": 100.0 * float(np.mean(of("jps ok"))),
        "JPS ms": float(np.mean(of("jps"))),
    }
    if theta := of("theta"):
        row |= {"theta %": float(np.mean(theta)), "theta worst %": max(theta), "theta n": float(len(theta))}
    if shut := of("shut"):
        row |= {"shut %": 100.0 * float(np.mean(shut))}
    return row


def _by_name(one: Scenario) -> Figures:
    costs, rows = one.costmap(), Figures()
    queries = _spread(one, QUERIES)
    shortest = [make_global_planner("visibility_graph", costs, FLAT).plan(query).length for query in queries]
    for name in PLANNERS:
        begun = time.thread_time()
        planner = make_global_planner(name, costs, FLAT)
        planner.plan(queries[0])
        prepared, lengths, taken = 1e3 * (time.thread_time() - begun), [], []
        for query in queries:
            ms, found = on_thread(partial(planner.plan, query))
            lengths.append(found.length)
            taken.append(ms)
        ratios = [a / b for a, b in zip(lengths, shortest, strict=True) if np.isfinite(a)]
        rows[f"movingai: {one.name}: {name}"] = {
            "queries": float(len(queries)),
            "success %": 100.0 * len(ratios) / len(queries),
            "ratio": float(np.mean(ratios)) if ratios else np.nan,
            "ms": float(np.mean(taken)),
            "worst ms": max(taken),
            "first ms": prepared,
        }
    return rows


def _spread(one: Scenario, count: int) -> list[PathQuery]:
    """Queries evenly over a scenario, whose lengths grow."""
    chosen = np.unique(np.linspace(0, len(one.ends) - 1, count + 1).astype(int)[1:])
    return [PathQuery(_pose(one.ends[k, :2]), _pose(one.ends[k, 2:])) for k in chosen]


def _pose(cell: NDArray[np.int64]) -> tuple[float, float, float]:
    return float(cell[1]) + 0.5, float(cell[0]) + 0.5, 0.0


def _cell(cell: NDArray[np.int64]) -> Cell:
    return int(cell[0]), int(cell[1])
