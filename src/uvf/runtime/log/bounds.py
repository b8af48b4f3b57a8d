"""What a log takes of all that anybody may put on the bus, and how much of it waits for the next file of a run."""

from collections import Counter
from collections.abc import Iterable

from schemas.topics import CLOCK, PREFIX, SYSTEM
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.topic_lookup import KEY_MOST, is_of_table, topic_of

TYPE_MOST = 256  # characters of a type's name
PAYLOAD_MOST = 32_000_000  # bytes; a picture of the largest cameras, uncompressed
STAMP_END = 2**63  # ns; stamps travel as 64 bits with a sign
CHANNELS_MOST = 4096
"""Pairs of key and type that are as the table has them: a vehicle has about 60. MCAP knows no more than 65535."""
FOREIGN_MOST = 256  # pairs of any other key and type
STANDING_MOST = 256_000_000  # bytes of messages that the next file begins with

REFUSED = {
    "stamp": f"stamped before 0 or after {STAMP_END / 1e9:.0f} s",
    "size": f"larger than {PAYLOAD_MOST / 1e6:.0f} MB",
    "key": f"on keys that are not below {PREFIX}/, longer than {KEY_MOST} characters or not printable",
    "type": f"with names of types longer than {TYPE_MOST} characters or not printable",
    "channel": f"on new keys or of new types, beyond {CHANNELS_MOST} of the table and {FOREIGN_MOST} others",
    "head": f"beyond the {STANDING_MOST / 1e6:.0f} MB that the next file can begin with",
}
"""Why a message is not recorded, by the word that the log's metadata has for it. Those of ``head`` are missing in the next file only."""


class Admission:
    """Decides which messages are recorded, and counts the others; one for all files of a run.

    Who was there first stays: a flood of new keys cannot push out the topics of a running system.
    """

    def __init__(self) -> None:
        self.refused: Counter[str] = Counter()
        """Messages, by the words of REFUSED."""
        self._of_table: set[tuple[str, str]] = set()
        self._foreign: set[tuple[str, str]] = set()

    def admits(self, sample: Sample) -> bool:
        """Whether a message is recorded; counts it by the reason if it is not."""
        why = self._fault(sample)
        if why:
            self.refused[why] += 1
        return not why

    def _fault(self, sample: Sample) -> str:
        if not 0 <= sample.stamp_ns < STAMP_END:
            return "stamp"
        if len(sample.payload) > PAYLOAD_MOST:
            return "size"
        pair = (sample.key, sample.type_name)
        return "" if pair in self._of_table or pair in self._foreign else self._fault_of_new(*pair)

    def _fault_of_new(self, key: str, type_name: str) -> str:
        """Of a key and type that come for the first time; they are known from then on, if nothing is wrong."""
        if len(key) > KEY_MOST or not key.isprintable() or not key.startswith(f"{PREFIX}/"):
            return "key"
        if len(type_name) > TYPE_MOST or not type_name.isprintable():
            return "type"
        known, most = (self._of_table, CHANNELS_MOST) if is_of_table(key, type_name) else (self._foreign, FOREIGN_MOST)
        if len(known) >= most:
            return "channel"
        known.add((key, type_name))
        return ""


class Standing:
    """The newest message of each topic that stands until the next one: latched and kept topics."""

    def __init__(self) -> None:
        self._newest: dict[str, Sample] = {}
        self._size = 0  # bytes of payloads
        self._epoch: int | None = None
        """Of the clock that was heard last; None without one."""

    def remember(self, sample: Sample) -> bool:
        """Keeps a message; False when there was no room. History that comes late does not take the place of what is newer."""
        if sample.key == CLOCK.at(SYSTEM):
            self._epoch = sample.epoch
        old = self._newest.get(sample.key)
        if old is not None and old.boot == sample.boot and old.seq > sample.seq:
            return True
        if old is not None:
            self._size -= len(self._newest.pop(sample.key).payload)
        if self._size + len(sample.payload) > STANDING_MOST:
            return False
        self._newest[sample.key] = sample
        self._size += len(sample.payload)
        return True

    def in_force(self) -> Iterable[Sample]:
        """Messages in force: without those of an epoch that is over, except what holds across epochs (an operator's word)."""
        samples = sorted(self._newest.values(), key=lambda s: (s.stamp_ns, s.key))
        epoch = max((s.epoch for s in samples), default=0) if self._epoch is None else self._epoch
        return [s for s in samples if s.epoch == 0 or s.epoch >= epoch or ((topic := topic_of(s.key)) is not None and topic.across_epochs)]
