"""The picture of a whole run: every vehicle's way over the world and over the map that they share, and when each task ran."""

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
from matplotlib import colormaps
from numpy.typing import NDArray

from launch.reports.axes import MOST_POINTS, finish, line
from launch.reports.drive_page import draw_map
from launch.reports.history import History
from launch.reports.recorded_run import RecordedRun
from launch.worlds.picture import draw_plan
from schemas.messages import TaskStatus
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import floor_plan
from uvf.models.world.map_file import GridMap

Floats = NDArray[np.float64]

PLAN_CELL = 0.05  # m
LARGE = 60.0  # m, side from which on the floor plan is drawn in larger cells
MARGIN = 0.06
"""Of the ways' extent, left free around them."""
TASK_COLOURS = {TaskStatus.DONE: "#8fd19e", TaskStatus.FAILED: "#e57373", TaskStatus.STOPPED: "#c9c9d2", TaskStatus.RUNNING: "#9ec9e8"}
FEW = 4  # vehicles, of which the distances of all pairs are drawn
INDENT = "    "


def draw_team(run: RecordedRun, team_map: GridMap | None, target: Path) -> None:
    """Draws the picture into a PNG. team_map: the map of several vehicles, in the world frame."""
    shown = [task for task in run.tasks if task.name]
    flies = [history.is_aircraft for history in run.vehicles.values()]
    panels = [_over_world] + ([_over_floor] if any(flies) and not all(flies) else []) + ([_over_map] if team_map is not None else [])
    apart = distances(run)
    heights = [6.5, *([2.4] if apart else []), *([0.4 + 0.24 * len(shown)] if shown else [])]
    sheet = matplotlib.figure.Figure(figsize=(15.0, sum(heights)), layout="constrained")
    parts = sheet.add_gridspec(len(heights), len(panels), height_ratios=heights)
    for i, panel in enumerate(panels):
        panel(sheet.add_subplot(parts[0, i]), run, team_map)
    if apart:
        _apart(sheet.add_subplot(parts[1, :]), apart)
    if shown:
        _tasks(sheet.add_subplot(parts[-1, :]), run)
    sheet.savefig(target, dpi=90)


def draw_world(axes: Any, run: RecordedRun) -> None:
    """Draws the world of a run from above, if its mission is known."""
    if run.site is not None:
        world = run.site.world
        draw_plan(axes, world, floor_plan(world, _cell(world)), None)


def _over_world(axes: Any, run: RecordedRun, _: GridMap | None) -> None:
    draw_world(axes, run)
    _ways(axes, run)
    finish(axes, "ways over the world" if run.site is not None else "ways", 4)


def _over_floor(axes: Any, run: RecordedRun, team_map: GridMap | None) -> None:
    """Where the rovers are, without the wide turns of the aircraft."""
    _over_world(axes, run, team_map)
    rovers = _ways_of_rovers(run)
    if run.site is not None:
        rovers = np.concatenate((rovers, np.reshape(run.site.world.floor, (2, 2))))
    _frame(axes, rovers)
    finish(axes, "the rovers' ground", 4)


def _over_map(axes: Any, run: RecordedRun, team_map: GridMap | None) -> None:
    assert team_map is not None
    draw_map(axes, team_map)
    _ways(axes, run)
    _frame(axes, _ways_of_rovers(run))
    finish(axes, "ways over the team's map", 4)


def _cell(world: WorldFile) -> float:
    x_min, y_min, x_max, y_max = world.floor
    return PLAN_CELL * max(1.0, max(x_max - x_min, y_max - y_min) / LARGE)


def _ways(axes: Any, run: RecordedRun) -> None:
    """Ways with start (o) and end (square), true where the truth is known."""
    colours = colormaps["tab10"].colors  # type: ignore[attr-defined]
    ways = [(name, way_of(history)) for name, history in run.vehicles.items()]
    for i, (name, way) in enumerate(ways):
        if len(way):
            step, colour = max(len(way) // MOST_POINTS, 1), colours[i % len(colours)]
            width = 1.6 + (len(ways) - 1 - i if len(ways) <= FEW else 0)  # who goes where another one has gone does not hide its way
            axes.plot(*way[::step].T, color=colour, lw=width, label=name)
            axes.plot(*way[0], "o", color=colour, ms=6)
            axes.plot(*way[-1], "s", color=colour, ms=6)
    axes.set_aspect("equal", adjustable="box")
    points = [way for _, way in ways if len(way)]
    if run.site is not None and not any(history.is_aircraft for history in run.vehicles.values()):
        points.append(np.reshape(run.site.world.floor, (2, 2)))
    if points:
        _frame(axes, np.concatenate(points))
    axes.set_xlabel("x (east), m", fontsize=9)
    axes.set_ylabel("y (north), m", fontsize=9)


def _ways_of_rovers(run: RecordedRun) -> Floats:
    """(k, 2) m, one after the other."""
    return np.concatenate([np.zeros((0, 2)), *(way_of(history) for history in run.vehicles.values() if not history.is_aircraft)])


def _frame(axes: Any, points: Floats) -> None:
    if not len(points):
        return
    low, high = points.min(axis=0), points.max(axis=0)
    margin = MARGIN * float((high - low).max()) + 0.5
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)


def way_of(history: History) -> Floats:
    """Where a vehicle was, (k, 2) [m, world]: truly, where the truth is known, else as it was estimated."""
    return _first_known(history, ("truth/state", "nav/state", "nav/pose"))[:, 1:3]


def _first_known(history: History, streams: Sequence[str]) -> Floats:
    """Rows of the first of the streams that has any, each with the time [s] and a place [m, world] ahead; none where none has."""
    return next((rows for stream in streams if len(rows := history.rows(stream))), np.zeros((0, 4)))


def distances(run: RecordedRun) -> dict[str, tuple[Floats, Floats]]:
    """By name of the pair, (k,) s and (k,) m: how far two vehicles were from each other, while both were known.

    Of all pairs of a few vehicles; of more, only of those that follow with whom they follow.
    """
    known = {name: _first_known(history, ("truth/state", "nav/state")) for name, history in run.vehicles.items()}
    moved = {name: path for name, path in known.items() if len(path) > 1}
    pairs = list(itertools.combinations(moved, 2))
    if len(moved) > FEW:
        pairs = [(leader, name) for name, leader in _leaders(run).items() if name in moved and leader in moved]
    found = {}
    for one, other in pairs:
        a, b = moved[one], moved[other]
        t = a[(a[:, 0] >= b[0, 0]) & (a[:, 0] <= b[-1, 0]), 0]
        places = [np.column_stack([np.interp(t, path[:, 0], path[:, k]) for k in (1, 2, 3)]) for path in (a, b)]
        if len(t):
            found[f"{one} to {other}"] = t, np.linalg.norm(places[0] - places[1], axis=1)
    return found


def _leaders(run: RecordedRun) -> dict[str, str]:
    """Whom each of those follows that follow from the start on."""
    members = run.site.members.items() if run.site is not None else ()
    return {name: member.entry.job.follow.leader for name, member in members if member.entry.job.follow is not None}


def _apart(axes: Any, apart: Mapping[str, tuple[Floats, Floats]]) -> None:
    colours = colormaps["tab10"].colors  # type: ignore[attr-defined]
    for i, (name, (t, distance)) in enumerate(apart.items()):
        line(axes, t, distance, name, colours[i % len(colours)])
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("s")
    finish(axes, "distances between vehicles, m", 6)


def _tasks(axes: Any, run: RecordedRun) -> None:
    """A bar for each task from when it began to when it ended, or to the end of the run."""
    shown = [(i, task) for i, task in enumerate(run.tasks) if task.name]
    for row, (i, task) in enumerate(shown):
        begin = run.begun.get(i)
        if begin is not None:
            end = run.end if task.state == TaskStatus.RUNNING else task.since
            axes.barh(row, max(end - begin, run.end / 300), left=begin, height=0.7, color=TASK_COLOURS.get(task.state, "#dddddd"))
        elif task.state in (TaskStatus.DONE, TaskStatus.FAILED):  # it only waited for something
            axes.plot(task.since, row, "D", color=TASK_COLOURS[task.state], ms=8)
        if task.state == TaskStatus.FAILED:
            axes.text(task.since if begin is None else begin, row, f" {task.reason}", va="center", fontsize=8)
    axes.set_yticks(range(len(shown)), [INDENT * task.depth + task.name for _, task in shown], fontsize=8, ha="left")
    axes.tick_params(axis="y", pad=10 + 6 * max(len(INDENT) * task.depth * 0.5 + len(task.name) for _, task in shown))
    axes.invert_yaxis()
    axes.set_xlim(0, max(run.end, 1.0))
    axes.set_xlabel("s")
    finish(axes, "tasks: green done, red failed, grey stopped, blue running at the end; diamonds: conditions waited for")
