"""STATUSTEXT: long texts in chunks, the same text not too often, severities of events."""

from collections.abc import Hashable

from schemas.messages import Event
from uvf.runtime.mavlink import dialect as mav

CHUNK_BYTES = 50
REPEAT_AFTER = 10.0  # s

SEVERITY = {
    Event.INFO: mav.MAV_SEVERITY_INFO,
    Event.NOTICE: mav.MAV_SEVERITY_INFO,  # a ground station would speak a NOTICE aloud, and there are many
    Event.WARNING: mav.MAV_SEVERITY_WARNING,
    Event.ERROR: mav.MAV_SEVERITY_ERROR,
    Event.CRITICAL: mav.MAV_SEVERITY_CRITICAL,
}


def chunks(severity: int, text: str, chunk_id: int) -> list[mav.MAVLink_statustext_message]:
    """The messages of one text; only a text of more than 50 bytes needs ``chunk_id`` (not 0)."""
    raw = text.encode("ascii", "replace")
    parts = [raw[i : i + CHUNK_BYTES] for i in range(0, len(raw), CHUNK_BYTES)] or [b""]
    if len(parts) == 1:
        return [mav.MAVLink_statustext_message(severity, raw)]
    if len(parts[-1]) == CHUNK_BYTES:
        parts.append(b"")  # the receiver ends a text at the first NUL: a full last chunk needs an empty one after it
    return [mav.MAVLink_statustext_message(severity, part, chunk_id, seq) for seq, part in enumerate(parts)]


def event_text(event: Event) -> str:
    return f"{event.text}: {event.cause}" if event.cause else event.text


class TextLimiter:
    """Says which texts may go out now, and numbers the chunked ones."""

    def __init__(self) -> None:
        self._said: dict[Hashable, float] = {}
        self._id = 0

    def admits(self, t: float, what: Hashable) -> bool:
        self._said = {key: at for key, at in self._said.items() if t - at < REPEAT_AFTER}
        if what in self._said:
            return False
        self._said[what] = t
        return True

    def next_id(self) -> int:
        self._id = self._id % 0xFFFF + 1
        return self._id
