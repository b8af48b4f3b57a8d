"""Edges that range finders which look down tell of: nothing drives over them."""

from collections.abc import Mapping, Sequence

from schemas.messages import Range
from uvf.maths.kinematics import Twist
from uvf.sensors.cliffs import FloorSight, FloorWatch

SILENT = 1.0  # s, after which a range finder that has spoken is taken to see no floor


class EdgeWatch:
    """One vehicle's, by its range finders' sights of the floor."""

    def __init__(self, sights: Mapping[str, FloorSight]) -> None:
        self._floor = FloorWatch(sights)
        self._heard: dict[str, float] = {}
        self._edges: list[tuple[float, float]] = []
        """Where the floor ends, forward and left of base_link [m]."""

    def step(self, t: float, readings: Sequence[Range]) -> None:
        """Takes what has been measured until ``t`` [s]."""
        for reading in readings:
            frame = reading.frame_id.rpartition("/")[2]
            if self._floor.take(frame, reading.range):
                self._heard[frame] = t
        ended = [self._floor.sights[f] for f, at in self._heard.items() if self._floor.has_ended(f) or t - at > SILENT]
        self._edges = [(sight.place[0], sight.place[1]) for sight in ended]

    def stops(self, velocity: Twist) -> bool:
        """Whether a velocity leads over an edge: forward over one ahead, to the left over one on the left, and so on."""
        ahead, aside = velocity.linear, velocity.lateral
        return any((ahead != 0.0 and (x > 0.0) == (ahead > 0.0)) or y * aside > 0.0 for x, y in self._edges)

    @property
    def is_near(self) -> bool:
        """Whether there is an edge under any of them."""
        return bool(self._edges)
