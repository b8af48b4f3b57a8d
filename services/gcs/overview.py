"""A small map of everything from above, north up: floor, missions, tracks, vehicles; SVG."""

from collections.abc import Sequence
from math import degrees

import numpy as np
from numpy.typing import NDArray

from services.gcs.scenery import extent
from services.gcs.state import Model, VehicleModel
from services.gcs.view import mission_points
from uvf.maths.rotations import to_euler

Floats = NDArray[np.float64]

WIDTH, HEIGHT, MARGIN = 270.0, 210.0, 22.0
STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)  # m, lengths that a scale bar may have
MAX_POINTS = 150


class Overview:
    def __init__(self, model: Model) -> None:
        self._model = model
        low, high = extent(model.site)[:, :2]
        span = np.maximum(high - low, 1.0)
        self._scale = float(np.min(np.array((WIDTH - 2 * MARGIN, HEIGHT - 2 * MARGIN)) / span))
        self._middle = (low + high) / 2
        self._still = self._floor() + self._scale_bar()

    def svg(self) -> str:
        moving = "".join(self._vehicle(v) for v in self._model.vehicles.values())
        return (
            f"<svg id='gcs-overview' role='img' aria-label='map of all vehicles, north up' viewBox='0 0 {WIDTH:.0f} {HEIGHT:.0f}' "
            f"width='100%' font-family='ui-sans-serif,system-ui,sans-serif' font-size='11' fill='#cfd8e6'>{self._still}{moving}</svg>"
        )

    def _at(self, points: Floats) -> Floats:
        """(n, 2) px of (n, 2 or more) m, world."""
        flat = (points[:, :2] - self._middle) * self._scale
        return np.column_stack((WIDTH / 2 + flat[:, 0], HEIGHT / 2 - flat[:, 1]))

    def _floor(self) -> str:
        x_min, y_min, x_max, y_max = self._model.site.world.floor
        (left, bottom), (right, top) = self._at(np.array(((x_min, y_min), (x_max, y_max))))
        return (
            f"<rect width='{WIDTH}' height='{HEIGHT}' rx='8' fill='#0d1522'/>"
            f"<rect x='{left:.1f}' y='{top:.1f}' width='{right - left:.1f}' height='{bottom - top:.1f}' fill='#5b6b85' stroke='#a9b8cf'/>"
            f"<path d='M{WIDTH - 16} 26v-14m-4 5l4 -6l4 6' fill='none' stroke='#cfd8e6' stroke-width='1.4'/>"
            f"<text x='{WIDTH - 16}' y='38' text-anchor='middle' font-size='10'>N</text>"
        )

    def _scale_bar(self) -> str:
        length = max((s for s in STEPS if s * self._scale <= 80), default=STEPS[0])
        px = length * self._scale
        bar = f"<path d='M12 {HEIGHT - 14}v4h{px:.1f}v-4' fill='none' stroke='#cfd8e6'/>"
        return f"{bar}<text x='{18 + px:.1f}' y='{HEIGHT - 9}'>{length} m</text>"

    def _vehicle(self, v: VehicleModel) -> str:
        route = _path(self._at(mission_points(v)), "#e84ad6", "stroke-dasharray='4 3' opacity='.8'") if v.flies else ""
        tracks = [points for _, points in v.track.closed] + [v.track.tail]
        gone = "".join(_path(self._at(_thinned(p)), v.colour, "opacity='.75'") for p in tracks if len(p) > 1 and v.flies)
        if v.place is None:
            return route + gone
        x, y = self._at(v.place.position[None])[0]
        heading = 90 - degrees(to_euler(v.place.wxyz)[2])
        size = 1.25 if v.name == self._model.selected else 1.0
        where = f"translate({x:.1f} {y:.1f}) rotate({heading:.0f}) scale({size})"
        icon = f"<path transform='{where}' d='M0 -8L6 7L0 4L-6 7Z' fill='{v.colour}' stroke='#fff' stroke-width='.8'/>"
        return f"{route}{gone}{icon}{_name(v.name, x, y)}"


def _thinned(points: Floats) -> Floats:
    return points[:: max(1, len(points) // MAX_POINTS)]


def _path(points: Floats, colour: str, more: str) -> str:
    if len(points) < 2:
        return ""
    text: Sequence[str] = [f"{x:.1f} {y:.1f}" for x, y in points]
    return f"<path d='M{'L'.join(text)}' fill='none' stroke='{colour}' stroke-width='1.5' {more}/>"


def _name(name: str, x: float, y: float) -> str:
    """Beside the vehicle, on the side where there is room."""
    right = x < WIDTH * 0.7
    return f"<text x='{x + (10 if right else -10):.1f}' y='{y + 4:.1f}' text-anchor='{'start' if right else 'end'}'>{name}</text>"
