"""Global planners on the maps of Nav2's planner benchmark, and whatever else DATA/nav_maps has with a YAML file.

Times are CPU time of the planning thread. Pairs are drawn as Nav2 draws them: more than 3 m apart, on cells of a cost of 210 at most.
``A*`` weighs costs; ``75 m`` are pairs whose A* path is 70 to 80 m long, for A* and for Theta*.
Hybrid-A* drives a vehicle of 0.51 x 0.43 m that turns no tighter than 0.4 m over squares cut out of the maps, with as many cells as those
of Nav2's figures, from pose to pose with headings of chance, which are at least half a side apart and joined: ``success %`` of all,
``held %`` of the paths pass a check of outline and turns that knows no planner; ``failed ms`` is the mean of queries without a path.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.measuring.timing import on_thread
from benchmarks.planning.driven_check import DrivenCheck
from benchmarks.planning.grid_maps import RosMap, ros_maps
from launch.commands.bench import Figures
from launch.commands.bench_selection import Selection
from uvf.planning.costmap.costmap import Costmap, make_costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.global_planners.planner import GlobalPathPlanner, GlobalPlannerSettings, PathQuery, Refusal
from uvf.planning.global_planners.planners import make_global_planner

Pose = tuple[float, float, float]

INFLATION = Inflation(0.7, 3.0)
ROUND = RobotFootprint.circle(0.22)
CAR = RobotFootprint.polygon(np.array(((0.254, 0.216), (0.254, -0.216), (-0.254, -0.216), (-0.254, 0.216))))
SETTINGS = GlobalPlannerSettings(cost_travel_multiplier=2.0, minimum_turning_radius=0.4)

COSTLIEST, APART = 210, 3.0  # m
PAIRS, LONG_PAIRS, MOST_DRAWN = 100, 20, 400
LONG = (70.0, 80.0)  # m
SQUARES = (384, 587)
"""Cells on a side: 147 456 cells, and 344 569."""
CUTS, QUERIES = 4, 12
"""Squares of each map and size, and queries on each."""
HYBRID = ("hybrid_astar_dubins", "hybrid_astar_reeds_shepp")


class Answer(NamedTuple):
    """CPU time of a query [ms], length of the path [m] (inf: none), and whether it held (NaN: none)."""

    ms: float
    length: float
    held: float


def measure(selection: Selection, data: Path | None) -> Figures:
    """All rows. Raises BadInput."""
    maps, rows = ros_maps(data), Figures()
    for one in maps:
        rows |= _by_grid(one)
    for name in HYBRID:
        for side in SQUARES:
            answers = [answer for one in maps if min(one.cells.shape) >= side for answer in _by_driving(one, name, side)]
            if answers:
                rows[f"nav2maps: {name}, {side * side // 1000}k cells"] = _row(answers)
    return rows


def _by_grid(one: RosMap) -> Figures:
    costs = make_costmap(one.cells, (one.resolution, (0.0, 0.0)), ROUND, INFLATION)
    astar, theta = (make_global_planner(name, costs, SETTINGS) for name in ("astar", "theta_star"))
    rng, pairs, long = np.random.default_rng(3), list[Answer](), list[PathQuery]()
    cells = np.argwhere(costs.values <= COSTLIEST)
    _asked(astar, _pair(costs, cells, rng))
    while len(pairs) < MOST_DRAWN and (len(pairs) < PAIRS or len(long) < LONG_PAIRS):
        query = _pair(costs, cells, rng)
        pairs.append(_asked(astar, query))
        if LONG[0] <= pairs[-1].length <= LONG[1] and len(long) < LONG_PAIRS:
            long.append(query)
    rows = {f"nav2maps: {one.name}: A*": _row(pairs[:PAIRS])}
    if long:
        _asked(theta, long[0])
        rows |= {
            f"nav2maps: {one.name}: {what}, 75 m": _row([_asked(by, q) for q in long]) for what, by in (("A*", astar), ("Theta*", theta))
        }
    return rows


def _by_driving(one: RosMap, name: str, side: int) -> list[Answer]:
    rng, answers = np.random.default_rng(side), list[Answer]()
    for _ in range(CUTS):
        row, column = rng.integers(0, np.array(one.cells.shape) - side + 1)
        part = np.ascontiguousarray(one.cells[row : row + side, column : column + side])
        costs = make_costmap(part, (one.resolution, (0.0, 0.0)), CAR, INFLATION)
        planner, check = make_global_planner(name, costs, SETTINGS), DrivenCheck(costs)
        free = np.argwhere((costs.values <= COSTLIEST) & (costs.blocked == 0))
        asked = 0
        while asked <= QUERIES:
            query = _pair(costs, free, rng, 0.5 * side * one.resolution)
            if make_global_planner("astar", costs, SETTINGS).plan(query).refusal is Refusal.NO_VALID_PATH:
                continue
            answer = _asked(planner, query, check)
            answers += [answer] if asked else []  # the first query of a planner prepares it
            asked += 1
    return answers


def _pair(
    costs: Costmap, cells: np.ndarray[tuple[int, int], np.dtype[np.int64]], rng: np.random.Generator, apart: float = APART
) -> PathQuery:
    while True:
        points = costs.points(cells[rng.integers(len(cells), size=2)])
        if np.hypot(*(points[1] - points[0])) > apart:
            yaws = rng.uniform(-np.pi, np.pi, 2)
            (x0, y0), (x1, y1) = points.tolist()
            return PathQuery((x0, y0, float(yaws[0])), (x1, y1, float(yaws[1])))


def _asked(planner: GlobalPathPlanner, query: PathQuery, check: DrivenCheck | None = None) -> Answer:
    ms, found = on_thread(lambda: planner.plan(query))
    held = np.nan
    if check is not None and found.path is not None:
        held = float(check.holds(found.path, SETTINGS.minimum_turning_radius))
    return Answer(ms, found.length, held)


def _row(answers: list[Answer]) -> dict[str, float]:
    met = [answer for answer in answers if np.isfinite(answer.length)]
    row = {"queries": float(len(answers)), "success %": 100.0 * len(met) / len(answers)}
    if met:
        ms = [answer.ms for answer in met]
        row |= {"m": float(np.mean([answer.length for answer in met])), "ms": float(np.mean(ms))}
        row |= {"p50 ms": float(np.percentile(ms, 50)), "p95 ms": float(np.percentile(ms, 95)), "worst ms": max(ms)}
    if held := [answer.held for answer in met if not np.isnan(answer.held)]:
        row["held %"] = 100.0 * float(np.mean(held))
    if failed := [answer.ms for answer in answers if not np.isfinite(answer.length)]:
        row["failed ms"] = float(np.mean(failed))
    return row
