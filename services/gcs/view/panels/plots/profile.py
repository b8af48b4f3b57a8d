"""The height of a drawn mission over the distance flown, as SVG."""

import numpy as np

from services.gcs.state.plans.plan_outlook import PlanOutlook
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.plots.chart import ChartFrame

HEIGHT = 130.0
MOST_POINTS = 200


def profile(outlook: PlanOutlook) -> Html:
    """The profile; empty while there is nothing to show."""
    line = outlook.line
    if len(line) < 2 or outlook.length <= 0:
        return html("")
    top = max(float(line[:, 2].max()) * 1.15, 10.0)
    frame = ChartFrame(HEIGHT, 0.0, outlook.length, min(float(line[:, 2].min()), 0.0), top)
    keep = np.unique(np.linspace(0, len(line) - 1, min(MOST_POINTS, len(line))).astype(int))
    path = "L".join(f"{frame.x(float(outlook.s[i])):.1f} {frame.y(float(line[i, 2])):.1f}" for i in keep)
    marks = joined(_mark(i, frame.x(distance), frame.y(height)) for i, distance, height in outlook.passed)
    label = f"height over distance: {line[:, 2].min():.0f} to {line[:, 2].max():.0f} m over {outlook.length:.0f} m"
    return html(
        "<h2 class='g-h'>Profile<span>height m over distance m, {}</span></h2>"
        "<svg class='g-chart g-profile' role='img' aria-label='{}' data-unit='m' data-over='m' {}>"
        "{}<path class='g-curve' data-name='height' d='M{}'/>{}</svg>",
        "as flown ahead" if outlook.is_flown else "being flown ahead",
        label,
        frame.box(),
        frame.grid(0.0),
        path,
        marks,
    )


def _mark(i: int, x: float, y: float) -> Html:
    return html("<circle cx='{:.1f}' cy='{:.1f}' r='3'/><text x='{:.1f}' y='{:.1f}' class='g-mid'>{}</text>", x, y, x, y - 6, i + 1)
