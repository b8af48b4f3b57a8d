"""What a vehicle's instrument shows, over the last ten minutes: a few numbers five times a second, for the small charts beside it."""

from typing import NamedTuple

from schemas.messages import NavState, Odometry
from services.gcs.state.plots.plot_series import PlotSeries

PERIOD = 0.2  # s, wall


class Trend(NamedTuple):
    """One number over time, in its ``unit``."""

    name: str
    unit: str
    series: PlotSeries


class Trends:
    """Of an aircraft its airspeed and altitude, of a ground vehicle its speed and turn rate."""

    def __init__(self, flies: bool) -> None:
        names = (("airspeed", "m/s"), ("altitude", "m")) if flies else (("speed", "m/s"), ("turn rate", "rad/s"))
        self.all = tuple(Trend(name, unit, PlotSeries()) for name, unit in names)
        self._newest = -PERIOD

    @property
    def is_heard(self) -> bool:
        """Whether there are numbers."""
        return self._newest >= 0.0

    def hear(self, t: float, message: NavState | Odometry) -> None:
        """Takes an aircraft's state or a ground vehicle's odometry at ``t`` [s, wall]."""
        if t - self._newest < PERIOD - 1e-6:
            return
        self._newest = t
        values = (
            (message.airspeed, message.position.z)
            if isinstance(message, NavState)
            else (message.linear_velocity.x, message.angular_velocity.z)
        )
        for trend, value in zip(self.all, values, strict=True):
            trend.series.add(t, value)
