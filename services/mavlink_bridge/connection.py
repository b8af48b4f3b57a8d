"""One autopilot as its protocols see it: whom to write to, what it is, and what it has said in words."""

from collections.abc import Callable
from dataclasses import dataclass

from uvf.mavlink import dialect as mav
from uvf.runtime.messages.validation import legible

Done = Callable[[bool, str], None]
"""Called once with (accepted, reason)."""
TEXT_KEPT = 20.0  # s
TEXT_WITHIN = 0.3  # s after a refusal: the words often come behind it
TEXTS_MOST = 100
"""So many are remembered for as long."""
TEXT_LETTERS = 1000
CHUNK_BYTES = 50
CHUNKS_WITHIN = 2.0  # s
CHUNKS_MOST = 20
PARTS_MOST = 8
"""Texts that are still coming, chunk by chunk."""
WORRYING = mav.MAV_SEVERITY_WARNING
"""A text of this severity or a graver one may explain a refusal."""


GAP = "…".encode()


def _joined(parts: dict[int, bytes]) -> bytes:
    """In their order; a mark stands where one is missing."""
    joined, due = b"", 0
    for number in sorted(parts):
        joined += (GAP if number > due else b"") + parts[number]
        due = number + 1
    return joined


@dataclass(frozen=True)
class StatusText:
    """A received text. t: when it was complete [s, wall]; severity: MAV_SEVERITY."""

    t: float
    severity: int
    text: str


class Wire:
    """The connection to one autopilot; ``t`` [s, wall] is set before each step's work."""

    def __init__(self, system: int, component: int) -> None:
        self.t = 0.0
        self.system, self.component = system, component
        self.outbox: list[mav.MAVLink_message] = []
        self.texts: list[StatusText] = []
        """The newest ones, oldest first."""
        self._parts: dict[int, tuple[float, int, dict[int, bytes]]] = {}
        """By id: when it began, its severity, its chunks by number."""

    def send(self, message: mav.MAVLink_message) -> None:
        """Queues a message."""
        self.outbox.append(message)

    def take_out(self) -> list[mav.MAVLink_message]:
        """Takes the queued messages."""
        out, self.outbox = self.outbox, []
        return out

    def hear_text(self, message: mav.MAVLink_statustext_message) -> list[StatusText]:
        """The complete text of a STATUSTEXT, once its last chunk is there, and texts that it ends."""
        raw = message.text.encode("utf-8", "replace") if isinstance(message.text, str) else bytes(message.text)
        part = raw.split(b"\0")[0]
        if message.id == 0:
            return [self._said(message.severity, part)]
        said = self.unfinished_texts()
        begun, severity, parts = self._parts.pop(message.id, (self.t, message.severity, {}))
        parts[message.chunk_seq] = part
        if len(part) == CHUNK_BYTES and len(parts) < CHUNKS_MOST:
            self._parts[message.id] = (begun, severity, parts)
            if len(self._parts) > PARTS_MOST:
                said.append(self._broken_off(next(iter(self._parts))))
            return said
        return [*said, self._said(severity, _joined(parts))]

    def unfinished_texts(self) -> list[StatusText]:
        """Texts whose end has not come in time, as far as they have: the gravest are often the longest, on the worst links."""
        return [self._broken_off(id) for id in [id for id, (begun, *_) in self._parts.items() if self.t - begun > CHUNKS_WITHIN]]

    def _broken_off(self, id: int) -> StatusText:
        _, severity, parts = self._parts.pop(id)
        return self._said(severity, _joined(parts) + GAP)

    def _said(self, severity: int, raw: bytes) -> StatusText:
        text = StatusText(self.t, severity, legible(raw.decode("utf-8", "replace"), TEXT_LETTERS))
        self.texts = [old for old in self.texts[-TEXTS_MOST + 1 :] if self.t - old.t < TEXT_KEPT] + [text]
        return text

    def worry_since(self, t: float) -> str:
        """The newest text of severity WARNING or graver from ``t`` [s, wall] on, or ""."""
        grave = [text.text for text in self.texts if text.t >= t - 1e-9 and text.severity <= WORRYING]
        return grave[-1] if grave else ""
