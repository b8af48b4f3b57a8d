"""Which ground stations are in touch: those whose HEARTBEAT of a while ago at most has been heard."""

from uvf.runtime.mavlink import dialect as mav

SILENT_AFTER = 3.0  # s, wall: three heartbeats


class Stations:
    """Programs that are no ground station (companions, cameras, other vehicles) do not count."""

    def __init__(self) -> None:
        self._heard: dict[tuple[int, int], float] = {}
        self._last: float | None = None

    def hear(self, t: float, message: mav.MAVLink_message) -> None:
        """Any message at ``t`` [s, wall]."""
        if isinstance(message, mav.MAVLink_heartbeat_message) and message.type == mav.MAV_TYPE_GCS:
            header = message.get_header()
            self._heard[header.srcSystem, header.srcComponent] = self._last = t

    def count(self, t: float) -> int:
        self._heard = {who: heard for who, heard in self._heard.items() if t - heard <= SILENT_AFTER}
        return len(self._heard)

    def silence(self, t: float) -> float:
        """s since the last heartbeat of any; 0 while there was none."""
        return t - self._last if self._last is not None else 0.0
