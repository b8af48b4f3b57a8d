"""How long no ground station has been heard: wall time, however fast or slowly the simulation runs."""

from schemas.messages import Link
from uvf.runtime.messages.convert import seconds


class LinkWatch:
    """Measures the silence of the ground stations; it counts on while nothing is heard, as when the listening process has died."""

    def __init__(self) -> None:
        self.silence = 0.0
        """s, wall; 0 until a ground station has been heard once."""
        self._told: Link | None = None

    def step(self, t: float, link: Link | None) -> None:
        """One cycle at ``t`` [s, simulation]; link: the newest message, or None.

        A ground station that was gone before this vehicle began is not a lost one; a listener that has just begun knows of none.
        """
        if link is not None and (link.stations or (link.silence > 0 and self._told is not None)):
            self._told = link
        if self._told is not None:
            since = max(t - seconds(self._told.timestamp), 0.0)
            self.silence = self._told.silence + since / (self._told.rate or 1.0)
