"""SLAM methods over every log below DATA/slam: errors against relations and references, speed on one core, pictures.

Cases are LOG:METHOD:VARIANT; a shorter name stands for all that begin with it. The default method runs on harder variants of
each log with relations, too. Results of each case, with pictures, are put into ``runs/slam/bench``.
"""

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache, partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import typer
import yaml
from numpy.typing import NDArray

from benchmarks.measuring.processes import one_thread_each
from benchmarks.slam.evaluation.variants import VARIANTS
from benchmarks.slam.logs import has_relations, logs_below
from launch import settings
from launch.commands.bench import Case
from launch.commands.bench import Figures as Rows
from launch.commands.slam import DEFAULT_METHOD
from launch.slam.known import Known, known_of
from launch.slam.opening import CARMEN_ENDINGS, MCAP_ENDING, open_log
from launch.slam.results import Made, write_results
from launch.slam.scoring import POSES, Figures, figures
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.relations import Relations, relation_errors
from uvf.slam.evaluation.run import run_over
from uvf.slam.methods import METHODS, make_method, method_params

Floats = NDArray[np.float64]
Result = TypeVar("Result")

UNCHANGED = next(iter(VARIANTS))
WARM_UP = 200
"""Readings of an extra run before the clock starts: what is compiled is compiled."""
RESOLUTION = 0.05  # m
NOTHING = Relations(np.zeros((0, 2)), np.zeros((0, 3)))
PUBLISHED = ROOT / "benchmarks" / "slam" / "published.yaml"
"""Figures of others, as they were published: rows by the name of the log."""


@dataclass(frozen=True)
class Outcome:
    """Of one run. Poses are (readings, 3); relations and errors are those of the harder log."""

    figures: Figures
    stamps: Floats
    poses: dict[str, Floats]
    relations: dict[str, Relations]


def cases(data: Path | None) -> dict[str, Case]:
    """Raises BadInput without a folder of logs."""
    found: dict[str, Case] = {}
    for name, log in logs_below(data, "slam", (*CARMEN_ENDINGS, MCAP_ENDING)).items():
        for method in METHODS:
            varied = method == DEFAULT_METHOD and has_relations(log)
            for variant in VARIANTS if varied else (UNCHANGED,):
                found[f"{name}:{method}:{variant}"] = partial(_case, log, name, method, variant)
        found |= {f"{name}:published:{by}": _constant({f"{name}:published:{by}": row}) for by, row in _published(name).items()}
    return found


def _constant(rows: Rows) -> Callable[[Path | None], Rows]:
    return lambda data: rows


def _published(name: str) -> dict[str, dict[str, float]]:
    rows: dict[str, dict[str, float]] = yaml.safe_load(PUBLISHED.read_text()).get(name, {})
    return rows


def _case(log: Path, name: str, method: str, variant: str, data: Path | None) -> Rows:
    """A row for the final poses and one for the online ones; none for a file that is no log, which is told."""
    try:
        outcome = _outcome(log, method, variant)
        before = _outcome(log, method, UNCHANGED)
    except BadInput as error:
        typer.echo(f"uvf: {error}", err=True)
        return {}
    return {f"{name}:{method}:{variant} {when}": _row(outcome, before, when) for when in reversed(POSES)}


@cache
def _outcome(log: Path, method: str, variant: str) -> Outcome:
    """Raises BadInput."""
    best = None if variant == UNCHANGED else _outcome(log, DEFAULT_METHOD, UNCHANGED).poses["final"]
    return alone(measured, log, method, variant, best)


def alone(function: Callable[..., Result], *arguments: Any) -> Result:
    """``function(*arguments)`` in a process of its own that has one core and one thread."""
    with one_thread_each(), ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=_take_one_core) as pool:
        return pool.submit(function, *arguments).result()


def _take_one_core() -> None:
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def measured(path: Path, method: str, variant: str, best: Floats | None) -> Outcome:
    """Runs a method over a variant of a log, after a warm-up, and writes its results. Raises BadInput.

    best: (readings, 3), the poses that the default method has found on the unchanged log.
    """
    log = open_log(path)
    known = known_of(path, log, None, None)
    if best is not None:
        harder, whole = VARIANTS[variant], log
        log = harder(whole, NOTHING, best)[0]
        known = Known({name: harder(whole, relations, best)[1] for name, relations in known.relations.items()}, {})
    params = method_params(method, {}, "defaults")
    warm = make_method(method, params)
    for reading in log.readings[:WARM_UP]:
        warm.add(reading)
    run = run_over(log, make_method(method, params))
    found = figures(run, known)
    folder = settings.runs_folder() / "slam" / "bench" / f"{path.stem}-{method}-{variant}"
    write_results(run, known, Made(method, params, RESOLUTION), found, folder)
    return Outcome(found, log.stamps, {"online": run.online, "final": run.final}, known.relations)


def _row(outcome: Outcome, before: Outcome, when: str) -> dict[str, float]:
    """By the first file of relations and the first reference; the rest is in the results of the case."""
    row: dict[str, float] = {}
    for name, found in list(outcome.figures["relations"].items())[:1]:
        row |= _errors(found[when]) | (_growth(outcome, before, name, when) if outcome is not before else {})
    for found in list(outcome.figures["references"].values())[:1]:
        absolute = found[when]["absolute"]
        row |= {"ATE m": round(absolute["rmse_m"], 3), "ATE max m": round(absolute["max_m"], 3)}
    taken = outcome.figures["run"]
    return row | {"x real time": round(taken["times_real_time"]), "wall s": round(taken["wall_s"], 2), "CPU s": round(taken["cpu_s"], 2)}


def _errors(groups: dict[str, Any]) -> dict[str, float]:
    if not groups:
        return {"pairs": 0}
    f = groups["all"]
    row = {"pairs": f["number"], "m": f["freiburg_m"]["mean"], "Carto m": f["cartographer_m"]["mean"], "deg": f["rotation_deg"]["mean"]}
    for group in ("near", "far"):
        if group in groups:
            row |= {f"{group} m": groups[group]["freiburg_m"]["mean"], f"{group} deg": groups[group]["rotation_deg"]["mean"]}
    row |= {"worst m": f["freiburg_m"]["max"], "> 0.5 m": f["gross"]}
    return {column: round(value, 4 if column.endswith("m") else 3) for column, value in row.items()}


def _growth(outcome: Outcome, before: Outcome, name: str, when: str) -> dict[str, float]:
    """By which factor the errors have grown over those of the unchanged log, of the same relations."""
    kept = {tuple(pair) for pair in outcome.relations[name].stamps.tolist()}
    whole = before.relations[name]
    same = whole.only(np.array([tuple(pair) in kept for pair in whole.stamps.tolist()], dtype=np.bool_))
    if not len(same):
        return {}
    now = relation_errors(outcome.relations[name], outcome.stamps, outcome.poses[when])
    then = relation_errors(same, before.stamps, before.poses[when])
    return {
        "x m": round(float(now.freiburg_translation.mean() / then.freiburg_translation.mean()), 2),
        "x deg": round(float(now.rotation.mean() / then.rotation.mean()), 2),
    }


CASES = cases
