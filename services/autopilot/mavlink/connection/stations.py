"""Which ground stations are in touch: those whose HEARTBEAT of a while ago at most has been heard."""

from services.autopilot.mavlink.connection.line import Sender
from uvf.mavlink import dialect as mav
from uvf.mavlink.bounded import make_room

SILENT_AFTER = 3.0  # s, wall: three heartbeats
MOST = 64


class Stations:
    """The ground stations in touch; other programs (companions, cameras, other vehicles) do not count.

    Stations at different addresses are different ones, even with the same system id: every QGroundControl is 255 by default.
    """

    def __init__(self) -> None:
        self._heard: dict[Sender, float] = {}
        self._last: float | None = None

    def hear(self, t: float, message: mav.MAVLink_message, sender: Sender) -> None:
        """Notes a message at ``t`` [s, wall]."""
        if isinstance(message, mav.MAVLink_heartbeat_message) and message.type == mav.MAV_TYPE_GCS:
            make_room(self._heard, sender, MOST, lambda who: self._heard[who])
            self._heard[sender] = self._last = t

    def count(self, t: float) -> int:
        """Number of stations in touch at ``t`` [s, wall]."""
        self._heard = {who: heard for who, heard in self._heard.items() if t - heard <= SILENT_AFTER}
        return len(self._heard)

    def silence(self, t: float) -> float:
        """Time [s] at ``t`` [s, wall] since the last heartbeat of any station; 0 while there was none."""
        return t - self._last if self._last is not None else 0.0
