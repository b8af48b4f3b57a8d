"""The tab Plot: numbers of the bus over simulation time, a chart for each unit."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Event
from schemas.topics import TOPICS
from services.gcs.state.plot_choice import WINDOWS, PlotChoice, presets_of
from services.gcs.state.plot_series import PlotSeries, SeriesName, unit_of
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined
from uvf.maths.decimation import min_max, round_ticks

Floats = NDArray[np.float64]

WIDTH, HEIGHT = 340.0, 170.0
LEFT, RIGHT, TOP, BOTTOM = 46.0, 8.0, 8.0, 20.0
MOST_POINTS = 600
MOST_EVENTS = 30
FLATTEST = 1e-6


def plot_panel(model: Model, v: VehicleModel, session: BrowserSession) -> Html:
    """The panel as one page sees it."""
    choice = session.plot
    return html("{}{}{}{}", _presets(v), _charts(model, choice), _legend(model, choice), _chooser(model, v, choice))


def _presets(v: VehicleModel) -> Html:
    keys = joined(button(name, "plot-preset", name, style="g-btn g-small") for name in presets_of(v))
    return html("<h2 class='g-h'>Plots of {}</h2><div class='g-row g-wrap'>{}</div>", v.name, keys)


def _charts(model: Model, choice: PlotChoice) -> Html:
    if not choice.series:
        return html("<p class='g-empty'>Choose a preset, or a number of any topic below.</p>")
    units: dict[str, list[int]] = {}
    for i, name in enumerate(choice.series):
        units.setdefault(unit_of(name), []).append(i)
    windows = joined(button(_span(w), "plot-window", w, style="", pressed=w == choice.window) for w in WINDOWS)
    hold = button("▶ Go on", "plot-hold", False) if choice.held_at is not None else button("❚❚ Hold", "plot-hold", True)
    head = html(
        "<div class='g-row g-gap'><div class='g-pressed-group' role='group' aria-label='Time shown'>{}</div>{}</div>", windows, hold
    )
    end = model.sim_time if choice.held_at is None else choice.held_at
    return joined((head, *(_chart(model, choice, unit, members, end) for unit, members in units.items())))


def _span(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"


def _chart(model: Model, choice: PlotChoice, unit: str, members: Sequence[int], end: float) -> Html:
    """All numbers of one unit."""
    begin = end - choice.window
    curves = [(i, *_points(model.plots.series.get(choice.series[i]), begin, end)) for i in members]
    low, high = _range([values for _, _, values in curves])
    frame = _Frame(begin, end, low, high)
    lines = joined(frame.line(i, t, values) for i, t, values in curves)
    label = f"{unit or 'numbers'} over {choice.window:.0f} s: {', '.join(choice.series[i].path for i in members)}"
    return html(
        "<svg class='g-chart' role='img' aria-label='{}' viewBox='0 0 {:.0f} {:.0f}' width='100%' data-begin='{:.3f}' data-end='{:.3f}'>"
        "{}{}{}<text x='{}' y='{}' class='g-unit'>{}</text></svg>",
        label,
        WIDTH,
        HEIGHT,
        begin,
        end,
        frame.grid(),
        frame.events(model),
        lines,
        LEFT + 4,
        TOP + 10,
        unit,
    )


def _points(series: PlotSeries | None, begin: float, end: float) -> tuple[Floats, Floats]:
    if series is None:
        return np.zeros(0), np.zeros(0)
    t, values = series.since(begin)
    within = t <= end
    return min_max(t[within], values[within], MOST_POINTS)


def _range(curves: Sequence[Floats]) -> tuple[float, float]:
    """With a little room, and never flat."""
    known = np.concatenate([values[np.isfinite(values)] for values in curves]) if curves else np.zeros(0)
    if len(known) == 0:
        return -1.0, 1.0
    low, high = float(known.min()), float(known.max())
    room = max(0.08 * (high - low), FLATTEST, 0.02 * abs(high) if high == low else 0.0)
    return low - room, high + room


class _Frame:
    """Where times and values of a chart lie."""

    def __init__(self, begin: float, end: float, low: float, high: float) -> None:
        self.begin, self.end, self.low, self.high = begin, end, low, high

    def x(self, t: float) -> float:
        """px"""
        return LEFT + (t - self.begin) / (self.end - self.begin) * (WIDTH - LEFT - RIGHT)

    def y(self, value: float) -> float:
        """px"""
        return HEIGHT - BOTTOM - (value - self.low) / (self.high - self.low) * (HEIGHT - TOP - BOTTOM)

    def grid(self) -> Html:
        """Lines and numbers of both axes."""
        values = round_ticks(self.low, self.high, 5)
        digits = max(0, -int(np.floor(np.log10(values[1] - values[0]) + 1e-9))) if len(values) > 1 else 2
        rows = joined(
            html(
                "<path d='M{} {:.1f}H{}'/><text x='{}' y='{:.1f}' class='g-end'>{:.{digits}f}</text>",
                LEFT,
                self.y(value),
                WIDTH - RIGHT,
                LEFT - 4,
                self.y(value) + 3.5,
                value + 0.0,
                digits=digits,
            )
            for value in values
        )
        columns = joined(
            html("<path d='M{:.1f} {}V{}'/><text x='{:.1f}' y='{}' class='g-mid'>{:g}</text>", *self._column(t))
            for t in round_ticks(max(self.begin, 0.0), self.end, 6)
        )
        return html("<g class='g-grid'>{}{}</g>", rows, columns)

    def _column(self, t: float) -> tuple[float, float, float, float, float, float]:
        return self.x(t), TOP, HEIGHT - BOTTOM, self.x(t), HEIGHT - 6, round(t, 3)

    def line(self, colour: int, t: Floats, values: Floats) -> Html:
        """One curve; it breaks where a value is NaN."""
        parts: list[str] = []
        pen = "M"
        for at, value in zip(t.tolist(), values.tolist(), strict=True):
            if np.isfinite(value):
                parts.append(f"{pen}{self.x(at):.1f} {self.y(value):.1f}")
                pen = "L"
            else:
                pen = "M"
        return html("<path class='g-curve g-c{}' d='{}'/>", colour, "".join(parts))

    def events(self, model: Model) -> Html:
        """A line where something happened: warnings and worse, and what operators asked for."""
        seen = [e for e in model.log if self.begin <= e.t <= self.end and (e.severity >= Event.NOTICE or e.of_operator)][-MOST_EVENTS:]
        return joined(
            html(
                "<path class='g-event g-e-{}' d='M{:.1f} {}V{}'><title>{:.1f} s: {}</title></path>",
                e.kind,
                self.x(e.t),
                TOP,
                HEIGHT - BOTTOM,
                e.t,
                e.text,
            )
            for e in seen
        )


def _legend(model: Model, choice: PlotChoice) -> Html:
    return html("<ul class='g-legend'>{}</ul>", joined(_entry(model, i, name) for i, name in enumerate(choice.series)))


def _entry(model: Model, i: int, name: SeriesName) -> Html:
    series = model.plots.series.get(name)
    newest = series.newest if series is not None else None
    value = "nothing heard yet" if newest is None else f"{newest:.4g} {unit_of(name)}"
    remove = button("✕", "plot-remove", name.key, name.path, style="g-link", more=html("aria-label='Plot {} no more'", name))
    return html("<li data-key='{}'><i class='g-c{}'></i><span>{}</span><b>{}</b>{}</li>", name, i, name, value, remove)


def _chooser(model: Model, v: VehicleModel, choice: PlotChoice) -> Html:
    """Topics of the vehicle on show and of the system, and the numbers of the chosen one."""
    keys = [topic.at(v.name) for topic in TOPICS.values() if "<source>" not in topic.key]
    options = joined(
        html("<option value='{}'{}>{}</option>", key, html(" selected") if key == choice.topic else html(""), key.partition("/")[2])
        for key in ("", *sorted(keys))
    )
    fields = joined(
        button(f"+ {one.path}{f' [{one.unit}]' if one.unit else ''}", "plot-add", choice.topic, one.path, style="g-link")
        for one in (model.plots.fields_of(choice.topic) if choice.topic else ())
    )
    select = html("<select {} aria-label='Topic to plot from'>{}</select>", does("plot-topic"), options)
    return html("<h2 class='g-h'>Any number</h2>{}<div class='g-fields'>{}</div>", select, fields)
