"""Keeps the newest message of each kept topic and all words about STOP ALL, so that what was said outlives who said it."""

from schemas.messages import StopState
from schemas.topics import CLOCK, STOP, STOP_STATE, SYSTEM, TOPICS
from uvf.runtime.bus import Query, Sample
from uvf.runtime.inbox import AHEAD_MOST
from uvf.runtime.stop_all import StopBook
from uvf.runtime.zenoh_bus import ZenohBus, kept_key

DEPTH = 256
KEYS_MOST = 4096


class Keeper:
    """Lives beside the router, which outlives the services. ``poll`` hands over and answers."""

    def __init__(self, bus: ZenohBus) -> None:
        self._bus = bus
        self._newest: dict[str, Sample] = {}
        self._clock: Sample | None = None
        self._stops = StopBook()
        self._told = self._stops.now
        self._stop_state = bus.publisher(STOP_STATE.at(SYSTEM), StopState.DESCRIPTOR.full_name, STOP_STATE.qos)
        bus.subscribe(CLOCK.at(SYSTEM), CLOCK.qos, self._on_clock, depth=1)  # the first, so that it is the first to be polled
        bus.subscribe(STOP.by("*").at(SYSTEM), STOP.qos, self._stops.push, DEPTH)
        for topic in TOPICS.values():
            if topic.kept and topic is not CLOCK:
                bus.subscribe(topic.by("*").at("*"), topic.qos, self._keep, DEPTH)
        bus.serve(kept_key("**"), self._answer)

    def _keep(self, sample: Sample) -> None:
        key = kept_key(sample.key)
        old = self._newest.get(key)
        is_new = old is not None or len(self._newest) < KEYS_MOST
        if is_new and not self._is_ahead(sample) and not (old is not None and _is_older(sample, old)):
            self._newest[key] = sample

    def _is_ahead(self, sample: Sample) -> bool:
        """Of an epoch or of a time that the clock has not come to: it would stand in the place of all that is true."""
        if self._clock is None:
            return False
        epoch, t_ns = self._clock.epoch, self._clock.stamp_ns
        return sample.epoch > epoch + 1 or (sample.epoch == epoch and sample.stamp_ns > t_ns + AHEAD_MOST)

    def _on_clock(self, sample: Sample) -> None:
        """A new epoch forgets the old one; what the new one has already sent is kept."""
        self._newest[kept_key(sample.key)] = sample
        if self._clock is None or sample.epoch != self._clock.epoch:
            self._newest = {key: kept for key, kept in self._newest.items() if kept.epoch >= sample.epoch}
        self._clock = sample

    def _answer(self, query: Query) -> None:
        kept = self._newest.get(query.key)
        if kept is None:
            query.refuse("nothing kept")
        else:
            query.answer(kept.payload, kept.stamp_ns)

    def poll(self) -> None:
        self._bus.poll()
        if self._stops.now != self._told:
            self._told = self._stops.now
            now = self._clock.stamp_ns if self._clock is not None else 0
            self._stop_state.put(self._stops.state(now).SerializeToString(deterministic=True), now)


def _is_older(sample: Sample, than: Sample) -> bool:
    """History may come late, also from a writer that has died since. Where there are no epochs, stamps may begin anew."""
    if (sample.epoch or than.epoch) and (sample.epoch, sample.stamp_ns) != (than.epoch, than.stamp_ns):
        return (sample.epoch, sample.stamp_ns) < (than.epoch, than.stamp_ns)
    return sample.boot == than.boot and sample.seq < than.seq
