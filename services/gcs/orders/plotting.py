"""Carries out what a page asks of its plots."""

from dataclasses import replace

from services.gcs.actions.plots import OfPlot, PlotAdd, PlotFind, PlotHold, PlotPreset, PlotRemove, PlotTopic, PlotWindow
from services.gcs.state.plots.plot_choice import WINDOWS, PlotChoice, presets_of
from services.gcs.state.plots.plot_series import SeriesName
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from uvf.runtime.messages.topic_lookup import topic_of


def plot(model: Model, session: BrowserSession, action: OfPlot) -> None:
    """Changes what a page plots; what is no number on the bus changes nothing."""
    choice = session.plot
    match action:
        case PlotTopic(_, key) if key == "" or topic_of(key) is not None:
            session.plot = replace(choice, topic=key)
        case PlotFind(_, text):
            session.plot = replace(choice, text=text)
        case PlotAdd(_, key, path) if path in {one.path for one in model.plots.fields_of(key)}:
            session.plot = choice.adding(SeriesName(key, path))
        case PlotRemove(_, key, path):
            session.plot = choice.without(SeriesName(key, path))
        case PlotWindow(_, window) if window in WINDOWS:
            session.plot = replace(choice, window=window)
        case PlotHold(_, on):
            session.plot = replace(choice, held_at=model.sim_time if on else None)
        case PlotPreset(_, name):
            session.plot = _preset(model, session, name) or choice


def _preset(model: Model, session: BrowserSession, name: str) -> PlotChoice | None:
    """The numbers of a preset for the vehicle on show, in place of those before."""
    vehicle = model.vehicles.get(session.vehicle)
    wanted = presets_of(vehicle.flies).get(name) if vehicle is not None else None
    if vehicle is None or wanted is None:
        return None
    series = tuple(SeriesName(topic.at(vehicle.name), path) for topic, path in wanted)
    return replace(session.plot, series=series, held_at=None)
