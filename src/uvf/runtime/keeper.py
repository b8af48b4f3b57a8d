"""Keeps the newest message of each kept topic, so that what a service has worked out outlives its process."""

from schemas.topics import CLOCK, SYSTEM, TOPICS
from uvf.runtime.bus import Query, Sample
from uvf.runtime.zenoh_bus import ZenohBus, kept_key

DEPTH = 256


class Keeper:
    """Lives beside the router, which outlives the services. ``poll`` hands over and answers."""

    def __init__(self, bus: ZenohBus) -> None:
        self._bus = bus
        self._newest: dict[str, Sample] = {}
        self._epoch = 0
        for topic in TOPICS.values():
            if topic.kept and topic is not CLOCK:
                bus.subscribe(topic.by("*").at("*"), topic.qos, self._keep, DEPTH)
        bus.subscribe(CLOCK.at(SYSTEM), CLOCK.qos, self._on_clock, depth=1)
        bus.serve(kept_key("**"), self._answer)

    def _keep(self, sample: Sample) -> None:
        self._newest[kept_key(sample.key)] = sample

    def _on_clock(self, sample: Sample) -> None:
        """A new epoch forgets the old one; what the new one has already sent is kept."""
        self._keep(sample)
        if sample.epoch != self._epoch:
            self._epoch = sample.epoch
            self._newest = {key: kept for key, kept in self._newest.items() if kept.epoch >= sample.epoch}

    def _answer(self, query: Query) -> None:
        kept = self._newest.get(query.key)
        if kept is None:
            query.refuse("nothing kept")
        else:
            query.answer(kept.payload, kept.stamp_ns)

    def poll(self) -> None:
        self._bus.poll()
