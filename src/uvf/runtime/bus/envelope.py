"""What travels beside a message's bytes: sequence number, stamp, boot id and epoch; and what these tell of losses."""

import struct
from collections import defaultdict
from typing import NamedTuple

from uvf.runtime.messages.topic_lookup import KEY_MOST

_FORMAT = struct.Struct("<QqQI")
WRAP = 2**32
"""Sequence numbers are compared modulo this: in a log they have 32 bits, and go on from 0 after the last."""
JUMP_MOST = 2**20
"""Numbers by which a sender may be ahead of what was heard of it last; one that is farther off must be followed by its next one."""
LATE_MOST = 1000  # numbers that history may lie behind
KEYS_MOST = 16_384  # keys whose gaps are counted: those that came first
BOOTS_MOST = 8  # senders told apart on a key: those that were heard last


class Envelope(NamedTuple):
    """Metadata of a message. seq: from 1 on each key; stamp_ns: simulation time [ns]; boot: of the sender.

    epoch: of the sender's clock, 0 = of none.
    """

    seq: int = 0
    stamp_ns: int = 0
    boot: int = 0
    epoch: int = 0

    def pack(self) -> bytes:
        """The envelope as the bytes of an attachment."""
        return _FORMAT.pack(*self)


def unpack(attachment: bytes) -> Envelope:
    """Envelope in an attachment; empty for a sender that attaches none, or nonsense."""
    return Envelope(*_FORMAT.unpack(attachment)) if len(attachment) == _FORMAT.size else Envelope()


class _Sender:
    """What was heard of one sender on one key; whatever numbers it sends, counting goes on (RFC 3550, appendix A.1)."""

    __slots__ = ("_expected", "_last")

    def __init__(self, seq: int) -> None:
        self._last = seq
        self._expected = -1
        """After a jump, the number that would confirm it."""

    def missed(self, seq: int) -> int:
        """How many messages were missed before this one; none of what comes twice or late."""
        step = (seq - self._last) % WRAP
        if 1 <= step <= JUMP_MOST:
            self._last = seq
            return step - 1
        if step == 0 or WRAP - step <= LATE_MOST:
            return 0
        if seq != self._expected:
            self._expected = seq + 1
            return 0
        self._last = seq
        return step - 2 if step < WRAP // 2 else 0


class GapCounter:
    """Counts the messages missed on each key; what comes twice or late (history) is no gap.

    Anybody can send on any key with any numbers: what is remembered is bounded, and a wrong number does not end the count.
    """

    def __init__(self) -> None:
        self.gaps: defaultdict[str, int] = defaultdict(int)
        self.rivals: set[str] = set()
        """Keys on which a sender came back after another one: two write at a time."""
        self._senders: dict[str, dict[int, _Sender]] = {}  # key -> boot -> sender, the one heard last at the end

    def count(self, key: str, boot: int, seq: int) -> None:
        """Takes note of a message; adds the messages missed before it to the key's gaps."""
        senders = self._senders.get(key)
        if senders is None:
            if len(self._senders) < KEYS_MOST and len(key) <= KEY_MOST:
                self._senders[key] = {boot: _Sender(seq)}
            return
        sender = senders.get(boot)
        if next(reversed(senders)) != boot:
            if sender is not None:
                self.rivals.add(key)
                del senders[boot]
            elif len(senders) >= BOOTS_MOST:
                del senders[next(iter(senders))]
            senders[boot] = sender or _Sender(seq)
        if sender is not None and (missed := sender.missed(seq)):
            self.gaps[key] += missed
