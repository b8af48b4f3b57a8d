"""Coverage plans of fields: those of ``DIR/coverage``, and twenty random ones with concave outlines and holes.

An aircraft of 25 m/s turns with 55 m radius and covers 16 m a swath. A field less than 25 m wide (twice its area over the length of its
borders) is driven by a ground vehicle that works 1.5 m wide (0.5 m on fields less than 4 m wide) and turns on the spot.
``swaths / bound`` is the length of swaths and headland passes over area / width, ``path / bound`` that of the whole path with its turns.
``slant / bound`` is by how much square ends at slanted borders lengthen swaths that cover every corner. ``covered`` is the exact union of
the swept rectangles.
``python -m benchmarks.planning.coverage OUT [DIR]`` draws each plan.
"""

import sys
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.planning.fields import RANDOM, drawn_fields, random_field
from launch.commands.bench import Figures
from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.plan import HEADLAND, SWATH, TRANSIT, CoveragePlan
from uvf.planning.coverage.planner import plan_coverage
from uvf.planning.coverage.task import CoverageTask
from uvf.planning.coverage.vehicles import GroundVehicle, SurveyAircraft

AIRCRAFT = SurveyAircraft(GroundSpeed(25.0), 55.0, lead_in=40.0, lead_out=10.0)
WIND = SurveyAircraft(GroundSpeed(25.0, (6.0, -4.0)), 85.0, lead_in=40.0, lead_out=10.0)
ROVER = GroundVehicle(1.0)
AERIAL_WIDTH, DRIVEN_WIDTH, SMALL_WIDTH = 16.0, 1.5, 0.5  # m
SMALL, SMALLEST = 25.0, 4.0  # m, twice the area over the length of the borders
COLOURS = {TRANSIT: "0.6", SWATH: "C0", HEADLAND: "C2"}

Vehicle = SurveyAircraft | GroundVehicle


def task_for(field: CoverageField) -> tuple[CoverageTask, Vehicle]:
    """Width and vehicle by the size of the field."""
    across = 2 * field.area / float(np.hypot(*(field.edges[:, 2:] - field.edges[:, :2]).T).sum())
    if across >= SMALL:
        return CoverageTask(field, AERIAL_WIDTH), AIRCRAFT
    return CoverageTask(field, DRIVEN_WIDTH if across >= SMALLEST else SMALL_WIDTH), ROVER


def figures(plan: CoveragePlan, ms: float) -> dict[str, float]:
    """The row of a plan that took ``ms`` [ms]."""
    return {
        "area, ha": plan.field.area / 1e4,
        "holes": plan.field.hole_count,
        "width, m": plan.width,
        "swaths": len(plan.swaths),
        "covered, %": 100 * plan.covered,
        "swaths / bound": plan.swath_ratio,
        "slant / bound": slant(plan),
        "path / bound": plan.length_ratio,
        "turns": plan.turns,
        "time, s": plan.time,
        "plan, ms": ms,
    }


def slant(plan: CoveragePlan) -> float:
    """By how much square ends at slanted borders must lengthen complete swaths, on average over where the strips lie, over the bound.

    Each strip goes half a width times the cotangent of a border's angle beyond it: half the borders' extent along the swaths in all.
    """
    edges, c, s = plan.field.edges, np.cos(plan.direction), np.sin(plan.direction)
    return float(np.abs((edges[:, 2:] - edges[:, :2]) @ (c, s)).sum() / 2 / plan.bound)


def planned(field: CoverageField, vehicle: Vehicle | None = None, least: Literal["time", "swaths"] = "time") -> tuple[CoveragePlan, float]:
    """A plan and how long it took [ms], the second time, when everything is compiled."""
    task, own = task_for(field)
    task = replace(task, least=least)
    plan_coverage(task, vehicle or own)
    begun = time.perf_counter()
    plan = plan_coverage(task, vehicle or own)
    return plan, 1e3 * (time.perf_counter() - begun)


def _case(name: str, make: Callable[[], CoverageField], _: Path | None) -> Figures:
    field = make()
    rows = {name: figures(*planned(field)), f"{name}, least swaths": figures(*planned(field, least="swaths"))}
    if isinstance(task_for(field)[1], SurveyAircraft):
        rows[f"{name}, wind 7 m/s"] = figures(*planned(field, WIND))
    return rows


def cases(data: Path | None) -> dict[str, Callable[[Path | None], Figures]]:
    """A case for each field of the data folder, if there is one, and for each random one."""
    found: dict[str, Callable[[Path | None], Figures]] = {}
    if data is not None and (data / "coverage").is_dir():
        found |= {f"field:{name}": partial(_case, name, partial(_same, field)) for name, field in drawn_fields(data)}
    return found | {f"random:{seed}": partial(_case, f"random {seed}", partial(random_field, seed)) for seed in range(RANDOM)}


def _same(field: CoverageField) -> CoverageField:
    return field


def draw(axes: Axes, plan: CoveragePlan) -> None:
    """The field, what is swept, the path, where it begins and the way each swath is gone."""
    for outline, holes in plan.field.parts:
        axes.fill(*outline.T, facecolor="#e8f0d8", edgecolor="k", linewidth=1.0)
        for hole in holes:
            axes.fill(*hole.T, facecolor="w", edgecolor="k", linewidth=1.0)
    for kind, colour in COLOURS.items():
        for row in plan.segments[plan.kinds == kind]:
            s = np.linspace(0.0, row[4], max(int(abs(row[3]) * row[4] / 0.1), 1) + 1)
            half = row[3] * s / 2
            chord = s * np.sinc(half / np.pi)
            axes.plot(row[0] + chord * np.cos(row[2] + half), row[1] + chord * np.sin(row[2] + half), color=colour, linewidth=0.9)
    if len(plan.segments):
        axes.plot(*plan.segments[0, :2], "go", markersize=5)
    axes.set_aspect("equal")
    ratio = f"swaths {plan.swath_ratio:.3f}, path {plan.length_ratio:.2f} of the bound"
    axes.set_title(f"{100 * plan.covered:.2f} % with {len(plan.swaths)} swaths\n{ratio}", fontsize=8)
    axes.tick_params(labelsize=6)


def main(out: Path, data: Path | None) -> None:
    """Draws every field on sheets of six."""
    fields = list(drawn_fields(data)) if data is not None else []
    fields += [(f"random {seed}", random_field(seed)) for seed in range(RANDOM)]
    for first in range(0, len(fields), 6):
        figure = Figure(figsize=(15.0, 10.0), layout="constrained")
        for axes, (name, field) in zip(figure.subplots(2, 3).flat, fields[first : first + 6], strict=False):
            draw(axes, planned(field)[0])
            axes.set_title(f"{name}: {axes.get_title()}", fontsize=8)
        figure.savefig(out / f"coverage-{first // 6}.png", dpi=70)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
