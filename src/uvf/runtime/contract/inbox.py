"""What has arrived for one service: ordered, decoded once, aged in message time."""

from collections import Counter, deque
from collections.abc import Iterator
from typing import Any

from google.protobuf.message import Message

from schemas.topics import SYSTEM
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.contract.declaration import Input
from uvf.runtime.messages.spawned import name_fault
from uvf.runtime.messages.step_times import NS

EVERY_DEPTH = 256
AHEAD_MOST = 2 * NS
"""How far ahead of a step something may be stamped: by the latency of who sent it. What is stamped later was by another clock."""
OWNERS_MOST = 128  # vehicles of one input
SILENT = 60 * NS
"""After which a vehicle makes room for another where there are too many."""
REFUSED_MOST = 10_000
"""Lines about refused messages that wait for the next step, which does not come while the clock stands; more are not counted."""
NEXT_EPOCH_DEPTH = 8
"""Messages of a key, the newest, that wait while they are of an epoch that the clock has not told of; more where each one counts."""


class Slot:
    """One topic of one owner (or of several sources) as one input sees it."""

    def __init__(self, declared: Input, ageless: bool, malformed: deque[str]) -> None:
        """malformed: takes a line about each refused message."""
        self._input = declared
        self._max_age = declared.topic.max_age * NS if declared.ages and not ageless else float("inf")
        self._ageless = ageless
        self._fresh: deque[tuple[int, Message]] = deque(maxlen=EVERY_DEPTH)
        self._latest: tuple[int, Message] | None = None
        self.arrived: deque[Sample] = deque(maxlen=EVERY_DEPTH)
        self.taken_ns = 0
        """When something was taken here last."""
        self.accepted: Sample | None = None
        self._malformed = malformed
        self._good: tuple[tuple[int, Message] | None, Sample | None] = (None, None)
        """What held before the newest ``take``."""

    def push(self, sample: Sample) -> None:
        """Adds a message that has arrived."""
        self.arrived.append(sample)

    def take(self, t_ns: int) -> None:
        """Makes readable what is stamped before ``t_ns`` [ns], ordered by (epoch, stamp, key, seq)."""
        self._good = (self._latest, self.accepted)
        if not self.arrived:
            return
        self.taken_ns = t_ns
        if len(self.arrived) == 1 and (self._ageless or self.arrived[0].stamp_ns < t_ns):
            self._accept(self.arrived.popleft())
            return
        ready = [s for s in self.arrived if self._ageless or s.stamp_ns < t_ns]
        if not ready:
            self._hold_back(list(self.arrived), t_ns)
            return
        self._hold_back([s for s in self.arrived if not (self._ageless or s.stamp_ns < t_ns)], t_ns)
        ready.sort(key=lambda s: (s.epoch, s.stamp_ns, s.key, s.seq))
        if self._input.every:
            for sample in ready:
                self._accept(sample)
        else:
            # A broken message hides none of the good ones before it.
            any(self._accept(sample) for sample in reversed(ready))

    def _hold_back(self, later: list[Sample], t_ns: int) -> None:
        """What is stamped farther ahead than anybody's latency would wait here for ever, in the place of what is true."""
        self.arrived = deque((s for s in later if s.stamp_ns <= t_ns + AHEAD_MOST), maxlen=EVERY_DEPTH)
        if len(self.arrived) < len(later):
            key = next(s.key for s in later if s.stamp_ns > t_ns + AHEAD_MOST)
            self._malformed += [f"{key}: stamped more than {AHEAD_MOST / NS:g} s ahead of the clock"] * (len(later) - len(self.arrived))

    def undo(self) -> None:
        """Forgets what the newest ``take`` has made readable."""
        self._latest, self.accepted = self._good
        self._fresh.clear()

    def _accept(self, sample: Sample) -> bool:
        try:
            message = decode_sample(sample, self._input.topic.message)
        except Malformed as error:
            self._malformed.append(str(error))
            return False
        if not self._input.every and self._is_overtaken(sample):
            return True
        self._latest, self.accepted = (sample.stamp_ns, message), sample
        if self._input.every:
            self._fresh.append(self._latest)
        return True

    def _is_overtaken(self, sample: Sample) -> bool:
        """What was said later has arrived before. Who has no epoch is of the one that holds.

        On wall time nobody knows what is ahead of the clock: there a sender's stamps are compared with his own only.
        """
        before = self.accepted
        if before is None or (self._ageless and sample.boot != before.boot):
            return False
        return (sample.epoch or before.epoch, sample.stamp_ns) < (before.epoch or sample.epoch, before.stamp_ns)

    def is_fresh(self, t_ns: int) -> bool:
        """Whether the newest message is young enough to count at ``t_ns`` [ns]."""
        return self._latest is not None and t_ns - self._latest[0] <= self._max_age

    def value(self, t_ns: int) -> Any:
        """Newest message, or the list of those not yet seen; None or [] when there is none that counts at ``t_ns`` [ns]."""
        if self._input.every:
            taken = [message for stamp, message in self._fresh if t_ns - stamp <= self._max_age]
            self._fresh.clear()
            return taken
        return self._latest[1] if self._latest is not None and self.is_fresh(t_ns) else None


def _of_no_epoch(sample: Sample) -> str:
    return f"{sample.key}: of epoch {sample.epoch}, which the clock has not begun"


class InputBox:
    """Messages of one declared input, of all its owners."""

    def __init__(self, declared: Input, ageless: bool, epoch: int) -> None:
        self.declared = declared
        self._ageless = ageless
        self.epoch = epoch
        self._slots: dict[str, Slot] = {}
        self._t_ns = 0
        self._malformed: deque[str] = deque(maxlen=REFUSED_MOST)
        self._next: dict[str, deque[Sample]] = {}
        """Of an epoch that the clock has not begun yet, by key."""
        self._pushed_out: Counter[str] = Counter()
        """How many of these newer ones have pushed out, by key."""
        self._next_since: int | None = None

    def begin(self, epoch: int) -> None:
        """Begins an epoch of the clock; what was sent ahead of it counts from now on, or never."""
        self.epoch = epoch
        ahead = self._ahead()
        self._forget_next_epoch()
        for sample in ahead:
            self.push(sample)

    def _forget_next_epoch(self) -> None:
        self._next.clear()
        self._pushed_out.clear()
        self._next_since = None

    def _ahead(self) -> list[Sample]:
        return [sample for samples in self._next.values() for sample in samples]

    def push(self, sample: Sample) -> None:
        """Adds a message of this epoch (or of none); one of an old epoch is dropped, unless it holds across epochs."""
        if 0 < sample.epoch < self.epoch:
            if not self.declared.topic.across_epochs:
                return
            sample = sample._replace(stamp_ns=-1)
        elif sample.epoch > self.epoch:
            self._hold_for_next_epoch(sample)
            return
        owner = sample.key.split("/")[1] if self.declared.each_vehicle else ""
        if owner in self._slots or self._is_welcome(owner):
            self._slots[owner].push(sample)

    def _is_welcome(self, owner: str) -> bool:
        """Makes room for one more owner, if it is called as a vehicle may be called and there are not too many."""
        if owner not in ("", SYSTEM) and (why := name_fault(owner)):
            self._malformed.append(f"{self.declared.topic.key}: {why}")
        elif len(self._slots) >= OWNERS_MOST and not self._forget_silent():
            self._malformed.append(f"{self.declared.topic.key}: of more than {OWNERS_MOST} vehicles")
        else:
            self._slots[owner] = Slot(self.declared, self._ageless, self._malformed)
            self._slots[owner].taken_ns = self._t_ns
            self._slots = dict(sorted(self._slots.items()))
            return True
        return False

    def _forget_silent(self) -> bool:
        """Makes room in the place of whoever has been silent for longest, if that is long."""
        owner = min(self._slots, key=lambda owner: self._slots[owner].taken_ns)
        if self._slots[owner].arrived or self._t_ns - self._slots[owner].taken_ns < SILENT:
            return False
        del self._slots[owner]
        return True

    def _hold_for_next_epoch(self, sample: Sample) -> None:
        """Only the clock begins an epoch. Its next one may be heard of late; any other is nobody's."""
        is_nobodys = self.epoch > 0 and sample.epoch > self.epoch + 1
        if is_nobodys or (sample.key not in self._next and len(self._next) >= OWNERS_MOST):
            self._malformed.append(_of_no_epoch(sample))
            return
        depth = EVERY_DEPTH if self.declared.every else NEXT_EPOCH_DEPTH
        held = self._next.setdefault(sample.key, deque(maxlen=depth))
        self._pushed_out[sample.key] += len(held) == depth
        held.append(sample)

    def _give_up_next_epoch(self, t_ns: int) -> None:
        """What was ahead of the clock for so long was never of its epoch."""
        if self._next_since is None:
            self._next_since = t_ns
        elif t_ns > self._next_since + AHEAD_MOST:
            for key, held in self._next.items():
                self._malformed += [_of_no_epoch(held[0])] * min(self._pushed_out[key], REFUSED_MOST)
                self._malformed += [_of_no_epoch(sample) for sample in held]
            self._forget_next_epoch()

    def surviving(self, epoch: int) -> list[Sample]:
        """Messages that still count when time starts over: the new epoch's own, and what holds across epochs.

        The latter is stamped anew with the beginning of time, so that everything said later comes after it.
        """
        slots = self._slots.values()
        new = [s for slot in slots for s in slot.arrived if s.epoch >= epoch] + [s for s in self._ahead() if s.epoch == epoch]
        if not self.declared.topic.across_epochs:
            return new
        old = [s for slot in slots for s in (slot.accepted, *slot.arrived) if s is not None and s.epoch < epoch]
        return [s._replace(stamp_ns=-1) for s in sorted(old, key=lambda s: (s.epoch, s.stamp_ns))[-1:]] + new

    def take(self, t_ns: int) -> None:
        """Makes readable what is stamped before ``t_ns`` [ns], of all owners."""
        self._t_ns = t_ns
        if self._next:
            self._give_up_next_epoch(t_ns)
        for slot in self._slots.values():
            slot.take(t_ns)

    def undo(self) -> None:
        """Forgets what the newest ``take`` has made readable, of all owners."""
        for slot in self._slots.values():
            slot.undo()

    def accepted(self) -> Iterator[tuple[str, bytes]]:
        """Key and bytes of the newest message of each owner."""
        for slot in self._slots.values():
            if slot.accepted is not None:
                yield slot.accepted.key, slot.accepted.payload

    def is_missing(self, t_ns: int) -> bool:
        """Whether the input is required and no message of it counts at ``t_ns`` [ns]."""
        return self.declared.required and not any(slot.is_fresh(t_ns) for slot in self._slots.values())

    def value(self, t_ns: int) -> Any:
        """What a step at ``t_ns`` [ns] sees: a message, a list, or a dict of either by owner."""
        if self.declared.each_vehicle:
            return {owner: slot.value(t_ns) for owner, slot in self._slots.items() if slot.is_fresh(t_ns)}
        if not self._slots:
            return [] if self.declared.every else None
        return self._slots[""].value(t_ns)

    def malformed(self) -> list[str]:
        """Lines about refused messages since the last call."""
        lines = list(self._malformed)
        self._malformed.clear()
        return lines
