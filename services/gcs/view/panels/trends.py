"""Small charts of the last minute below a vehicle's instrument."""

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.trends import Trend, Trends
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.chart import ChartFrame, curve

Floats = NDArray[np.float64]

MINUTE = 60.0  # s
HEIGHT = 84.0
LEAST = 2.0
"""In the chart's unit: a steady number is not drawn as if it trembled."""


def trend_charts(trends: Trends, end: float | None) -> Html:
    """The charts up to ``end`` [s, simulation], or to the newest number; empty before there is one."""
    end = trends.newest if end is None else end
    if end is None:
        return html("")
    return html("<h2 class='g-h'>Last minute</h2>{}", joined(_chart(trend, i, end) for i, trend in enumerate(trends.all)))


def _chart(trend: Trend, colour: int, end: float) -> Html:
    t, values = trend.series.since(end - MINUTE)
    t, values = t[t <= end], values[t <= end]
    known = values[np.isfinite(values)]
    middle, half = (float(known.max() + known.min()) / 2, float(np.ptp(known)) / 2) if len(known) else (0.0, 0.0)
    half = max(1.15 * half, LEAST / 2)
    frame = ChartFrame(HEIGHT, end - MINUTE, end, middle - half, middle + half)
    label = f"{trend.name} over the last minute" + (f": {known[-1]:.1f} {trend.unit}" if len(known) else "")
    return html(
        "<svg class='g-chart' role='img' aria-label='{}' data-unit='{}' data-over='s' {}>{}{}{}</svg>",
        label,
        trend.unit,
        frame.box(),
        frame.grid(),
        curve(frame, colour, trend.name, t, values),
        frame.unit(f"{trend.name} {trend.unit}"),
    )
