"""How often messages came, how old they were, and what they took: of each topic of a run."""

from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import DecodeError

from schemas.topics import Topic
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import seconds
from uvf.runtime.messages.step_times import NS
from uvf.runtime.messages.topic_lookup import topic_of

LOOKED_AT_EVERY = NS // 2
"""Simulation time [ns] between two messages of a key whose content is looked at for its age."""


@dataclass
class TopicTraffic:
    """What came on one key; times [s, simulation]."""

    key: str
    topic: Topic[Any] | None
    count: int = 0
    size: int = 0  # bytes
    first: float = 0.0
    last: float = 0.0
    longest_gap: float = 0.0
    missing: int = 0
    """Sequence numbers that did not come."""
    ages: list[float] = field(default_factory=list)
    """From what a message tells of to when it was sent [s], of one in half a second."""
    _seq: int = 0
    _next_look: int = 0

    def add(self, sample: Sample) -> None:
        """Counts a message."""
        t = sample.stamp_ns / NS
        if self.count:
            self.longest_gap = max(self.longest_gap, t - self.last)
            self.missing += max(sample.seq - self._seq - 1, 0)
        else:
            self.first = t
        self.last, self._seq = t, sample.seq
        self.count += 1
        self.size += len(sample.payload)
        if self.topic is not None and sample.stamp_ns >= self._next_look:
            self._next_look = sample.stamp_ns + LOOKED_AT_EVERY
            self._look(t, sample, self.topic)

    def _look(self, t: float, sample: Sample, topic: Topic[Any]) -> None:
        if sample.type_name != topic.message.DESCRIPTOR.full_name or "timestamp" not in topic.message.DESCRIPTOR.fields_by_name:
            return
        try:
            self.ages.append(t - seconds(topic.message.FromString(sample.payload).timestamp))
        except DecodeError:
            return

    @property
    def rate(self) -> float:
        """Messages a second [Hz]; 0 for a single one."""
        return (self.count - 1) / (self.last - self.first) if self.last > self.first else 0.0

    @property
    def median_age(self) -> float:
        """s; 0 where no age is known."""
        return sorted(self.ages)[len(self.ages) // 2] if self.ages else 0.0


class Traffic:
    """The traffic of a run, by key."""

    def __init__(self) -> None:
        self._keys: dict[str, TopicTraffic] = {}

    def heard(self, sample: Sample) -> None:
        """Counts a message."""
        if sample.key not in self._keys:
            self._keys[sample.key] = TopicTraffic(sample.key, topic_of(sample.key))
        self._keys[sample.key].add(sample)

    @property
    def topics(self) -> list[TopicTraffic]:
        """Sorted by key."""
        return [self._keys[key] for key in sorted(self._keys)]
