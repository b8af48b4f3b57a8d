"""A small map of everything from above, north up: floor, missions, tracks, vehicles; SVG."""

from collections.abc import Sequence
from math import degrees

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.scene.scenery import extent
from services.gcs.view.scene.way_layers import mission_points
from uvf.maths.rotations import to_euler

Floats = NDArray[np.float64]

WIDTH, HEIGHT, MARGIN = 270.0, 210.0, 22.0
STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)  # m, lengths that a scale bar may have
MAX_POINTS = 150


class Overview:
    """Draws the overview map."""

    def __init__(self, model: Model) -> None:
        self._model = model
        low, high = extent(model.site)[:, :2]
        span = np.maximum(high - low, 1.0)
        self._scale = float(np.min(np.array((WIDTH - 2 * MARGIN, HEIGHT - 2 * MARGIN)) / span))
        self._middle = (low + high) / 2
        self._still = joined((self._floor(), self._scale_bar()))

    def svg(self, chosen: VehicleModel | None) -> Html:
        """The map as SVG; the chosen vehicle is drawn larger."""
        moving = joined(self._vehicle(v, v is chosen) for v in self._model.vehicles.values())
        return html(
            "<svg id='gcs-overview' role='img' aria-label='map of all vehicles, north up' viewBox='0 0 {:.0f} {:.0f}' "
            "width='100%' font-family='ui-sans-serif,system-ui,sans-serif' font-size='11'>{}{}</svg>",
            WIDTH,
            HEIGHT,
            self._still,
            moving,
        )

    def _at(self, points: Floats) -> Floats:
        """(n, 2) px of (n, 2 or more) m, world."""
        flat = (points[:, :2] - self._middle) * self._scale
        return np.column_stack((WIDTH / 2 + flat[:, 0], HEIGHT / 2 - flat[:, 1]))

    def _floor(self) -> Html:
        x_min, y_min, x_max, y_max = self._model.site.world.floor
        (left, bottom), (right, top) = self._at(np.array(((x_min, y_min), (x_max, y_max))))
        return html(
            "<rect width='{}' height='{}' class='o-back'/>"
            "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' class='o-floor'/>"
            "<path d='M{} 26v-14m-4 5l4 -6l4 6' class='o-line'/>"
            "<text x='{}' y='38' text-anchor='middle' font-size='10'>N</text>",
            WIDTH,
            HEIGHT,
            left,
            top,
            right - left,
            bottom - top,
            WIDTH - 16,
            WIDTH - 16,
        )

    def _scale_bar(self) -> Html:
        length = max((s for s in STEPS if s * self._scale <= 80), default=STEPS[0])
        px = length * self._scale
        bar = html("<path d='M12 {}v4h{:.1f}v-4' class='o-line'/>", HEIGHT - 14, px)
        return html("{}<text x='{:.1f}' y='{}'>{} m</text>", bar, 18 + px, HEIGHT - 9, length)

    def _vehicle(self, v: VehicleModel, is_chosen: bool) -> Html:
        route = _path(self._at(mission_points(v)), "var(--route)", html("stroke-dasharray='4 3' opacity='.8'")) if v.flies else html("")
        tracks = [points for _, points in v.track.closed] + [v.track.tail]
        gone = joined(_path(self._at(_thinned(p)), v.colour, html("opacity='.75'")) for p in tracks if len(p) > 1 and v.flies)
        if v.place is None:
            return joined((route, gone))
        x, y = self._at(v.place.position[None])[0]
        heading = 90 - degrees(to_euler(v.place.wxyz)[2])
        size = 1.25 if is_chosen else 1.0
        where = f"translate({x:.1f} {y:.1f}) rotate({heading:.0f}) scale({size})"
        icon = html("<path transform='{}' d='M0 -8L6 7L0 4L-6 7Z' fill='{}' stroke='var(--panel)' stroke-width='.8'/>", where, v.colour)
        return joined((route, gone, icon, _name(v.name, x, y)))


def _thinned(points: Floats) -> Floats:
    return points[:: max(1, len(points) // MAX_POINTS)]


def _path(points: Floats, colour: str, more: Html) -> Html:
    if len(points) < 2:
        return html("")
    text: Sequence[str] = [f"{x:.1f} {y:.1f}" for x, y in points]
    return html("<path d='M{}' fill='none' stroke='{}' stroke-width='1.5' {}/>", "L".join(text), colour, more)


def _name(name: str, x: float, y: float) -> Html:
    """Beside the vehicle, on the side where there is room."""
    right = x < WIDTH * 0.7
    return html(
        "<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>", x + (10 if right else -10), y + 4, "start" if right else "end", name
    )
