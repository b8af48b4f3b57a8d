"""Small charts of the last minute below a vehicle's instrument."""

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.plots.trends import Trend, Trends
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.plots.chart import ChartFrame, curve, room

Floats = NDArray[np.float64]

MINUTE = 60.0  # s
HEIGHT = 84.0
LEAST = 2.0
"""In the chart's unit: a steady number is not drawn as if it trembled."""


def trend_charts(trends: Trends, end: float) -> Html:
    """The charts of the minute up to ``end`` [s, wall]; empty while nothing is heard."""
    if not trends.is_heard:
        return html("")
    return html("<h2 class='g-h'>Last minute</h2>{}", joined(_chart(trend, i, end) for i, trend in enumerate(trends.all)))


def _chart(trend: Trend, colour: int, end: float) -> Html:
    t, values = trend.series.since(end - MINUTE)
    t, values = t[t <= end] - end, values[t <= end]
    known = values[np.isfinite(values)]
    low, high = room(float(known.min()), float(known.max()), LEAST) if len(known) else (-LEAST, LEAST)
    frame = ChartFrame(HEIGHT, -MINUTE, 0.0, low, high)
    label = f"{trend.name} over the last minute" + (f": {known[-1]:.1f} {trend.unit}" if len(known) else "")
    return html(
        "<svg class='g-chart' role='img' aria-label='{}' data-unit='{}' data-over='s' {}>{}{}{}</svg>",
        label,
        trend.unit,
        frame.box(),
        frame.grid(-MINUTE),
        curve(frame, colour, trend.name, t, values),
        frame.unit(f"{trend.name} {trend.unit}"),
    )
