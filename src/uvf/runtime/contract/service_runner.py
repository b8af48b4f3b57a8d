"""The shell of one service instance: its inputs, its due times and ``advance``, the one way any step is called."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import Event, VehicleStatus
from schemas.topics import PARAM, SYSTEM, Qos
from uvf.runtime.bus.interface import Bus, Query, Sample
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.contract.bulkhead import FAILURES, GIVEN_UP, STARTED_AFRESH, WINDOW, Bulkhead
from uvf.runtime.contract.declaration import Called, Frames, Input, StopInput, Writes, declared_in
from uvf.runtime.contract.inbox import AHEAD_MOST, EVERY_DEPTH, InputBox
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.link_cuts import LinkCuts
from uvf.runtime.contract.outbox import OutputBox
from uvf.runtime.contract.param_server import ParamServer
from uvf.runtime.contract.request_desk import QUERIES_MOST, ContractError, RequestDesk
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.outputs import OutputMessages
from uvf.runtime.messages.refusals import Refusals
from uvf.runtime.messages.step_times import NS, first_step_after, step_time
from uvf.runtime.process.watchdog import Watchdog, time_limit
from uvf.runtime.state.stop_all import StopBook, StopStatus

Warn = Callable[[str], None]
LATEST_DEPTH = 8  # more than one, for the newest may be too new to be read yet
OFTEN, UNMADE = f"has failed {FAILURES} times within {WINDOW:g} s", "cannot be started afresh"
AFRESH = "time has started over: ask again"


@dataclass
class Counters:
    """Counters of one instance's steps and messages."""

    published: dict[str, int]
    """The number of the newest message on each key."""
    steps: int = 0
    stale: int = 0
    skipped: int = 0
    failures: int = 0
    missing: tuple[str, ...] = ()


class ServiceRunner:
    """Runs one instance on a bus: live, in lockstep and in tests alike."""

    def __init__(
        self, host: ServiceInstance, bus: Bus, warn: Warn = lambda line: None, contains: bool = False, watchdog: Watchdog | None = None
    ) -> None:
        """contains: failures of a vehicle's instance are kept from the others, else raised; watchdog: then ends a step that hangs."""
        self.host = host
        self.type = host.service
        self.owner = host.vehicle or SYSTEM
        self.epoch = 0
        self.sim_ns = 0
        """Simulation time now, kept by the loop: the stamp of what wall-clock services send."""
        self._bus = bus
        self._warn = warn
        self._bulkhead = Bulkhead() if contains and self.type.scope == "vehicle" and not self.type.simulator else None
        self._limited: Callable[[], AbstractContextManager[None]] = nullcontext
        if watchdog is not None and self._bulkhead is not None:
            self._limited = partial(watchdog.limited, time_limit(self.type.hz))
        self._links = LinkCuts(self.owner, host.faults, self.type.simulator)
        self._outbox = OutputBox(self.type, self.owner, bus, self._links)
        self._calls = self._outbox.calls
        self.counters = Counters(self._outbox.published)
        self._desk = RequestDesk(self.type, self._outbox.put, self._refused)
        self._answered = [name for name, how in declared_in(self.type.Inputs).items() if isinstance(how, Called)]
        self.refusals = Refusals(lambda line: warn(f"{self.type.name}: {line}"))
        self._stops = StopBook(at_once=self.type.clock == "wall")
        self.service: Service
        self._boxes: dict[str, InputBox] = {}
        self._frames: dict[str, FrameBuffer] = {}
        self._make()
        self._listen()
        self._subscribe()

    def join(self, epoch: int) -> None:
        """Enters an epoch without being made afresh: at the first clock, and wall-clock services always."""
        self.epoch = self._calls.epoch = epoch
        for box in self._boxes.values():
            box.begin(epoch)

    def restart(self, epoch: int) -> None:
        """Makes the service afresh because time has started over; requests of the old epoch are refused."""
        trouble = self._contain(self._close)
        self.epoch = self._calls.epoch = epoch
        kept = [(name, sample) for name, box in self._boxes.items() for sample in box.surviving(epoch)]
        self._refuse_all(AFRESH)
        if self._bulkhead is not None:
            self._bulkhead = Bulkhead()
        self._outbox.left.clear()
        unmade = self._contain(self._make)
        self._listen()
        for name, sample in kept:
            self._boxes[name].push(sample)
        if unmade and self._bulkhead is not None:
            self._bulkhead.given_up = unmade
        if trouble or unmade:
            self.counters.failures += 1
            self._tell_failure(0, unmade or trouble, UNMADE if unmade else "")

    def _refuse_all(self, reason: str) -> None:
        self._desk.refuse_all(reason)
        self._param_server.refuse_all(reason)
        self._calls.clear()

    def recall(self, find: Callable[[str], bytes | None]) -> None:
        """Hands the service what an instance before it has left; ``find`` gives the newest bytes of a key."""
        if trouble := self._contain(lambda: self._recall(find)):
            self.counters.failures += 1
            self._make()
            self._tell_failure(self.sim_ns, f"it could not take up what was left: {trouble}")

    def _recall(self, find: Callable[[str], bytes | None]) -> None:
        found = {name: (topic, find(topic.at(self.owner))) for name, topic in self.type.recalls.items()}
        messages: dict[str, Message] = {}
        for name, (topic, payload) in found.items():
            try:
                messages |= {name: decode(name, payload, topic.message)} if payload is not None else {}
            except Malformed as error:
                self._warn(f"{self.type.name}: {error}")
        for message in messages.values():
            if isinstance(message, VehicleStatus):
                self._stops.take_up(message.stops)
        if messages:
            self.service.recall(self.type.Recalls(**messages))

    def _make(self) -> None:
        self.service = self.host.make()
        self._param_server = ParamServer(self.service)

    def _listen(self) -> None:
        """Begins with nothing heard, but for STOP ALL, which holds on."""
        ageless = self.type.clock == "wall"
        heard = self.type.declared_inputs().items()
        self._boxes = {name: InputBox(declared, ageless, self.epoch) for name, declared in heard if not self._is_stop(name)}
        self._valued = [name for name in self._boxes if name in self.type.inputs]
        self._frames = {name: FrameBuffer() for name, declared in self.type.inputs.items() if isinstance(declared, Frames)}
        self._stop_inputs = [name for name, declared in self.type.inputs.items() if isinstance(declared, StopInput)]
        self.n = 1

    def _is_stop(self, name: str) -> bool:
        return isinstance(self.type.inputs.get(name.partition("/")[0]), StopInput)

    def reads(self) -> Iterator[tuple[str, Input, str]]:
        """Each declared input by name, with the owner whose messages it takes; ``*`` = of every vehicle."""
        for name, declared in self.type.declared_inputs().items():
            yield name, declared, "*" if declared.each_vehicle else (self.host.roles or {}).get(declared.role or "", self.owner)

    def _subscribe(self) -> None:
        for name, declared, owner in self.reads():
            wide = declared.every or declared.each_vehicle or declared.topic.qos in (Qos.LATCHED, Qos.EVENT)
            depth = EVERY_DEPTH if wide else LATEST_DEPTH
            sink = self._stops.push if self._is_stop(name) else self._sink(name)
            self._bus.subscribe(declared.topic.at(owner), declared.topic.qos, sink, depth)
        everyone = "*" if self.type.scope == "world" else self.owner
        for name, request in self.type.requests.items():
            self._bus.serve(request.at(everyone), lambda query, n=name: self._desk.queue(n, query))  # type: ignore[misc]
        self._bus.serve(self._param_server.key(self.owner), self._queue_param)

    def _sink(self, name: str) -> Callable[[Sample], None]:
        """Where the messages of an input go that are not cut off."""

        def hear(sample: Sample) -> None:
            if not (self._links and self._links.cut(sample.key.split("/")[1], sample.stamp_ns)):
                self._boxes[name].push(sample)

        return hear

    def _queue_param(self, query: Query) -> None:
        if self._param_server.waiting >= QUERIES_MOST:
            query.refuse(f"{self.type.name}: {QUERIES_MOST} requests wait already")
        else:
            self._param_server.queue(query)

    @property
    def n(self) -> int:
        """Number of the next step, from 1."""
        return self._n

    @n.setter
    def n(self, n: int) -> None:
        """Sets the number of the next step, and when it is due."""
        self._n = n
        self.due_ns = step_time(n, self.type.hz)
        """When it is due [ns]; asked far more often than it changes."""

    def skip_to(self, t_ns: int, count: bool = True) -> None:
        """Skips the steps due before the newest one that is due at ``t_ns`` [ns], and counts them if ``count``."""
        newest = first_step_after(t_ns, self.type.hz) - 1
        if newest > self.n:
            self.counters.skipped += (newest - self.n) * count
            self.n = newest

    def advance(self) -> None:
        """Runs one step at its due time: fresh inputs in, outputs published, requests answered."""
        t_ns = self.due_ns
        self.n += 1
        if self._bulkhead is None:
            self._step(t_ns)
        elif self._bulkhead.given_up:
            self._stand_in(t_ns)
        else:
            self._step_contained(t_ns)

    def _step_contained(self, t_ns: int) -> None:
        if cause := self._contain(lambda: self._step(t_ns)):
            self._fail(t_ns, cause)

    def _contain(self, action: Callable[[], None]) -> str:
        """The cause why ``action`` failed, empty if it did not; raises it where nothing is kept from other instances."""
        if self._bulkhead is not None:
            return self._bulkhead.contain(action)
        action()
        return ""

    def _fail(self, t_ns: int, cause: str) -> None:
        """Made afresh from the state that it has left, or given up after the third time, or where it cannot be made."""
        assert self._bulkhead is not None
        self.counters.failures += 1
        t = t_ns / NS
        unclosed, unmade = self._contain(self._close), ""
        given_up = OFTEN if self._bulkhead.failed(t, cause) else ""
        if not given_up:
            keep_params = not self._bulkhead.is_repeated(t)
            unmade = self._contain(lambda: self._revive(keep_params))
        if unmade:
            self._bulkhead.given_up, given_up = unmade, UNMADE
        more = "".join(f"; then, when it was to be {what}, {why}" for what, why in (("ended", unclosed), ("started afresh", unmade)) if why)
        self._tell_failure(t_ns, f"{cause}{more}", given_up)

    def _close(self) -> None:
        with self._limited():
            self.service.close()

    def _revive(self, keep_params: bool) -> None:
        """A new instance with the state of the last good step; keep_params: and the parameters set while it ran, which may be to blame."""
        for box in self._boxes.values():
            box.undo()
        heard = {key: payload for box in self._boxes.values() for key, payload in box.accepted()}
        params = self._param_server.set_params if keep_params else None
        with self._limited():
            self._make()
        if params is not None:
            self._param_server.take_up(params)
        with self._limited():
            self.recall({**heard, **self._outbox.left}.get)

    def _tell_failure(self, t_ns: int, cause: str, given_up: str = "") -> None:
        """given_up: why, where it is."""
        name = f"{self.type.name} of {self.owner}"
        text = f"{name} {given_up} {GIVEN_UP} {self.type.given_up}" if given_up else f"{name} {STARTED_AFRESH}"
        self._refuse_all(f"{name} has failed: {cause}")
        self._warn(f"{text}: {cause}")
        severity = Event.CRITICAL if given_up else Event.ERROR
        event = Event(timestamp=stamp_ns(self._now(t_ns)), severity=severity, text=text, cause=cause, source=self.type.name)
        self._outbox.publish_one(topics.EVENTS.by(self.type.name), event, self._now(t_ns))

    def _stand_in(self, t_ns: int) -> None:
        """In place of an instance that was given up: what is safe, until time starts over or the process is started again."""
        assert self._bulkhead is not None
        reason = f"{self.type.name} of {self.owner} was given up: {self._bulkhead.given_up}"
        self._param_server.refuse_all(reason)
        self._desk.refuse_due(reason, lambda stamp: True, t_ns)
        self._stops.take(t_ns)
        for box in self._boxes.values():
            box.take(t_ns)
            for line in box.malformed():
                self._refused(line)
        if self.type.stand_in is not None:
            self._publish(self.type.stand_in(t_ns / NS, reason), t_ns)

    def _step(self, t_ns: int) -> None:
        for query, reply in self._param_server.answer(lambda stamp: self._is_due(stamp, t_ns), self._refused):
            self._desk.answer(query, PARAM, reply, t_ns)
        stops = self._take(t_ns)
        missing = tuple(name for name, box in self._boxes.items() if box.is_missing(t_ns))
        self.counters.missing = missing
        if missing:
            self.counters.stale += 1
            with self._limited():
                outputs = self._said(self.service.stale(t_ns / NS, missing))
            self._publish(outputs, t_ns)
            reason = f"{self.type.name} waits for {', '.join(missing)}"
            self._desk.refuse_due(reason, lambda stamp: self._is_due(stamp, t_ns), t_ns)
            return
        self.counters.steps += 1
        requests = self._desk.take(lambda stamp: self._is_due(stamp, t_ns))
        values = {name: self._boxes[name].value(t_ns) for name in self._valued}
        with self._limited():
            now = self.type.Inputs(
                **values,
                **stops,
                **self._frames,
                **requests,
                **self._calls.take(self._answered, lambda stamp: self._is_readable(stamp, t_ns)),
            )
            outputs = self._said(self.service.step(t_ns / NS, now))
        self._publish(outputs, t_ns)
        self._desk.reply(outputs, t_ns)

    def _said(self, outputs: Writes) -> OutputMessages:
        if not isinstance(outputs, self.type.Outputs):
            raise ContractError(f"{self.type.name}: step returned a {type(outputs).__name__}, not its Outputs")
        return dict(outputs.said())

    def _take(self, t_ns: int) -> dict[str, StopStatus]:
        """Makes readable what this step may read; returns the inputs that are STOP ALL."""
        for box in self._boxes.values():
            box.take(t_ns)
            for line in box.malformed():
                self._refused(line)
        self._feed_frames(t_ns)
        stops = {name: self._stops.take(t_ns) for name in self._stop_inputs}
        for line in self._stops.refused():
            self._refused(line)
        return stops

    def _is_due(self, stamp_ns: int, t_ns: int) -> bool:
        """Whether a request counts at ``t_ns``: one from a clock of its own would else wait for ever, it is taken as it comes."""
        return self._is_readable(stamp_ns, t_ns) or stamp_ns > t_ns + AHEAD_MOST

    def _refused(self, line: str) -> None:
        """A broken sender is told of, but not at each of its messages: these are counted."""
        self.refusals.refuse(line)

    def _feed_frames(self, t_ns: int) -> None:
        """What is told while ``step`` is held back is taken in too."""
        if not self._frames:
            return
        for name, box in self._boxes.items():
            buffer = self._frames.get(name.partition("/")[0])
            if buffer is None:
                continue
            taken = box.value(t_ns)
            by_vehicle = taken if isinstance(taken, Mapping) else {self.owner: taken}
            for message in (m for messages in by_vehicle.values() for m in messages):
                buffer.add(message, is_static=box.declared.topic.qos is Qos.LATCHED)

    def _is_readable(self, stamp_ns: int, t_ns: int) -> bool:
        return stamp_ns < t_ns or self.type.clock == "wall"

    def _publish(self, outputs: OutputMessages, t_ns: int) -> None:
        self._outbox.publish(outputs, self._now(t_ns) + round(self.type.latency * NS))

    def _now(self, t_ns: int) -> int:
        """The stamp of what a step at ``t_ns`` says."""
        return t_ns if self.type.clock == "sim" else self.sim_ns
