"""Lines and frames of plots, alike on every page of a report."""

from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

matplotlib.rcParams["text.parse_math"] = False  # names and events are told as they are, whatever $ they hold

Floats = NDArray[np.float64]

MOST_POINTS = 3000  # of a line
TRUTH, ESTIMATE, WANTED, FOURTH, FIFTH = "#222222", "#1f77b4", "#e07b00", "#2a9d4a", "#7b3fa0"


def line(axes: Any, t: Floats, values: Floats, label: str, colour: str, **look: Any) -> None:
    """Draws values (k,) over ``t`` (k,) [s]. Long ones are drawn by the least and the largest of each stretch: no peak is lost."""
    if len(t) > MOST_POINTS:
        edges = np.linspace(0, len(t), MOST_POINTS // 2, dtype=int)[:-1]
        low, high = np.fmin.reduceat(values, edges), np.fmax.reduceat(values, edges)
        t, values = np.repeat(t[edges], 2), np.column_stack((low, high)).ravel()
    axes.plot(t, values, label=label, color=colour, **{"lw": 1.0, **look})


def finish(axes: Any, title: str, columns: int = 3) -> None:
    """Title, grid and legend of a plot."""
    axes.set_title(title, fontsize=10, loc="left")
    axes.grid(alpha=0.3)
    axes.tick_params(labelsize=8)
    if not axes.has_data():
        axes.text(0.5, 0.5, "nothing of it in this run", transform=axes.transAxes, ha="center", va="center", color="#999999", fontsize=9)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize=8, ncols=columns, loc="upper right", framealpha=0.8)
        if axes.get_aspect() == "auto":
            low, high = axes.get_ylim()
            axes.set_ylim(low, high + 0.2 * (high - low))  # room for the legend


def cyclic(degrees: Floats) -> Floats:
    """Angles (k,) [deg] from 0 to 360, with gaps where they pass 0: no line leads across the plot there."""
    turned = degrees % 360
    turned[np.flatnonzero(np.abs(np.diff(turned)) > 180)] = np.nan
    return turned


def figure_table(axes: Any, rows: list[tuple[str, str]]) -> None:
    """Fills a plot with a table of names and values instead."""
    axes.axis("off")
    if not rows:
        return
    table = axes.table(rows, colWidths=(0.4, 0.6), cellLoc="left", edges="horizontal", bbox=(0.0, 0.0, 1.0, 1.0))
    table.auto_set_font_size(False)
    table.set_fontsize(10)
    for cell in table.get_celld().values():
        cell.set_edgecolor("#cccccc")
