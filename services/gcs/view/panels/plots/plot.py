"""The tab Plot: numbers of the bus over simulation time, a chart for each unit."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Event
from schemas.topics import TOPICS
from services.gcs.state.plots.plot_choice import WINDOWS, PlotChoice, presets_of
from services.gcs.state.plots.plot_series import PlotSeries, SeriesName, unit_of
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.plots.chart import BOTTOM, TOP, ChartFrame, curve, room
from uvf.maths.decimation import min_max

Floats = NDArray[np.float64]

HEIGHT = 170.0
MOST_POINTS = 600
MOST_EVENTS = 30
MOST_FOUND = 40
FLATTEST = 1e-6


def plot_panel(model: Model, v: VehicleModel, session: BrowserSession) -> Html:
    """The panel as one page sees it."""
    choice = session.plot
    return html("{}{}{}{}", _presets(v), _charts(model, choice), _legend(model, choice), _chooser(model, v, choice))


def _presets(v: VehicleModel) -> Html:
    keys = joined(button(name, "plot-preset", name, style="g-btn g-small") for name in presets_of(v.flies))
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
    frame = ChartFrame(HEIGHT, begin, end, low, high)
    lines = joined(curve(frame, i, choice.series[i].path, t, values) for i, t, values in curves)
    label = f"{unit or 'numbers'} over {choice.window:.0f} s: {', '.join(choice.series[i].path for i in members)}"
    return html(
        "<svg class='g-chart' role='img' aria-label='{}' data-unit='{}' data-over='s' {}>{}{}{}{}</svg>",
        label,
        unit,
        frame.box(),
        frame.grid(0.0),
        _events(frame, model),
        lines,
        frame.unit(unit),
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
    return room(low, high, max(0.04 * abs(high), FLATTEST) if high == low else FLATTEST)


def _events(frame: ChartFrame, model: Model) -> Html:
    """A line where something happened: warnings and worse, and what operators asked for."""
    seen = [e for e in model.log if frame.begin <= e.t <= frame.end and (e.severity >= Event.NOTICE or e.of_operator)][-MOST_EVENTS:]
    return joined(
        html(
            "<path class='g-event g-e-{}' d='M{:.1f} {}V{}'><title>{:.1f} s: {}</title></path>",
            e.kind,
            frame.x(e.t),
            TOP,
            frame.height - BOTTOM,
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
    """A search through all numbers of the vehicle on show and of the system; or their topics, and the numbers of the chosen one."""
    keys = sorted(topic.at(v.name) for topic in TOPICS.values() if "<source>" not in topic.key)
    search = html(
        "<input type='search' data-key='plot-find' aria-label='Search numbers' placeholder='search, as in: airspeed' maxlength='64' "
        "value='{}' {}>",
        choice.text,
        does("plot-find"),
    )
    found = _found(model, keys, choice.text) if choice.text.strip() else _listed(model, keys, choice)
    return html("<h2 class='g-h'>Any number</h2>{}{}", search, found)


def _found(model: Model, keys: Sequence[str], text: str) -> Html:
    """The numbers whose topic, name and unit hold every word of a text."""
    words = text.lower().split()
    every = ((SeriesName(key, one.path), one.unit) for key in keys for one in model.plots.fields_of(key))
    found = [(name, unit) for name, unit in every if all(word in f"{name} {unit}".lower() for word in words)]
    rows = joined(_adds(name, str(name), unit) for name, unit in found[:MOST_FOUND])
    more = html("<p class='g-why'>and {} more: write more of the name</p>", len(found) - MOST_FOUND) if len(found) > MOST_FOUND else ""
    return html("<div class='g-fields'>{}{}</div>", rows if found else html("<p class='g-empty'>No number is called so.</p>"), more)


def _listed(model: Model, keys: Sequence[str], choice: PlotChoice) -> Html:
    options = joined(
        html("<option value='{}'{}>{}</option>", key, html(" selected") if key == choice.topic else html(""), key.partition("/")[2])
        for key in ("", *keys)
    )
    numbers = model.plots.fields_of(choice.topic) if choice.topic else ()
    fields = joined(_adds(SeriesName(choice.topic, one.path), one.path, one.unit) for one in numbers)
    select = html("<select {} aria-label='Topic to plot from'>{}</select>", does("plot-topic"), options)
    return html("{}<div class='g-fields'>{}</div>", select, fields)


def _adds(name: SeriesName, text: str, unit: str) -> Html:
    return button(f"+ {text}{f' [{unit}]' if unit else ''}", "plot-add", name.key, name.path, style="g-link")
