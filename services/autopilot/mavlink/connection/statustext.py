"""STATUSTEXT: long texts in chunks, the same text not too often, severities of events."""

import re
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from schemas.messages import Event
from uvf.mavlink import dialect as mav
from uvf.mavlink.bounded import make_room
from uvf.mavlink.endpoint import Peer
from uvf.mavlink.text_bucket import TEXTS_AT_ONCE, TextBucket

CHUNK_BYTES = 50
REPEAT_AFTER = 10.0  # s
ITEMS = re.compile(r"\bitems? \d+( and \d+)?")
MOST_REMEMBERED = 256  # texts
MOST_RECEIVERS = 128

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
    """The text of an event with its cause."""
    return f"{event.text}: {event.cause}" if event.cause else event.text


def counted_from_one(text: str) -> str:
    """The text with item numbers counted from 1, as on a station's map; mission files and messages count from 0."""
    return ITEMS.sub(lambda named: re.sub(r"\d+", lambda number: str(int(number[0]) + 1), named[0]), text)


class TextLimiter:
    """Limits repetitions of texts, and numbers the split ones."""

    def __init__(self) -> None:
        self._said: dict[Hashable, float] = {}
        self._id = 0

    def admits(self, t: float, what: Hashable) -> bool:
        """Whether a text may go out at ``t`` [s, wall], being no repetition within ``REPEAT_AFTER``."""
        self._said = {key: at for key, at in self._said.items() if t - at < REPEAT_AFTER}
        if what in self._said:
            return False
        make_room(self._said, what, MOST_REMEMBERED, lambda other: self._said[other])
        self._said[what] = t
        return True

    def next_id(self) -> int:
        """The next id of a split text, 1 to 65535."""
        self._id = self._id % 0xFFFF + 1
        return self._id


@dataclass
class Share(TextBucket):
    """The budget of one receiver: texts left, number left out, and since when [s, wall]."""

    left_out: int = 0
    since: float = 0.0


class TextBudget:
    """Limits the texts to each receiver to what a person can read; critical texts are never left out."""

    def __init__(self) -> None:
        self._shares: dict[Peer, Share] = {}

    def __len__(self) -> int:
        return len(self._shares)

    def admitted(self, t: float, severity: int, receivers: Sequence[Peer]) -> list[Peer]:
        """The receivers that get a text of this severity at ``t`` [s, wall]."""
        return [peer for peer in receivers if severity <= mav.MAV_SEVERITY_CRITICAL or self._admits(t, peer)]

    def _admits(self, t: float, peer: Peer) -> bool:
        make_room(self._shares, peer, MOST_RECEIVERS, lambda other: self._shares[other].t)
        share = self._shares.setdefault(peer, Share(t))
        if share.take(t):
            return True
        share.since = share.since if share.left_out else t
        share.left_out += 1
        return False

    def left_out(self, t: float) -> list[tuple[Peer, int]]:
        """(receiver, number of texts left out) to be reported at ``t`` [s, wall]: after the flood, or every 10 s during it."""
        told = []
        for peer, share in list(self._shares.items()):
            share.refill(t)
            if share.is_full:
                del self._shares[peer]
            if share.left_out and (share.left >= TEXTS_AT_ONCE / 2 or t - share.since >= REPEAT_AFTER):
                told.append((peer, share.left_out))
                share.left_out = 0
        return told
