"""Series of plotted numbers: the last ten minutes of each, filled from what travels on the bus while somebody plots it."""

from collections.abc import Iterable, Set
from typing import NamedTuple

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from services.gcs.state.plots.plot_fields import PlotField, plot_fields, repeated_fields, value_at
from services.gcs.watch import WatchedMessage
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.messages.topic_lookup import topic_of

Floats = NDArray[np.float64]

LONGEST = 600.0  # s, simulation
MOST_POINTS = 60_000  # of a series: ten minutes at 100 Hz
GAP = 1.0  # s, between two values that the line does not join


class SeriesName(NamedTuple):
    """A number on the bus: full key, and path in its messages."""

    key: str
    path: str

    def __str__(self) -> str:
        """``milvus/nav/state airspeed``."""
        return f"{self.key.partition('/')[2]} {self.path}"


class PlotSeries:
    """Times (s, simulation) and values, the newest ``MOST_POINTS`` of the last ``LONGEST`` seconds; NaN where the line breaks."""

    def __init__(self) -> None:
        self._t = np.zeros(1024)
        self._values = np.zeros(1024)
        self._n = 0

    def add(self, t: float, value: float) -> None:
        """Appends a value; time that goes back begins the series anew."""
        if self._n and t < self._t[self._n - 1]:
            self._n = 0
        if self._n and t - self._t[self._n - 1] > GAP:
            self._put(t, np.nan)
        self._put(t, value)

    def _put(self, t: float, value: float) -> None:
        if self._n == len(self._t):
            self._make_room(t)
        self._t[self._n], self._values[self._n] = t, value
        self._n += 1

    def _make_room(self, t: float) -> None:
        """Drops what is too old; where that is little, the arrays grow."""
        old = max(int(np.searchsorted(self._t[: self._n], t - LONGEST)), self._n - MOST_POINTS + 1024)
        if old > self._n // 4:
            left = self._n - old
            self._t[:left], self._values[:left] = self._t[old : self._n], self._values[old : self._n]
            self._n = left
        else:
            self._t, self._values = (np.concatenate((a, np.zeros(len(a)))) for a in (self._t, self._values))

    def since(self, t: float) -> tuple[Floats, Floats]:
        """Times and values (n,) from ``t`` [s] on."""
        first = int(np.searchsorted(self._t[: self._n], t))
        return self._t[first : self._n], self._values[first : self._n]

    @property
    def newest(self) -> float | None:
        """The newest value."""
        return float(self._values[self._n - 1]) if self._n else None


class PlotBook:
    """All series that any page plots."""

    def __init__(self) -> None:
        self.series: dict[SeriesName, PlotSeries] = {}
        self.samples: dict[str, Message] = {}
        """Newest message of the keys that pages look at, to list the numbers of its repeated fields."""
        self.refused = 0
        """Messages that could not be read."""

    def keep(self, wanted: Set[SeriesName], looked_at: Set[str]) -> None:
        """Plots these numbers from now on, and forgets the others. looked_at: keys whose fields are being chosen from."""
        for name in [name for name in self.series if name not in wanted]:
            del self.series[name]
        for name in wanted:
            self.series.setdefault(name, PlotSeries())
        self._looked_at = looked_at
        self.samples = {key: message for key, message in self.samples.items() if key in looked_at}

    def hear(self, messages: Iterable[WatchedMessage]) -> None:
        """Takes what has come."""
        by_key: dict[str, list[SeriesName]] = {}
        for name in self.series:
            by_key.setdefault(name.key, []).append(name)
        for sample in messages:
            names = by_key.get(sample.key, ())
            if not names and sample.key not in self._looked_at:
                continue
            topic = topic_of(sample.key)
            if topic is None:
                continue
            try:
                message = decode(sample.key, sample.payload, topic.message)
            except Malformed:
                self.refused += 1
                continue
            if sample.key in self._looked_at:
                self.samples[sample.key] = message
            for name in names:
                value = value_at(message, name.path)
                if value is not None:
                    self.series[name].add(sample.stamp, value)

    _looked_at: Set[str] = frozenset()

    def fields_of(self, key: str) -> tuple[PlotField, ...]:
        """The numbers that can be plotted of a key."""
        topic = topic_of(key)
        if topic is None:
            return ()
        sample = self.samples.get(key)
        return plot_fields(topic.message.DESCRIPTOR) + (repeated_fields(sample) if sample is not None else ())


def unit_of(name: SeriesName) -> str:
    """The unit of a number; "" where none is known."""
    topic = topic_of(name.key)
    fields = plot_fields(topic.message.DESCRIPTOR) if topic is not None else ()
    plain = {one.path: one.unit for one in fields}
    if name.path in plain:
        return plain[name.path]
    return "rad" if name.path.endswith("].position") else ""
