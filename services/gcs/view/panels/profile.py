"""The height of a drawn mission over the distance flown, as SVG."""

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.plan_outlook import PlanOutlook
from services.gcs.view.markup import Html, html, joined
from uvf.maths.decimation import round_ticks

Floats = NDArray[np.float64]

WIDTH, HEIGHT = 340.0, 130.0
LEFT, RIGHT, TOP, BOTTOM = 34.0, 8.0, 10.0, 22.0
MOST_POINTS = 200


def profile(outlook: PlanOutlook) -> Html:
    """The profile; empty while there is nothing to show."""
    line = outlook.line
    if len(line) < 2 or outlook.length <= 0:
        return html("")
    top = max(float(line[:, 2].max()) * 1.15, 10.0)
    floor = min(float(line[:, 2].min()), 0.0)
    keep = np.unique(np.linspace(0, len(line) - 1, min(MOST_POINTS, len(line))).astype(int))

    def at(distance: float, height: float) -> tuple[float, float]:
        x = LEFT + distance / outlook.length * (WIDTH - LEFT - RIGHT)
        return x, HEIGHT - BOTTOM - (height - floor) / (top - floor) * (HEIGHT - TOP - BOTTOM)

    points = " ".join("{:.1f},{:.1f}".format(*at(float(outlook.s[i]), float(line[i, 2]))) for i in keep)
    marks = joined(_mark(i, *at(distance, height)) for i, distance, height in outlook.passed)
    label = f"height over distance: {line[:, 2].min():.0f} to {line[:, 2].max():.0f} m over {outlook.length:.0f} m"
    return html(
        "<h2 class='g-h'>Profile<span>height m over distance m, {}</span></h2>"
        "<svg class='g-profile' role='img' aria-label='{}' viewBox='0 0 {:.0f} {:.0f}' width='100%'>{}<polyline points='{}'/>{}</svg>",
        "as flown ahead" if outlook.is_flown else "being flown ahead",
        label,
        WIDTH,
        HEIGHT,
        joined((_heights(floor, top, at(0.0, 0.0)[1]), _distances(outlook.length))),
        points,
        marks,
    )


def _mark(i: int, x: float, y: float) -> Html:
    return html("<circle cx='{:.1f}' cy='{:.1f}' r='3'/><text x='{:.1f}' y='{:.1f}' class='g-mid'>{}</text>", x, y, x, y - 6, i + 1)


def _heights(floor: float, top: float, ground: float) -> Html:
    lines = []
    for height in round_ticks(floor, top, 4):
        y = HEIGHT - BOTTOM - (height - floor) / (top - floor) * (HEIGHT - TOP - BOTTOM)
        lines.append(
            html(
                "<path d='M{} {:.1f}H{}'/><text x='{}' y='{:.1f}' class='g-end'>{:.0f}</text>",
                LEFT,
                y,
                WIDTH - RIGHT,
                LEFT - 5,
                y + 4,
                height,
            )
        )
    lines.append(html("<path class='g-ground' d='M{} {:.1f}H{}'/>", LEFT, ground, WIDTH - RIGHT))
    return joined(lines)


def _distances(length: float) -> Html:
    return joined(
        html("<text x='{:.1f}' y='{}' class='g-mid'>{:.0f}</text>", LEFT + tick / length * (WIDTH - LEFT - RIGHT), HEIGHT - 6, tick)
        for tick in round_ticks(0.0, length, 5)
    )
