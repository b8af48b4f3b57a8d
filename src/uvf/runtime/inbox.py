"""What has arrived for one service: ordered, decoded once, aged in message time."""

from collections import deque
from typing import Any

from google.protobuf.message import DecodeError, Message

from uvf.runtime.bus import Sample
from uvf.runtime.clock import NS
from uvf.runtime.service import Input

EVERY_DEPTH = 256


class Slot:
    """One topic of one owner (or of several sources) as one input sees it."""

    def __init__(self, declared: Input, ageless: bool) -> None:
        self._input = declared
        self._max_age = float("inf") if ageless else declared.topic.max_age * NS
        self._ageless = ageless
        self.arrived: deque[Sample] = deque(maxlen=EVERY_DEPTH)
        self._fresh: list[tuple[int, Message]] = []
        self._latest: tuple[int, Message] | None = None
        self.malformed: list[str] = []

    def push(self, sample: Sample) -> None:
        self.arrived.append(sample)

    def take(self, t_ns: int) -> None:
        """Makes readable what is stamped before ``t_ns``, ordered by (stamp, key, seq)."""
        if not self.arrived:
            return
        ready = [s for s in self.arrived if self._ageless or s.stamp_ns < t_ns]
        if not ready:
            return
        waiting = [s for s in self.arrived if not self._ageless and s.stamp_ns >= t_ns]
        self.arrived = deque(waiting, maxlen=EVERY_DEPTH)
        ready.sort(key=lambda s: (s.stamp_ns, s.key, s.seq))
        for sample in ready if self._input.every else ready[-1:]:
            self._accept(sample)

    def _accept(self, sample: Sample) -> None:
        wanted = self._input.topic.message
        if sample.type_name != wanted.DESCRIPTOR.full_name:
            self.malformed.append(f"{sample.key}: {sample.type_name or 'untyped bytes'} where {wanted.DESCRIPTOR.full_name} is due")
            return
        try:
            message = wanted.FromString(sample.payload)
        except DecodeError as error:
            self.malformed.append(f"{sample.key}: broken {wanted.DESCRIPTOR.full_name}: {error}")
            return
        self._latest = (sample.stamp_ns, message)
        if self._input.every:
            self._fresh.append(self._latest)

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

    def __init__(self, declared: Input, ageless: bool) -> None:
        self.declared = declared
        self._ageless = ageless
        self._slots: dict[str, Slot] = {}

    def push(self, sample: Sample) -> None:
        owner = sample.key.split("/")[1] if self.declared.each_vehicle else ""
        if owner not in self._slots:
            self._slots[owner] = Slot(self.declared, self._ageless)
        self._slots[owner].push(sample)

    def unread(self) -> list[Sample]:
        """What has arrived but has not been taken yet."""
        return [sample for slot in self._slots.values() for sample in slot.arrived]

    def take(self, t_ns: int) -> None:
        for slot in self._slots.values():
            slot.take(t_ns)

    def is_missing(self, t_ns: int) -> bool:
        return self.declared.required and not any(slot.is_fresh(t_ns) for slot in self._slots.values())

    def value(self, t_ns: int) -> Any:
        if self.declared.each_vehicle:
            return {owner: slot.value(t_ns) for owner, slot in sorted(self._slots.items()) if slot.is_fresh(t_ns)}
        if not self._slots:
            return [] if self.declared.every else None
        return self._slots[""].value(t_ns)

    def malformed(self) -> list[str]:
        """Lines about refused messages since the last call."""
        lines = [line for slot in self._slots.values() for line in slot.malformed]
        for slot in self._slots.values():
            slot.malformed.clear()
        return lines
