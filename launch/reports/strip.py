"""Modes and events over time: the strip above a page's plots, and what is marked in each of them."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from launch.reports.history import History
from schemas.messages import Event
from uvf.runtime.messages.convert import mode_name

Panel = Callable[[Any, History], None]
"""Draws one plot of a vehicle's history into axes."""

BANDS = ("#f3f3f7", "#e2ebf6")  # behind one mode and the next
MOST_NAMED = 12  # events written out
LINES = 3  # of them below each other
LAST = 0.15
"""Of the time, in which they are written before their marks, so that they stay on the page."""


def draw_modes(axes: Any, history: History) -> None:
    """Draws modes as bands with their names, events as marks with theirs."""
    stretches = _stretches(history)
    begin, end = span(history)
    axes.set_xlim(begin, end)
    axes.set_ylim(0, 1)
    for i, (a, b, mode) in enumerate(stretches):
        axes.axvspan(a, b, color=BANDS[i % 2], lw=0)
        if b - a > 0.04 * (end - begin):
            axes.text((a + b) / 2, 0.2, mode_name(mode).capitalize(), ha="center", va="center", fontsize=9)
    last, row = -np.inf, 0
    for t, event in [e for e in history.events if e[1].severity >= Event.NOTICE][:MOST_NAMED]:
        row = row + 1 if t - last < 0.12 * (end - begin) else 0
        last = t
        axes.plot([t, t], [0, 1], color=_colour(event), lw=1.0)
        if row < LINES:
            ha, aside = ("left", 3) if t < end - LAST * (end - begin) else ("right", -3)
            look = {"fontsize": 7, "ha": ha, "va": "center", "color": _colour(event)}
            axes.annotate(event.text, (t, 0.85 - 0.22 * row), xytext=(aside, 0), textcoords="offset points", **look)
    axes.set_yticks([])
    axes.tick_params(labelsize=8)
    axes.set_title("modes and events", fontsize=10, loc="left")


def draw_panels(strip: Any, grid: Any, panels: Sequence[Panel], history: History) -> None:
    """Draws the panels into the lowest rows of the page's grid of two columns, over the strip's time and with its marks."""
    rows = len(panels) // 2
    for i, panel in enumerate(panels):
        axes = strip.figure.add_subplot(grid[grid.nrows - rows + i % rows, i // rows])
        axes.set_xlim(strip.get_xlim())
        panel(axes, history)
        _mark(axes, history)
        if i % rows == rows - 1:
            axes.set_xlabel("s")


def _mark(axes: Any, history: History) -> None:
    """Draws the modes behind it, items reached as ticks below, events as lines."""
    for i, (a, b, _) in enumerate(_stretches(history)):
        axes.axvspan(a, b, color=BANDS[i % 2], lw=0, zorder=-2)
    for t, event in history.events:
        if event.severity > Event.INFO:
            axes.axvline(t, color=_colour(event), lw=0.8, alpha=0.6, zorder=-1)
        elif event.text.endswith("reached"):
            axes.plot(t, 0.0, "^", color="#888888", ms=4, transform=axes.get_xaxis_transform(), clip_on=False)


def span(history: History) -> tuple[float, float]:
    """s, what the log tells of."""
    times = [rows[[0, -1], 0] for rows in (s.rows for s in history.series.values()) if len(rows)]
    begin, end = (float(min(t[0] for t in times)), float(max(t[1] for t in times))) if times else (0.0, 1.0)
    return begin, max(end, begin + 1.0)


def _stretches(history: History) -> list[tuple[float, float, int]]:
    """(from, to [s], mode), one after the other."""
    rows = history.rows("state/vehicle")
    if not len(rows):
        return []
    begins = np.flatnonzero(np.diff(rows[:, 1], prepend=-1))
    ends = np.append(rows[begins[1:], 0], rows[-1, 0])
    return [(float(rows[b, 0]), float(e), int(rows[b, 1])) for b, e in zip(begins, ends, strict=True)]


def _colour(event: Event) -> str:
    return "#c62828" if event.severity >= Event.WARNING else "#6a6a8a"
