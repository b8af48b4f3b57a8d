"""Navigation and planning of ground vehicles: the cases of several modules under one group.

``uvf bench nav barn --worlds 0:50 --trials 3 --seed 1 --data DIR``. Scores are of public worlds in this simulation, never official.
"""

from functools import partial
from pathlib import Path

from benchmarks.planning import movingai, nav2maps
from benchmarks.planning.barn import cases as barn
from launch.commands.bench import Case
from launch.commands.bench_selection import Selection

MEASURED = {"barn": barn.static_runs, "dynabarn": barn.dynamic_runs, "movingai": movingai.measure, "nav2maps": nav2maps.measure}
"""By case: a function of the selection and the data folder that returns rows."""
OPTIONS = {"barn": barn.OPTIONS, "dynabarn": barn.OPTIONS}


def cases(data: Path | None, selection: Selection) -> dict[str, Case]:
    """The cases with the runs that were selected."""
    return {name: partial(measure, selection) for name, measure in MEASURED.items()}


CASES = cases
