"""``uvf compare``: several runs side by side on one page."""

import difflib
from collections.abc import Iterator, Sequence
from pathlib import Path

import matplotlib.figure
import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray

from launch.reports import html
from launch.reports.axes import finish, line
from launch.reports.drive_figures import forward_speed, pose_errors
from launch.reports.flight_figures import deviation
from launch.reports.history import History
from launch.reports.recorded_run import RecordedRun
from launch.reports.report import vehicle_figures
from launch.reports.team_page import draw_world, way_of
from launch.scoring.scores import FAILED
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]
Curve = tuple[str, Floats, Floats]
"""What is drawn, t (k,) [s], values (k,)."""

PAGE = "compare.html"
MOST = 10  # runs: more colours are not told apart


def write_comparison(runs: Sequence[RecordedRun], target: Path) -> Path:
    """Writes the page and its pictures into a folder; returns the page. Raises BadInput."""
    if not 2 <= len(runs) <= MOST:
        raise BadInput(f"{len(runs)} runs: from 2 to {MOST} can be compared")
    labels = labels_of(runs)
    try:
        target.mkdir(parents=True, exist_ok=True)
        sections = list(_sections(dict(zip(labels, runs, strict=True)), target))
        page = target / PAGE
        page.write_text(html.document("Comparison of runs", sections, f"<h1>{html.text(' and '.join(labels))}</h1>"), encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{target}: {error.strerror}: choose another folder with --out") from error
    return page


def labels_of(runs: Sequence[RecordedRun]) -> list[str]:
    """A short name for each run: that of its folder or log, with a number where they are alike."""
    names = [run.path.resolve().name if run.path.is_dir() else run.path.resolve().parent.name + "/" + run.path.stem for run in runs]
    return [name if names.count(name) == 1 else f"{name} ({i + 1})" for i, name in enumerate(names)]


def criteria_rows(runs: Sequence[RecordedRun]) -> list[tuple[str, ...]]:
    """Subject, measure, limits, and the value of each run, with ``FAILED`` where it is beyond them: of every criterion that any run has."""
    keys = dict.fromkeys((v.subject, v.criterion.measure, v.limits) for run in runs for v in run.verdicts)

    def value(run: RecordedRun, key: tuple[str, str, str]) -> str:
        found = next((v for v in run.verdicts if (v.subject, v.criterion.measure, v.limits) == key), None)
        return "" if found is None else f"{found.found.value:.3g}" + ("" if found.passed else f" {FAILED}")

    return [(*key, *(value(run, key) for run in runs)) for key in keys]


def _sections(runs: dict[str, RecordedRun], target: Path) -> Iterator[tuple[str, str]]:
    yield "Runs", html.table(("run", "mission", "seed", "simulated", "criteria", "vehicles"), map(_of_run, runs, runs.values()))
    if rows := criteria_rows(list(runs.values())):
        yield "Criteria", html.table(("subject", "measure", "limit", *runs), rows)
    if differences := "".join(_differences(runs)):
        yield "What differed", differences
    for name in dict.fromkeys(name for run in runs.values() for name in run.vehicles):
        having = {label: run.vehicles[name] for label, run in runs.items() if name in run.vehicles}
        picture = target / f"{name}.png"
        _draw(name, having, runs, picture)
        yield name, html.picture(picture, f"ways and curves of {name} in each run") + _figures(having)


def _of_run(label: str, run: RecordedRun) -> tuple[object, ...]:
    seed = run.site.mission.seed if run.site is not None else ""
    return label, run.title, str(seed), run.stopped_at or f"{run.end:.1f} s", run.verdict, ", ".join(run.vehicles)


def _differences(runs: dict[str, RecordedRun]) -> Iterator[str]:
    """The mission's text against that of the first run, and parameters that were in force."""
    texts = {label: run.site.mission_path.read_text(encoding="utf-8") for label, run in runs.items() if run.site is not None}
    first, *others = texts or [""]
    for other in others:
        lines = list(difflib.unified_diff(texts[first].splitlines(), texts[other].splitlines(), first, other, lineterm="", n=1))
        if lines:
            yield html.block("\n".join(lines))
    values: dict[tuple[str, str, str], dict[str, str]] = {}
    for label, run in runs.items():
        for vehicle, history in run.vehicles.items():
            for service, told in history.params.items():
                for name, value in told.values.items():
                    values.setdefault((vehicle, service, name), {})[label] = value
    everywhere = {key: of for key, of in sorted(values.items()) if len(of) == len(runs)}
    changed = [(*key, *(of[label] for label in runs)) for key, of in everywhere.items() if len(set(of.values())) > 1]
    yield html.table(("vehicle", "service", "parameter", *runs), changed)


def _figures(having: dict[str, History]) -> str:
    found = {label: {figure.name: figure.value for figure in vehicle_figures(history)} for label, history in having.items()}
    names = dict.fromkeys(name for figures in found.values() for name in figures)
    return html.table(("figure", *having), ((name, *(figures.get(name, "") for figures in found.values())) for name in names))


def _draw(name: str, having: dict[str, History], runs: dict[str, RecordedRun], target: Path) -> None:
    """The ways of one vehicle over the world of the first run, and its curves."""
    curves = {label: list(_curves(history)) for label, history in having.items()}
    titles = list(dict.fromkeys(title for of_run in curves.values() for title, *_ in of_run))
    sheet = matplotlib.figure.Figure(figsize=(15.0, 7.0), layout="constrained")
    parts = sheet.add_gridspec(max(len(titles), 1), 2)
    left = sheet.add_subplot(parts[:, 0])
    panels = {title: sheet.add_subplot(parts[i, 1]) for i, title in enumerate(titles)}
    draw_world(left, runs[next(iter(having))])
    colours = colormaps["tab10"].colors  # type: ignore[attr-defined]
    for i, (label, history) in enumerate(having.items()):
        if len(way := way_of(history)):
            left.plot(*way.T, color=colours[i], lw=1.4, label=label)
            left.plot(*way[-1], "s", color=colours[i], ms=6)
        for title, t, values in curves[label]:
            line(panels[title], t, values, label, colours[i])
    left.set_aspect("equal", adjustable="box")
    left.autoscale()
    finish(left, f"ways of {name}", 2)
    for title, axes in panels.items():
        finish(axes, title, 2)
    if panels:
        panels[titles[-1]].set_xlabel("s")
    sheet.savefig(target, dpi=90)


def _curves(history: History) -> Iterator[Curve]:
    truth = history.truth
    if history.is_aircraft:
        if (off := deviation(history)) is not None:
            yield "cross-track, m", off.t, off.cross_track
        if (flown := truth or history.estimate) is not None:
            yield "height, m", flown.t, flown.position[:, 2]
            yield "airspeed, m/s", flown.t, flown.airspeed
        return
    if truth is not None:
        yield "speed, m/s", truth.t, forward_speed(truth)
    t, off_by, _ = pose_errors(history)
    if len(t):
        yield "pose error, m", t, off_by
    if len(rows := history.rows("nav/status")) and rows[:, 2].any():
        yield "way left to the goal, m", rows[:, 0], rows[:, 2]
