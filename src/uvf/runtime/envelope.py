"""What travels beside a message's bytes: sequence number, stamp, boot id and epoch; and what these tell of losses."""

import struct
from collections import defaultdict
from typing import NamedTuple

_FORMAT = struct.Struct("<QqQI")


class Envelope(NamedTuple):
    """seq: from 1 on each key; stamp_ns: simulation time; boot: of the sender; epoch: of its clock, 0 = of none."""

    seq: int = 0
    stamp_ns: int = 0
    boot: int = 0
    epoch: int = 0

    def pack(self) -> bytes:
        return _FORMAT.pack(*self)


def unpack(attachment: bytes) -> Envelope:
    """Empty for a message of somebody who sends none, or nonsense."""
    return Envelope(*_FORMAT.unpack(attachment)) if len(attachment) == _FORMAT.size else Envelope()


class GapCounter:
    """Counts the messages missed on each key; what comes twice or late (history) is no gap."""

    def __init__(self) -> None:
        self.gaps: defaultdict[str, int] = defaultdict(int)
        self.rivals: set[str] = set()
        """Keys on which a sender came back after another one: two write at a time."""
        self._boots: defaultdict[str, set[int]] = defaultdict(set)
        self._last: dict[str, tuple[int, int]] = {}  # key -> boot, seq

    def count(self, key: str, boot: int, seq: int) -> None:
        last_boot, last = self._last.get(key, (boot, 0 if seq == 1 else seq - 1))
        if boot != last_boot:
            if boot in self._boots[key]:
                self.rivals.add(key)
            self._boots[key] |= {last_boot, boot}
            self._last[key] = (boot, seq)
        elif seq > last:
            if seq > last + 1:
                self.gaps[key] += seq - last - 1
            self._last[key] = (boot, seq)
