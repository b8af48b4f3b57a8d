"""What is really heard: of each key the rate, the age, the bytes, who sends it, and the newest message."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from schemas.topics import PREFIX
from services.gcs.state.refusals import PageRefusals
from services.gcs.watch import WatchedMessage
from uvf.runtime.messages.topic_lookup import is_of_table, topic_of
from uvf.runtime.messages.validation import is_text, legible

OVER = 5.0  # s, wall: what rates are taken over
BIN = 0.5  # s, wall: width of a bin in which messages are counted
MOST_KEYS, KEY_LENGTH = 1000, 200
FORGOTTEN_AFTER = 30.0  # s, wall: from then on a key makes room for another one
SENDERS_MOST = 8  # senders told apart on a key
SHOWN_MOST = 32_768  # bytes of a message that is kept to be shown


@dataclass
class KeyTraffic:
    """The messages of one key. Times in s, wall; the newest sender was first heard at ``since``."""

    key: str
    since: float
    type_name: str = ""
    at: float = 0.0
    """When the newest came."""
    size: int = 0
    """Bytes of the newest."""
    payload: bytes | None = None
    """The newest, unless it is too large to be shown."""
    wrong: tuple[str, float, int] | None = None
    """(type, when, by which process) of the newest message that the table does not have for this key."""
    wrong_count: int = 0
    rivals_at: float = float("-inf")
    """When a sender last came back after another one."""
    senders: dict[int, float] = field(default_factory=dict)
    """Process -> when it last sent, the one heard last at the end."""
    _bins: deque[tuple[int, int, int]] = field(default_factory=deque)
    """(number of the bin, messages, bytes)."""

    def hear(self, message: WatchedMessage, t: float) -> None:
        """Takes a message that came at ``t`` [s, wall]."""
        self.at, self.size = t, len(message.payload)
        self.type_name = legible(message.type_name, 80)
        self.payload = message.payload if self.size <= SHOWN_MOST else None
        if topic_of(self.key) is not None and not is_of_table(self.key, message.type_name):
            self.wrong, self.wrong_count = (self.type_name, t, message.boot), self.wrong_count + 1
        self._hear_sender(message.boot, t)
        number = int(t // BIN)
        _, count, size = self._bins.pop() if self._bins and self._bins[-1][0] == number else (number, 0, 0)
        self._bins.append((number, count + 1, size + self.size))
        while self._bins[0][0] < number - OVER / BIN:
            self._bins.popleft()

    def _hear_sender(self, boot: int, t: float) -> None:
        if boot in self.senders and next(reversed(self.senders)) != boot:
            self.rivals_at = t
        if boot not in self.senders:  # one that was started again: its rate is its own
            self.since = t
            self._bins.clear()
        self.senders.pop(boot, None)
        self.senders[boot] = t
        if len(self.senders) > SENDERS_MOST:
            del self.senders[next(iter(self.senders))]

    def per_second(self, t: float) -> tuple[float, float]:
        """(messages, bytes) per second [1/s] over the last seconds before ``t`` [s, wall]."""
        begin = (int(t // BIN) - OVER / BIN) * BIN
        span = max(t - max(begin, self.since), BIN)
        counted = [(count, size) for number, count, size in self._bins if number * BIN >= begin]
        return sum(c for c, _ in counted) / span, sum(s for _, s in counted) / span

    def boots(self, t: float) -> list[int]:
        """The processes that have sent within the last seconds before ``t`` [s, wall]; the newest one in any case."""
        return [boot for boot, at in self.senders.items() if at >= self.at - BIN or t - at <= OVER]


class BusTraffic:
    """All keys, as they are on the bus; at the limit the longest silent one makes room for a new one, once it has been silent for long."""

    def __init__(self, refused: PageRefusals) -> None:
        self.keys: dict[str, KeyTraffic] = {}
        self._refused = refused

    def hear(self, t: float, messages: Sequence[WatchedMessage]) -> None:
        """Takes messages at ``t`` [s, wall]."""
        for message in messages:
            key = message.key
            heard = self.keys.get(key) or self._met(key, t - message.age, t)
            if heard is not None:
                heard.hear(message, t - message.age)

    def _met(self, key: str, came: float, t: float) -> KeyTraffic | None:
        if len(key) > KEY_LENGTH or not is_text(key):
            self._refused.add("keys", key, f"a key on the bus is not shown: {legible(key, 60)!a} is too long or no text")
            return None
        if len(self.keys) >= MOST_KEYS:
            silent = min(self.keys.values(), key=lambda one: one.at)
            if t - silent.at <= FORGOTTEN_AFTER:
                self._refused.add("keys", key, f"more than {MOST_KEYS} keys are on the bus: not all are shown")
                return None
            del self.keys[silent.key]
        made = self.keys[key] = KeyTraffic(key, came)
        return made

    def clear(self) -> None:
        """Forgets everything: nobody has listened meanwhile."""
        self.keys.clear()


def short(key: str) -> str:
    """A key without ``uvf/``, as people write it."""
    return key.removeprefix(f"{PREFIX}/")
