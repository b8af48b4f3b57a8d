"""Keeps the newest message of each kept topic and all words about STOP ALL, so that what was said outlives who said it."""

from collections.abc import Callable

from schemas.messages import Clock, StopState
from schemas.topics import CLOCK, STOP, STOP_STATE, SYSTEM, TOPICS
from uvf.runtime.bus.interface import Query, Sample
from uvf.runtime.bus.wire import Malformed, decode_sample, guarded
from uvf.runtime.bus.zenoh_bus import ZenohBus, kept_key
from uvf.runtime.contract.inbox import AHEAD_MOST
from uvf.runtime.messages.refusals import Refusals
from uvf.runtime.messages.topic_lookup import topic_of
from uvf.runtime.state.stop_all import StopBook

DEPTH = 256
KEYS_MOST = 4096
FOR_EVER = 2**63  # ns


class StateStore:
    """Keeps the newest message of kept topics, beside the router, which outlives the services. ``poll`` hands over and answers."""

    def __init__(self, bus: ZenohBus, tell: Callable[[str], None]) -> None:
        """tell: takes a line about each kind of message that is not kept because nobody could read it."""
        self._bus = bus
        self._newest: dict[str, Sample] = {}
        self._next: dict[str, Sample] = {}
        """Of the epoch that the clock may be about to begin."""
        self._clock: Clock | None = None
        self._stops = StopBook()
        self._refusals = Refusals(tell)
        self._told = self._stops.now
        self._stop_state = bus.publisher(STOP_STATE.at(SYSTEM), StopState.DESCRIPTOR.full_name, STOP_STATE.qos)
        on_clock = guarded(CLOCK, self._on_clock, self._refusals.refuse)
        bus.subscribe(CLOCK.at(SYSTEM), CLOCK.qos, on_clock, depth=8)  # the first, so that it is the first to be polled
        bus.subscribe(STOP.by("*").at(SYSTEM), STOP.qos, self._stops.push, DEPTH)
        for topic in TOPICS.values():
            if topic.kept and topic is not CLOCK:
                bus.subscribe(topic.by("*").at("*"), topic.qos, self._keep, DEPTH)
        bus.serve(kept_key("**"), self._answer)

    def _keep(self, sample: Sample) -> None:
        if not self._is_sound(sample):
            return
        epoch, t_ns = (self._clock.epoch, self._clock.t_ns) if self._clock is not None else (sample.epoch, FOR_EVER)
        if sample.epoch == epoch + 1 and sample.stamp_ns <= AHEAD_MOST:
            _put(self._next, sample)
        elif sample.epoch <= epoch and (sample.epoch < epoch or sample.stamp_ns <= t_ns + AHEAD_MOST):
            # Of an epoch or of a time that the clock has not come to, it would stand in the place of all that is true.
            _put(self._newest, sample)

    def _is_sound(self, sample: Sample) -> bool:
        """What nobody could read would be handed to the next one who starts."""
        topic = topic_of(sample.key)
        try:
            return topic is not None and decode_sample(sample, topic.message) is not None
        except Malformed as error:
            self._refusals.refuse(str(error))
            return False

    def _on_clock(self, clock: Clock, sample: Sample) -> None:
        """A new epoch forgets the old one; what the new one has already sent is kept."""
        if self._clock is None or clock.epoch != self._clock.epoch:
            ahead, self._next = self._next, {}
            kept = (*self._newest.values(), *ahead.values())
            self._newest = {kept_key(each.key): each for each in kept if each.epoch >= clock.epoch}
        self._clock = clock
        self._newest[kept_key(sample.key)] = sample

    def _answer(self, query: Query) -> None:
        kept = self._newest.get(query.key)
        if kept is None:
            query.refuse("nothing kept")
        else:
            query.answer(kept.payload, kept.stamp_ns)

    def poll(self) -> None:
        """Takes in messages and answers requests; publishes who engages STOP ALL when that has changed."""
        self._bus.poll()
        if self._stops.now != self._told:
            self._told = self._stops.now
            now = self._clock.t_ns if self._clock is not None else 0
            self._stop_state.put(self._stops.state(now).SerializeToString(deterministic=True), now)


def _put(kept: dict[str, Sample], sample: Sample) -> None:
    key = kept_key(sample.key)
    old = kept.get(key)
    if (old is not None or len(kept) < KEYS_MOST) and not (old is not None and _is_older(sample, old)):
        kept[key] = sample


def _is_older(sample: Sample, than: Sample) -> bool:
    """History may come late, also from a writer that has died since. Where there are no epochs, stamps may begin anew."""
    if (sample.epoch or than.epoch) and (sample.epoch, sample.stamp_ns) != (than.epoch, than.stamp_ns):
        return (sample.epoch, sample.stamp_ns) < (than.epoch, than.stamp_ns)
    return sample.boot == than.boot and sample.seq < than.seq
