"""Navigation and planning: the cases of several modules under one group.

``uvf bench nav barn --worlds 0:50 --trials 3 --seed 1 --data DIR``. Scores are of public worlds in this simulation, never official.
"""

from functools import partial
from pathlib import Path

from benchmarks.planning import coverage, curves, cycle, goals, movingai, nav2maps, recovery, sampling, survey_flown
from benchmarks.planning.barn import cases as barn
from launch.commands.bench import Case, Figures
from launch.commands.bench_selection import Selection

MEASURED = {
    "barn": barn.static_runs,
    "dynabarn": barn.dynamic_runs,
    "movingai": movingai.measure,
    "nav2maps": nav2maps.measure,
    "recovery": recovery.measure,
}
"""By case: a function of the selection and the data folder that returns rows."""
OPTIONS = {"barn": barn.OPTIONS, "dynabarn": barn.OPTIONS, "recovery": recovery.OPTIONS} | dict.fromkeys(goals.WORLDS, goals.OPTIONS)


def cases(data: Path | None, selection: Selection) -> dict[str, Case]:
    """The cases with the runs that were selected."""
    found: dict[str, Case] = {name: partial(measure, selection) for name, measure in MEASURED.items()}
    found |= {"dubins": partial(_named, "dubins", curves.measure), "survey": partial(_named, "survey", survey_flown.measure)}
    found |= {"cycle": partial(_named, "cycle", cycle.measure)}
    found |= goals.cases(selection)
    for group, inner in (("coverage", coverage.cases(data)), ("sampling", sampling.CITIES)):
        found |= {f"{group}:{name}": partial(_named, group, case) for name, case in inner.items()}
    return found


def _named(case: str, measure: Case, data: Path | None) -> Figures:
    return {f"{case}: {row}": figures for row, figures in measure(data).items()}


CASES = cases
