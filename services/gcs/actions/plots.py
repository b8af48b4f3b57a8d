"""What a browser can ask for of its plots."""

from dataclasses import dataclass
from typing import Annotated

import msgspec

from services.gcs.actions.page import Name, PageAction

Key = Annotated[str, msgspec.Meta(max_length=200)]


@dataclass(frozen=True)
class OfPlot(PageAction):
    """Base of these actions."""


@dataclass(frozen=True)
class PlotTopic(OfPlot):
    """List the numbers of a key."""

    key: Key


@dataclass(frozen=True)
class PlotFind(OfPlot):
    """List the numbers whose topic, name and unit hold the words of this text."""

    text: Name


@dataclass(frozen=True)
class PlotAdd(OfPlot):
    """Plot a number."""

    key: Key
    path: Key


@dataclass(frozen=True)
class PlotRemove(OfPlot):
    """Plot a number no more."""

    key: Key
    path: Key


@dataclass(frozen=True)
class PlotWindow(OfPlot):
    """Show so many seconds: one of ``plot_choice.WINDOWS``."""

    window: float


@dataclass(frozen=True)
class PlotHold(OfPlot):
    """Let the picture stand still, or go on."""

    on: bool


@dataclass(frozen=True)
class PlotPreset(OfPlot):
    """Plot what a preset names of the vehicle on show."""

    name: Name
