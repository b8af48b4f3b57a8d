"""Runs of a controller through the worlds of BARN and DynaBARN: shares of endings, times and scores, in one row.

``time s`` is the mean over the worlds of the mean of their successful runs and ``score`` the mean of all, as the organisers report
them; ``least m`` is the least distance of the footprint to anything, ``ms`` and ``worst ms`` what a command took. The discs of DynaBARN
follow Catmull-Rom splines; no score is counted there, for the organisers' path length is not that of a path.
"""

import csv
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.planning.barn.dynamic_worlds import dynamic_names, dynamic_world
from benchmarks.planning.barn.many import Series, make_runs
from benchmarks.planning.barn.pictures import draw
from benchmarks.planning.barn.registry import known_controller
from benchmarks.planning.barn.simulation import Run
from benchmarks.planning.barn.worlds import World, chosen, static_names, static_world
from launch.commands.bench import Figures
from launch.commands.bench_selection import Selection

OPTIONS = frozenset({"worlds", "trials", "seed", "controller", "csv", "pictures"})
TRIALS, SEED = 1, 1
ENDINGS = ("success", "collision", "timeout")
COLUMNS = ("case", "world", "trial", *ENDINGS, "time", "score", "clearance")


def static_runs(selection: Selection, data: Path | None) -> Figures:
    """One row of the static worlds. Raises BadInput."""
    return _measured("barn", (static_names(data), partial(static_world, data)), selection)


def dynamic_runs(selection: Selection, data: Path | None) -> Figures:
    """One row of the dynamic worlds, and one of each difficulty where there are several. Raises BadInput."""
    return _measured("dynabarn", (dynamic_names(data), partial(dynamic_world, data)), selection)


def _measured(case: str, worlds: tuple[Mapping[int, str], Callable[[int], World]], selection: Selection) -> Figures:
    names, load = worlds
    controller = known_controller(selection.controller)
    numbers = chosen(selection.worlds, names)
    series = Series(case, load, numbers, selection.trials or TRIALS, SEED if selection.seed is None else selection.seed, controller)
    runs = make_runs(series)
    if selection.csv is not None:
        add_rows(selection.csv, case, runs)
    if selection.pictures is not None:
        of_name = {names[number]: number for number in numbers}
        for run in runs:
            if run.ending != "success":
                draw(load(of_name[run.world]), run, selection.pictures / f"{case}-{run.world}-{run.trial}-{run.ending}.png")
    return _rows(f"{case}, {controller}", runs)


def _rows(name: str, runs: Sequence[Run]) -> Figures:
    kinds = sorted({run.world.partition("_")[0] for run in runs})
    parts = {f"{name}, {kind}": [run for run in runs if run.world.startswith(f"{kind}_")] for kind in kinds if len(kinds) > 1}
    return {name: row_of(runs)} | {part: row_of(found) for part, found in parts.items()}


def row_of(runs: Sequence[Run]) -> dict[str, float]:
    """Figures of some runs, at least one."""
    row = {f"{ending} %": 100.0 * float(np.mean([run.ending == ending for run in runs])) for ending in ENDINGS}
    worlds = dict.fromkeys(run.world for run in runs)
    times = [[run.time for run in runs if run.world == world and run.ending == "success"] for world in worlds]
    if any(times):
        row["time s"] = float(np.mean([np.mean(of_world) for of_world in times if of_world]))
    if scores := [run.score for run in runs if run.score is not None]:
        row["score"] = float(np.mean(scores))
    row |= {"n": len(runs), "least m": min(run.clearance for run in runs)}
    return row | {"ms": float(np.mean([run.mean_ms for run in runs])), "worst ms": max(run.worst_ms for run in runs)}


def add_rows(path: Path, case: str, runs: Sequence[Run]) -> None:
    """Adds a row for each run to a file of comma-separated values, with a heading where it is empty; time [s], clearance [m]."""
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if not file.tell():
            writer.writerow(COLUMNS)
        for run in runs:
            endings = [int(run.ending == ending) for ending in ENDINGS]
            score = "" if run.score is None else f"{run.score:.4f}"
            writer.writerow((case, run.world, run.trial, *endings, f"{run.time:.3f}", score, f"{round(run.clearance, 3) + 0.0:.3f}"))
