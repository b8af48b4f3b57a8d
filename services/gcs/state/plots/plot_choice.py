"""What one browser plots, and the presets that it can begin with."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from schemas import topics
from schemas.topics import Topic
from services.gcs.state.plots.plot_series import SeriesName

MOST_SERIES = 8
WINDOWS = (10.0, 60.0, 600.0)  # s

Preset = tuple[tuple[Topic[Any], str], ...]
_ANY: Mapping[str, Preset] = {"Battery": ((topics.STATUS, "battery_voltage"), (topics.STATUS, "battery_remaining"))}
AIRCRAFT: Mapping[str, Preset] = {
    "Airspeed and altitude": ((topics.NAV_STATE, "airspeed"), (topics.NAV_STATE, "position.z")),
    "Attitude": ((topics.NAV_STATE, "orientation.roll"), (topics.NAV_STATE, "orientation.pitch")),
    "Track error": ((topics.STATUS, "cross_track"), (topics.STATUS, "altitude_error")),
    "Estimate against truth": ((topics.NAV_STATE, "position.z"), (topics.TRUTH, "position.z")),
    "Throttle and surfaces": (
        (topics.SURFACE_COMMAND, "throttle"),
        (topics.SURFACE_COMMAND, "elevator"),
        (topics.SURFACE_COMMAND, "aileron"),
    ),
    **_ANY,
}
ROVER: Mapping[str, Preset] = {
    "Speed and turn rate": ((topics.ODOMETRY, "linear_velocity.x"), (topics.ODOMETRY, "angular_velocity.z")),
    "Odometry against truth": ((topics.ODOMETRY, "linear_velocity.norm"), (topics.TRUTH, "velocity.norm")),
    "Commanded against driven": ((topics.WHEEL_COMMAND, "left"), (topics.WHEEL_COMMAND, "right")),
    "Progress": ((topics.NAV_STATUS, "distance_left"), (topics.NAV_STATUS, "explored")),
    **_ANY,
}


def presets_of(flies: bool) -> Mapping[str, Preset]:
    """The presets for an aircraft or a ground vehicle, by their names."""
    return AIRCRAFT if flies else ROVER


@dataclass(frozen=True)
class PlotChoice:
    """Plotted numbers, in the order of their colours, and how they are shown."""

    series: tuple[SeriesName, ...] = ()
    window: float = WINDOWS[1]  # s
    held_at: float | None = None
    """The simulation time [s] at which the picture stands still; None while it goes on."""
    topic: str = ""
    """The key whose fields are listed."""
    text: str = ""
    """What is searched for among all of them."""

    def adding(self, name: SeriesName) -> "PlotChoice":
        """With one more number, if there is room."""
        known = name in self.series or len(self.series) >= MOST_SERIES
        return self if known else replace(self, series=(*self.series, name))

    def without(self, name: SeriesName) -> "PlotChoice":
        """Without a number."""
        return replace(self, series=tuple(one for one in self.series if one != name))
