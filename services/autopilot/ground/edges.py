"""Edges that range finders which look down tell of: nothing drives over them."""

from collections.abc import Mapping, Sequence

from schemas.messages import Range
from uvf.sensors.cliffs import FloorSight, FloorWatch

SILENT = 1.0  # s, after which a range finder that has spoken is taken to see no floor


class EdgeWatch:
    """One vehicle's, by its range finders' sights of the floor."""

    def __init__(self, sights: Mapping[str, FloorSight]) -> None:
        self._floor = FloorWatch(sights)
        self._heard: dict[str, float] = {}
        self._ahead = self._behind = False

    def step(self, t: float, readings: Sequence[Range]) -> None:
        """Takes what has been measured until ``t`` [s]."""
        for reading in readings:
            frame = reading.frame_id.rpartition("/")[2]
            if self._floor.take(frame, reading.range):
                self._heard[frame] = t
        ended = [self._floor.sights[f] for f, at in self._heard.items() if self._floor.has_ended(f) or t - at > SILENT]
        self._ahead = any(sight.place[0] > 0.0 for sight in ended)
        self._behind = any(sight.place[0] <= 0.0 for sight in ended)

    def stops(self, linear: float) -> bool:
        """Whether a velocity forward [m/s] leads over an edge."""
        return (linear > 0.0 and self._ahead) or (linear < 0.0 and self._behind)

    @property
    def is_near(self) -> bool:
        """Whether there is an edge under any of them."""
        return self._ahead or self._behind
