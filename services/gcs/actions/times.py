"""What a page asks of its time bar: another moment, the present again, a minute to keep."""

from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec

from services.gcs.actions.page import PageAction


@dataclass(frozen=True)
class OfTime(PageAction):
    """Base of the actions of the time bar."""


@dataclass(frozen=True)
class ShowPast(OfTime):
    """Show how things stood so long ago [s]."""

    ago: Annotated[float, msgspec.Meta(ge=-1e6, le=0.0)]


@dataclass(frozen=True)
class ShowMoment(OfTime):
    """Show how things stood at this time [s, wall]."""

    t: float


@dataclass(frozen=True)
class ShowLive(OfTime):
    """Show the present again."""


@dataclass(frozen=True)
class PlayPast(OfTime):
    """Let the past run on from the moment on show, or hold it."""

    on: bool


@dataclass(frozen=True)
class PlayRate(OfTime):
    """Let the past run so many times as fast, as the time bar writes it."""

    rate: Annotated[str, msgspec.Meta(max_length=8)]


@dataclass(frozen=True)
class StepEvent(OfTime):
    """Show the moment of the next event, or of the one before."""

    step: Literal[-1, 1]


@dataclass(frozen=True)
class ExportMinute(OfTime):
    """Make a file of the minute around the moment on show."""

    kind: Literal["mcap", "html"]
