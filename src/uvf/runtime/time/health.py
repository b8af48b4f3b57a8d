"""A process's sign of life: counters of its steps, twice a second of wall time."""

import os
import platform
import time
from collections.abc import Mapping, Sequence
from heapq import nlargest

from schemas import topics
from schemas.messages import Health
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.messages.refusals import LENGTH, Refusals, together
from uvf.runtime.messages.validation import is_text

GAPS_MOST = 100
OTHERS = "others"


def told_gaps(gaps: Mapping[str, int]) -> dict[str, int]:
    """Number of messages missed by key, as they are told: the largest counts, and the sum of all others.

    Among the others are also keys that no reader would take.
    """
    told: dict[str, int] = {}
    for key in nlargest(GAPS_MOST, gaps, key=lambda key: gaps[key]):
        if len(key) <= LENGTH and is_text(key):
            told[key] = gaps[key]
    others = sum(gaps.values()) - sum(told.values())
    return told | {OTHERS: others} if others else told


class HealthReport:
    """Counts how late steps begin and publishes a process's counters."""

    def __init__(self, name: str, shells: Sequence[ServiceRunner], bus: ZenohBus, refusals: Refusals) -> None:
        """refusals: of the process itself, beside those of its instances."""
        self._name = name
        self._refusals = refusals
        self._shells = shells
        self._bus = bus
        self._late = 0
        self._worst = 0.0
        self._next = 0.0
        self._publisher = bus.publisher(topics.HEALTH.by(name).at("sys"), Health.DESCRIPTOR.full_name, topics.HEALTH.qos)

    def begun(self, shell: ServiceRunner, lateness: float) -> None:
        """Takes note of a step that begins ``lateness`` [s, wall] after it was due: by more than one period counts as late."""
        self._worst = max(self._worst, lateness)
        self._late += lateness > 1 / shell.type.hz

    def publish_when_due(self, wall: float, now: int) -> None:
        """Publishes the counters if that is due at ``wall`` [s]. now: simulation time [ns]."""
        if wall < self._next:
            return
        self._next = wall + 1 / topics.HEALTH.hz
        refusals = [self._refusals, *(s.refusals for s in self._shells)]
        message = Health(
            timestamp=stamp_ns(now),
            service=self._name,
            host=platform.node(),
            pid=os.getpid(),
            steps=sum(s.counters.steps for s in self._shells),
            skipped=sum(s.counters.skipped for s in self._shells),
            stale=sum(s.counters.stale for s in self._shells),
            malformed=sum(r.count for r in refusals),
            late=self._late,
            worst_lateness=self._worst,
            cpu_time=time.process_time(),
            gaps=told_gaps(self._bus.counter.gaps),
            refusals=together(refusals),
            missing=sorted({f"{s.type.name}:{m}" for s in self._shells for m in s.counters.missing}),
        )
        self._publisher.put(message.SerializeToString(deterministic=True), now)
