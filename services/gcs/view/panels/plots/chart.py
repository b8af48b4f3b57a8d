"""The frame of a drawn chart: where its numbers lie, its grid, and what is written at it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.gcs.view.markup import Html, html, joined
from uvf.maths.decimation import round_ticks

Floats = NDArray[np.float64]

LEFT, RIGHT, TOP, BOTTOM = 46.0, 8.0, 8.0, 20.0
WIDTH = 340.0


class ChartFrame(NamedTuple):
    """Where numbers of a chart of this ``height`` [px] lie: x from ``begin`` to ``end``, y from ``low`` to ``high``."""

    height: float
    begin: float
    end: float
    low: float
    high: float

    def x(self, value: float) -> float:
        """px"""
        return LEFT + (value - self.begin) / (self.end - self.begin) * (WIDTH - LEFT - RIGHT)

    def y(self, value: float) -> float:
        """px"""
        return self.height - BOTTOM - (value - self.low) / (self.high - self.low) * (self.height - TOP - BOTTOM)

    def box(self) -> Html:
        """Attributes of the SVG element: its size, and what the page's script reads numbers under the pointer by."""
        about = " ".join(repr(float(number)) for number in (LEFT, WIDTH - RIGHT, TOP, self.height - BOTTOM, self.low, self.high))
        return html(
            "viewBox='0 0 {:.0f} {:.0f}' width='100%' data-begin='{:.3f}' data-end='{:.3f}' data-frame='{}'",
            WIDTH,
            self.height,
            self.begin,
            self.end,
            about,
        )

    def grid(self, since: float) -> Html:
        """Lines and numbers of both axes; none before ``since`` along the lower one."""
        values = round_ticks(self.low, self.high, 5)
        apart = values[1] - values[0] if len(values) > 1 else 0.0
        digits = max(0, -int(np.floor(np.log10(apart) + 1e-9))) if apart > 0 else 2
        rows = joined(self._row(value, digits) for value in values)
        columns = joined(
            html("<path d='M{:.1f} {}V{}'/><text x='{:.1f}' y='{}' class='g-mid'>{:g}</text>", *self._column(value))
            for value in round_ticks(max(self.begin, since), self.end, 6)
        )
        return html("<g class='g-grid'>{}{}</g>", rows, columns)

    def _row(self, value: float, digits: int) -> Html:
        y = self.y(value)
        line = html("<path d='M{} {:.1f}H{}'/>", LEFT, y, WIDTH - RIGHT)
        return html("{}<text x='{}' y='{:.1f}' class='g-end'>{:.{digits}f}</text>", line, LEFT - 4, y + 3.5, value + 0.0, digits=digits)

    def _column(self, value: float) -> tuple[float, float, float, float, float, float]:
        x = self.x(value)
        return x, TOP, self.height - BOTTOM, x, self.height - 6, round(value, 3)

    def unit(self, name: str) -> Html:
        """The unit of its numbers."""
        return html("<text x='{}' y='{}' class='g-unit'>{}</text>", LEFT + 4, TOP + 10, name)


def room(low: float, high: float, least: float) -> tuple[float, float]:
    """The range of an axis for numbers from ``low`` to ``high``: with a little room, and never flat or finer than numbers are kept."""
    half = max(0.58 * (high - low), least / 2, 1e-9 * max(abs(low), abs(high)))
    return (low + high) / 2 - half, (low + high) / 2 + half


def curve(frame: ChartFrame, colour: int, name: str, t: Floats, values: Floats) -> Html:
    """One curve in the ``colour`` of this number, 0 to 7: values (n,) at t (n,); it breaks where a value is NaN."""
    parts: list[str] = []
    pen = "M"
    for at, value in zip(t.tolist(), values.tolist(), strict=True):
        if np.isfinite(value):
            parts.append(f"{pen}{frame.x(at):.1f} {frame.y(value):.1f}")
            pen = "L"
        else:
            pen = "M"
    return html("<path class='g-curve g-c{}' data-name='{}' d='{}'/>", colour, name, "".join(parts))
