"""What has arrived for one service: ordered, decoded once, aged in message time."""

from collections import deque
from typing import Any

from google.protobuf.message import Message

from uvf.runtime.bus import Sample
from uvf.runtime.clock import NS
from uvf.runtime.service import Input
from uvf.runtime.wire import Malformed, decode_sample

EVERY_DEPTH = 256


class Slot:
    """One topic of one owner (or of several sources) as one input sees it."""

    def __init__(self, declared: Input, ageless: bool, malformed: list[str]) -> None:
        """malformed: takes a line about each refused message."""
        self._input = declared
        self._max_age = declared.topic.max_age * NS if declared.ages and not ageless else float("inf")
        self._ageless = ageless
        self._fresh: deque[tuple[int, Message]] = deque(maxlen=EVERY_DEPTH)
        self._latest: tuple[int, Message] | None = None
        self.arrived: deque[Sample] = deque(maxlen=EVERY_DEPTH)
        self.accepted: Sample | None = None
        self._malformed = malformed

    def push(self, sample: Sample) -> None:
        self.arrived.append(sample)

    def take(self, t_ns: int) -> None:
        """Makes readable what is stamped before ``t_ns``, ordered by (epoch, stamp, key, seq)."""
        if not self.arrived:
            return
        if len(self.arrived) == 1 and (self._ageless or self.arrived[0].stamp_ns < t_ns):
            self._accept(self.arrived.popleft())
            return
        ready = [s for s in self.arrived if self._ageless or s.stamp_ns < t_ns]
        if not ready:
            return
        self.arrived = deque((s for s in self.arrived if not (self._ageless or s.stamp_ns < t_ns)), maxlen=EVERY_DEPTH)
        ready.sort(key=lambda s: (s.epoch, s.stamp_ns, s.key, s.seq))
        if self._input.every:
            for sample in ready:
                self._accept(sample)
        else:
            # A broken message hides none of the good ones before it.
            any(self._accept(sample) for sample in reversed(ready))

    def _accept(self, sample: Sample) -> bool:
        try:
            message = decode_sample(sample, self._input.topic.message)
        except Malformed as error:
            self._malformed.append(str(error))
            return False
        before = self.accepted
        if before is not None and not self._input.every and (sample.epoch, sample.stamp_ns) < (before.epoch, before.stamp_ns):
            return True  # overtaken: what was said later has arrived before
        self._latest, self.accepted = (sample.stamp_ns, message), sample
        if self._input.every:
            self._fresh.append(self._latest)
        return True

    def is_fresh(self, t_ns: int) -> bool:
        return self._latest is not None and t_ns - self._latest[0] <= self._max_age

    def value(self, t_ns: int) -> Any:
        """The newest message, or the list of those not yet seen; None or [] when there is none."""
        if self._input.every:
            taken = [message for stamp, message in self._fresh if t_ns - stamp <= self._max_age]
            self._fresh.clear()
            return taken
        return self._latest[1] if self._latest is not None and self.is_fresh(t_ns) else None


class InputBox:
    """All owners of one declared input."""

    def __init__(self, declared: Input, ageless: bool, epoch: int) -> None:
        self.declared = declared
        self._ageless = ageless
        self.epoch = epoch
        self._slots: dict[str, Slot] = {}
        self._malformed: list[str] = []

    def push(self, sample: Sample) -> None:
        """Takes a message of this epoch (or of none); what an old one still sends is dropped, an operator's word is not."""
        if 0 < sample.epoch < self.epoch:
            if not self.declared.topic.across_epochs:
                return
            sample = sample._replace(stamp_ns=-1)
        owner = sample.key.split("/")[1] if self.declared.each_vehicle else ""
        if owner not in self._slots:
            self._slots[owner] = Slot(self.declared, self._ageless, self._malformed)
            self._slots = dict(sorted(self._slots.items()))
        self._slots[owner].push(sample)

    def surviving(self, epoch: int) -> list[Sample]:
        """What still counts when time starts over: the new epoch's own messages, and what holds across epochs.

        The latter is stamped anew with the beginning of time, so that everything said later comes after it.
        """
        slots = self._slots.values()
        new = [s for slot in slots for s in slot.arrived if s.epoch >= epoch]
        if not self.declared.topic.across_epochs:
            return new
        old = [s for slot in slots for s in (slot.accepted, *slot.arrived) if s is not None and s.epoch < epoch]
        return [s._replace(stamp_ns=-1) for s in sorted(old, key=lambda s: (s.epoch, s.stamp_ns))[-1:]] + new

    def take(self, t_ns: int) -> None:
        for slot in self._slots.values():
            slot.take(t_ns)

    def is_missing(self, t_ns: int) -> bool:
        return self.declared.required and not any(slot.is_fresh(t_ns) for slot in self._slots.values())

    def value(self, t_ns: int) -> Any:
        if self.declared.each_vehicle:
            return {owner: slot.value(t_ns) for owner, slot in self._slots.items() if slot.is_fresh(t_ns)}
        if not self._slots:
            return [] if self.declared.every else None
        return self._slots[""].value(t_ns)

    def malformed(self) -> list[str]:
        """Lines about refused messages since the last call."""
        lines = self._malformed[:]
        self._malformed.clear()
        return lines
