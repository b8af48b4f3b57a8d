"""The page of one ground vehicle: where it drove over its map, how fast, how well it knew where it was, what its planner did."""

from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
from numpy.typing import NDArray

from launch.reports.axes import ESTIMATE, FIFTH, FOURTH, MOST_POINTS, TRUTH, WANTED, figure_table, finish, line
from launch.reports.drive_figures import accelerations, drive_figures, forward_speed, pose_errors, touches, turn_rate
from launch.reports.history import History
from launch.reports.strip import draw_modes, draw_panels
from launch.scoring.ground_measures import GOALS
from schemas.messages import NavStatus
from uvf.maths.se2 import transform
from uvf.models.world.map_file import GridMap
from uvf.runtime.messages.enum_names import enum_name

Floats = NDArray[np.float64]

UNKNOWN = "0.78"  # grey of what a map does not know
AROUND = 1.0  # m of map drawn about the track
STATES: dict[int, str] = {
    NavStatus.IDLE: "#d8d8de",
    NavStatus.PLANNING: "#9ec9e8",
    NavStatus.DRIVING: "#8fd19e",
    NavStatus.RECOVERING: "#f3c969",
    NavStatus.BLOCKED: "#e57373",
    NavStatus.REACHED: "#4caf50",
    NavStatus.CANCELLED: "#b39ddb",
}


def draw_drive(history: History, grid: GridMap | None, target: Path) -> None:
    """Draws the page of plots of one drive into a PNG. grid: the vehicle's own map, in the world frame."""
    sheet = matplotlib.figure.Figure(figsize=(15.0, 17.0), layout="constrained")
    rows = sheet.add_gridspec(8, 2, height_ratios=(2.0, 2.0, 0.7, 0.3, 1.5, 1.5, 1.5, 1.5))
    sheet.suptitle(f"Drive of {history.name}", fontsize=15, fontweight="bold")
    _track(sheet.add_subplot(rows[:2, 0]), history, grid)
    figure_table(sheet.add_subplot(rows[:2, 1]), [(f.name, f.value) for f in drive_figures(history)])
    strip = sheet.add_subplot(rows[2, :])
    draw_modes(strip, history)
    _states(sheet.add_subplot(rows[3, :], sharex=strip), history)
    panels = (_speed, _turning, _acceleration, _distance_left, _pose_error, _yaw_error, _recoveries, _charge)
    draw_panels(strip, rows, panels, history)
    sheet.savefig(target, dpi=90)


def draw_map(axes: Any, grid: GridMap) -> None:
    """Draws a map where it lies in the world: free white, occupied dark, unknown grey."""
    rows, columns = grid.cells.shape
    x = np.arange(columns + 1) * grid.resolution
    y = np.arange(rows + 1) * grid.resolution
    corners = transform(grid.origin, np.column_stack([v.ravel() for v in np.meshgrid(x, y)])).reshape(rows + 1, columns + 1, 2)
    shade = np.where(grid.cells < 0, float(UNKNOWN), 1.0 - np.clip(grid.cells, 0, 100) / 115.0)
    axes.set_facecolor(UNKNOWN)
    axes.pcolormesh(corners[..., 0], corners[..., 1], shade, cmap="gray", vmin=0.0, vmax=1.0, shading="flat", rasterized=True, zorder=-3)


def _track(axes: Any, history: History, grid: GridMap | None) -> None:
    if grid is not None:
        draw_map(axes, grid)
    places = sorted({(status.goal.x, status.goal.y) for _, status in history.navigation if status.job in GOALS})
    tracks = [np.array(places).reshape(-1, 2), *(history.rows(stream)[:, 1:3] for stream in ("truth/state", "nav/pose"))]
    if (truth := history.truth) is not None:
        step = max(len(truth.t) // MOST_POINTS, 1)
        axes.plot(*truth.position[::step, :2].T, color=TRUTH, lw=1.8, label="truth")
        axes.plot(*truth.position[:1, :2].T, "o", color=TRUTH, ms=5)
        at = np.array([np.searchsorted(truth.t, t) for t in touches(history)], dtype=int).clip(0, len(truth.t) - 1)
        if len(at):
            axes.plot(*truth.position[at, :2].T, "x", color="#c62828", ms=9, mew=2.5, label="contact")
    if len(pose := history.rows("nav/pose")):
        axes.plot(pose[:, 1], pose[:, 2], color=ESTIMATE, lw=0.9, label="estimate")
    if places:
        axes.plot(*np.array(places).T, "*", color=WANTED, ms=10, ls="none", label="goals")
    axes.set_aspect("equal", adjustable="box")
    around = np.concatenate(tracks)
    if len(around):
        low, high = around.min(axis=0) - AROUND, around.max(axis=0) + AROUND
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
    axes.set_xlabel("x, m", fontsize=9)
    axes.set_ylabel("y, m", fontsize=9)
    finish(axes, "track over its own map" if grid is not None else "track", 4)


def _states(axes: Any, history: History) -> None:
    """What the planner did, as bands."""
    rows = history.rows("nav/status")
    if len(rows):
        begins = np.flatnonzero(np.diff(rows[:, 1], prepend=-1.0))
        ends = np.append(rows[begins[1:], 0], rows[-1, 0])
        named = set()
        for begin, end in zip(begins, ends, strict=True):
            state = int(rows[begin, 1])
            name = enum_name(NavStatus.State, state)
            axes.axvspan(rows[begin, 0], end, color=STATES.get(state, "#ffffff"), lw=0, label=None if name in named else name)
            named.add(name)
        axes.legend(fontsize=7, ncols=len(named), loc="upper left", bbox_to_anchor=(0.0, -0.05), frameon=False)
    axes.set_yticks([])
    axes.tick_params(labelbottom=False, bottom=False)
    axes.set_title("planner", fontsize=10, loc="left")


def _speed(axes: Any, history: History) -> None:
    if (truth := history.truth) is not None:
        line(axes, truth.t, forward_speed(truth), "truth", TRUTH, lw=1.6)
    if len(rows := history.rows("nav/odometry")):
        line(axes, rows[:, 0], rows[:, 1], "odometry", ESTIMATE, lw=0.8)
    if len(rows := history.drives.rows):
        line(axes, rows[:, 0], rows[:, 1], "asked for", WANTED, lw=0.8)
    finish(axes, "speed, m/s")


def _turning(axes: Any, history: History) -> None:
    if (truth := history.truth) is not None:
        line(axes, truth.t, turn_rate(truth), "truth", TRUTH, lw=1.6)
    if len(rows := history.rows("nav/odometry")):
        line(axes, rows[:, 0], rows[:, 2], "odometry", ESTIMATE, lw=0.8)
    if len(rows := history.drives.rows):
        line(axes, rows[:, 0], rows[:, 2], "asked for", WANTED, lw=0.8)
    finish(axes, "turn rate, rad/s to the left")


def _acceleration(axes: Any, history: History) -> None:
    if (truth := history.truth) is not None:
        along, across = accelerations(truth)
        line(axes, truth.t, along, "along", ESTIMATE)
        line(axes, truth.t, across, "to the left", WANTED)
    finish(axes, "acceleration, m/s^2")


def _distance_left(axes: Any, history: History) -> None:
    if len(rows := history.rows("nav/status")):
        line(axes, rows[:, 0], rows[:, 2], "", ESTIMATE)
    finish(axes, "way left to the goal, m")


def _pose_error(axes: Any, history: History) -> None:
    t, off, _ = pose_errors(history)
    line(axes, t, off, "", ESTIMATE)
    axes.set_ylim(bottom=0.0)
    finish(axes, "pose error, m")


def _yaw_error(axes: Any, history: History) -> None:
    t, _, yaw = pose_errors(history)
    line(axes, t, np.degrees(yaw), "", ESTIMATE)
    finish(axes, "yaw error, deg")


def _recoveries(axes: Any, history: History) -> None:
    if len(rows := history.rows("nav/status")):
        line(axes, rows[:, 0], 100 * rows[:, 3], "explored, %", FOURTH, lw=1.6)
        other = axes.twinx()
        line(other, rows[:, 0], rows[:, 4], "", FIFTH, drawstyle="steps-post")
        other.set_ylim(0, max(1.5 * rows[:, 4].max(), 4.0))
        other.tick_params(labelsize=8)
        axes.plot([], [], color=FIFTH, label="recoveries of this goal (right)")
    axes.set_ylim(0, 105)
    finish(axes, "exploration and recoveries", 2)


def _charge(axes: Any, history: History) -> None:
    if len(rows := history.rows("sensor/battery")):
        line(axes, rows[:, 0], 100 * rows[:, 3], "charge left, %", FOURTH, lw=1.6)
        other = axes.twinx()
        line(other, rows[:, 0], rows[:, 1] * rows[:, 2], "", FIFTH, lw=0.8)
        other.tick_params(labelsize=8)
        other.set_ylim(bottom=0.0)
        axes.plot([], [], color=FIFTH, label="power, W (right)")
    axes.set_ylim(0, 110)
    finish(axes, "charge and power", 2)
