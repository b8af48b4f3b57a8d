"""The page of one aircraft: where it flew, what was wanted of it, what it knew, what it took."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
from numpy.typing import NDArray

from launch.reports.axes import ESTIMATE, FIFTH, FOURTH, MOST_POINTS, TRUTH, WANTED, cyclic, figure_table, finish, line
from launch.reports.flight_figures import NEAR, WATT_HOUR, deviation, energy, figures
from launch.reports.history import FlownMotion, History
from launch.reports.strip import draw_modes, draw_panels
from schemas.messages import MissionItem

Floats = NDArray[np.float64]

FEW = 40  # marks of mission items


def draw(history: History, target: Path) -> None:
    """Draws the page of plots of one flight into a PNG."""
    sheet = matplotlib.figure.Figure(figsize=(15.0, 17.0), layout="constrained")
    grid = sheet.add_gridspec(7, 2, height_ratios=(2.0, 2.0, 0.7, 1.5, 1.5, 1.5, 1.5))
    sheet.suptitle(f"Flight of {history.name}", fontsize=15, fontweight="bold")
    _track(sheet.add_subplot(grid[:2, 0]), history)
    figure_table(sheet.add_subplot(grid[:2, 1]), [(f.name, f.value) for f in figures(history)])
    strip = sheet.add_subplot(grid[2, :])
    draw_modes(strip, history)
    panels = (_cross_track, _altitude, _airspeed, _wind, _attitude, _heading, _surfaces, _energy)
    draw_panels(strip, grid, panels, history)
    sheet.savefig(target, dpi=90)


def _both(history: History) -> Iterator[tuple[FlownMotion, str, str]]:
    """Truth below, estimate above."""
    if (truth := history.truth) is not None:
        yield truth, "truth", TRUTH
    if (estimate := history.estimate) is not None:
        yield estimate, "estimate", ESTIMATE


def _track(axes: Any, history: History) -> None:
    _plan(axes, history)
    for motion, label, colour in _both(history):
        step = max(len(motion.t) // MOST_POINTS, 1)
        x, y = motion.position[::step, :2].T
        axes.plot(x, y, color=colour, lw=1.8 if label == "truth" else 0.9, label=label)
        axes.plot(x[:1], y[:1], "o", color=colour, ms=5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.17)  # room for the arrow of the wind in a corner
    _wind_arrow(axes, history)
    axes.set_xlabel("east, m", fontsize=9)
    axes.set_ylabel("north, m", fontsize=9)
    finish(axes, "track over the planned path", 4)


def _plan(axes: Any, history: History) -> None:
    """The mission's legs and circles; without a mission, the path that was flown first."""
    plan = next((p for p in reversed(history.plans) if p.items), None)
    if plan is None:
        if history.path is not None:
            x, y = np.array([(p.position.x, p.position.y) for p in history.path.poses]).T
            axes.plot(x, y, "--", color=WANTED, lw=1.2, label="path")
        return
    places = [(i, item.position.x, item.position.y) for i, item in enumerate(plan.items) if item.kind not in _NO_PLACE]
    if places:
        _, x, y = zip(*places, strict=True)
        closes = any(item.kind == MissionItem.JUMP for item in plan.items)
        axes.plot(x + x[:1] * closes, y + y[:1] * closes, "--", color=WANTED, lw=1.2, label="plan")
        axes.plot(x, y, "s", color=WANTED, ms=4)
    for i, east, north in places[:FEW]:
        axes.annotate(str(i), (east, north), xytext=(4, 4), textcoords="offset points", fontsize=8, color=WANTED)
    around = np.linspace(0, 2 * np.pi, 73)
    for item in plan.items:
        if item.kind == MissionItem.ORBIT and item.radius:
            r, p = abs(item.radius), item.position
            axes.plot(p.x + r * np.cos(around), p.y + r * np.sin(around), "--", color=WANTED, lw=1.2)


_NO_PLACE = (MissionItem.JUMP, MissionItem.SPEED, MissionItem.RETURN)


def _wind_arrow(axes: Any, history: History) -> None:
    known = next((motion.wind.mean(axis=0) for motion, *_ in _both(history)), None)
    speed = float(np.hypot(*known)) if known is not None else 0.0
    if known is None or speed < 0.2:
        return
    # In a corner of its own, over whatever is flown there.
    inset = axes.inset_axes((0.01, 0.01, 0.14, 0.16), facecolor="#ffffffd0", zorder=6)
    along = 0.38 * known / speed
    inset.annotate("", along, -along, arrowprops={"arrowstyle": "-|>", "lw": 2.5, "color": FOURTH, "shrinkA": 0, "shrinkB": 0})
    inset.set(xlim=(-0.5, 0.5), ylim=(-0.7, 0.5), xticks=(), yticks=())
    inset.text(0, -0.58, f"wind {speed:.1f} m/s", color=FOURTH, fontsize=8, ha="center", va="center")


def _cross_track(axes: Any, history: History) -> None:
    off = deviation(history)
    if off is not None:
        if off.true_cross_track is not None:
            line(axes, off.t, off.true_cross_track, "truth", TRUTH)
        line(axes, off.t, off.cross_track, "as known", ESTIMATE)
        near = np.abs(off.cross_track[off.on_path])
        most = 1.2 * float(np.percentile(near, 99.5)) if len(near) else NEAR
        axes.set_ylim(-max(most, 1.0), max(most, 1.0))
    finish(axes, "cross-track, m to the right")


def _altitude(axes: Any, history: History) -> None:
    for motion, label, colour in _both(history):
        line(axes, motion.t, motion.position[:, 2], label, colour)
    if (off := deviation(history)) is not None:
        line(axes, off.t, off.wanted, "wanted", WANTED, ls="--")
    finish(axes, "height, m")


def _airspeed(axes: Any, history: History) -> None:
    for motion, label, colour in _both(history):
        line(axes, motion.t, motion.airspeed, label, colour, lw=1.4 if label == "estimate" else 0.7)
    for motion, label, _ in _both(history):
        if label == "estimate":
            line(axes, motion.t, np.hypot(motion.velocity[:, 0], motion.velocity[:, 1]), "over ground", FOURTH, lw=0.8)
    finish(axes, "airspeed, m/s")


def _wind(axes: Any, history: History) -> None:
    for motion, label, _ in _both(history):
        faint = {"lw": 0.6, "alpha": 0.5} if label == "truth" else {"lw": 1.6}
        line(axes, motion.t, motion.wind[:, 0], f"to the east, {label}", ESTIMATE, **faint)
        line(axes, motion.t, motion.wind[:, 1], f"to the north, {label}", WANTED, **faint)
    finish(axes, "wind, m/s", 2)


def _attitude(axes: Any, history: History) -> None:
    for motion, label, _ in _both(history):
        look = {"lw": 0.8} if label == "estimate" else {"lw": 2.0, "alpha": 0.35}
        line(axes, motion.t, np.degrees(motion.roll), f"roll, {label}", ESTIMATE, **look)
        line(axes, motion.t, np.degrees(motion.pitch), f"pitch, {label}", WANTED, **look)
    finish(axes, "attitude, deg", 2)


def _heading(axes: Any, history: History) -> None:
    for motion, label, colour in _both(history):
        line(axes, motion.t, cyclic(np.degrees(motion.heading)), label, colour, lw=2.0 if label == "truth" else 0.8)
    axes.set_yticks((0, 90, 180, 270, 360))
    finish(axes, "heading, deg")


def _surfaces(axes: Any, history: History) -> None:
    rows = history.rows("actuator/surfaces")
    for i, (label, colour) in enumerate((("aileron", ESTIMATE), ("elevator", WANTED), ("rudder", FOURTH)), start=1):
        if len(rows):
            line(axes, rows[:, 0], np.degrees(rows[:, i]), label, colour, lw=0.7)
    finish(axes, "surfaces, deg")


def _energy(axes: Any, history: History) -> None:
    rows, charge, used = history.rows("actuator/surfaces"), history.rows("sensor/battery"), energy(history)
    if len(rows):
        line(axes, rows[:, 0], 100 * rows[:, 4], "throttle, %", WANTED, lw=0.7)
    if len(charge):
        line(axes, charge[:, 0], 100 * charge[:, 3], "charge left, %", FOURTH, lw=1.6)
        other = axes.twinx()
        line(other, used[:, 0], used[:, 1], "power, W (right)", FIFTH, lw=0.8)
        other.set_ylim(0, 1.3 * max(used[:, 1].max(), 1.0))
        other.tick_params(labelsize=8)
        axes.plot([], [], color=FIFTH, lw=0.8, label="power, W (right)")
    axes.set_ylim(0, 110)
    finish(axes, f"throttle, charge and power; {used[-1, 2] / WATT_HOUR:.1f} Wh drawn" if len(used) else "throttle")
