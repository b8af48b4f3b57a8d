"""How long no ground station has been heard: wall time, however fast or slowly the simulation runs."""

from schemas.messages import Link
from uvf.runtime.messages.convert import seconds


class LinkWatch:
    """Counts on while nothing is told, as when the process that listens to ground stations has died."""

    def __init__(self) -> None:
        self.silence = 0.0
        """s, wall; 0 until a ground station has been heard once."""
        self._told: Link | None = None

    def step(self, t: float, link: Link | None) -> None:
        """t [s, simulation]; link: the newest word, or None.

        A ground station that was gone before this vehicle began is none that it has lost; a listener that has just begun knows of none.
        """
        if link is not None and (link.stations or (link.silence > 0 and self._told is not None)):
            self._told = link
        if self._told is not None:
            since = max(t - seconds(self._told.timestamp), 0.0)
            self.silence = self._told.silence + since / (self._told.rate or 1.0)
