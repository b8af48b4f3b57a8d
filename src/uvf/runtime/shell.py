"""The shell of one service instance: its inputs, its due times and ``advance``, the one way any step is called."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import Message

from schemas.topics import PARAM, SYSTEM, Qos, Request, Topic
from uvf.runtime.bus import Bus, Publisher, Query
from uvf.runtime.clock import NS, first_step_after, step_time
from uvf.runtime.frames import FrameBuffer
from uvf.runtime.inbox import EVERY_DEPTH, InputBox
from uvf.runtime.param_server import ParamServer
from uvf.runtime.service import Answer, Frames, Input, Later, Outputs, Service
from uvf.runtime.site import Host
from uvf.runtime.wire import Malformed, decode

Warn = Callable[[str], None]
LATEST_DEPTH = 8  # more than one, for the newest may be too new to be read yet
QUERIES_MOST = 256
TOLD_MOST = 100  # different lines about broken messages
AHEAD_MOST = 2 * NS  # of latency; a request that is stamped farther ahead was stamped by another clock


class ContractError(Exception):
    """A service returned something that it did not declare."""


@dataclass
class Counters:
    steps: int = 0
    stale: int = 0
    skipped: int = 0
    malformed: int = 0
    missing: tuple[str, ...] = ()
    published: dict[str, int] = field(default_factory=dict)


class Shell:
    """Runs one instance on a bus: live, in lockstep and in tests alike."""

    def __init__(self, host: Host, bus: Bus, warn: Warn = lambda line: None) -> None:
        self.host = host
        self.type = host.service
        self.owner = host.vehicle or SYSTEM
        self.counters = Counters()
        self.epoch = 0
        self.sim_ns = 0
        """Simulation time now, kept by the loop: the stamp of what wall-clock services send."""
        self._bus = bus
        self._warn = warn
        self._publishers: dict[str, Publisher] = {}
        self._queries: dict[str, deque[Query]] = {name: deque() for name in self.type.requests}
        self._answers: dict[str, deque[tuple[int, Answer[Any, Any]]]] = {name: deque() for name in self.type.calls}
        self._open: list[tuple[Query, Request[Any, Any], Later[Any]]] = []
        """Requests that a later step answers."""
        self._told: set[str] = set()
        self.service: Service
        self._boxes: dict[str, InputBox] = {}
        self._frames: dict[str, FrameBuffer] = {}
        self._make()
        self._subscribe()

    def join(self, epoch: int) -> None:
        """Goes on in an epoch, without being made afresh: at the first clock, and wall-clock services always."""
        self.epoch = epoch
        for box in self._boxes.values():
            box.epoch = epoch

    def restart(self, epoch: int) -> None:
        """Makes the service afresh because time has started over; what was asked in the old epoch is refused."""
        self.service.close()
        self.epoch = epoch
        kept = [(name, sample) for name, box in self._boxes.items() for sample in box.surviving(epoch)]
        self._refuse_all("time has started over: ask again")
        self._make()
        for name, sample in kept:
            self._boxes[name].push(sample)

    def _refuse_all(self, reason: str) -> None:
        for waiting in self._queries.values():
            while waiting:
                waiting.popleft().refuse(reason)
        self._param_server.refuse_all(reason)
        for query, _, _ in self._open:
            query.refuse(reason)
        self._open.clear()
        for answers in self._answers.values():
            answers.clear()

    def recall(self, find: Callable[[str], bytes | None]) -> None:
        """Hands the service what an instance before it has left; ``find`` gives the newest bytes of a key."""
        found = {name: (topic, find(topic.at(self.owner))) for name, topic in self.type.recalls.items()}
        messages: dict[str, Message] = {}
        for name, (topic, payload) in found.items():
            try:
                messages |= {name: decode(name, payload, topic.message)} if payload is not None else {}
            except Malformed as error:
                self._warn(f"{self.type.name}: {error}")
        if messages:
            self.service.recall(**messages)

    def _make(self) -> None:
        self.service = self.host.make()
        ageless = self.type.clock == "wall"
        self._boxes = {name: InputBox(declared, ageless, self.epoch) for name, declared in self.type.declared_inputs().items()}
        self._valued = [name for name in self._boxes if name in self.type.inputs]
        self._frames = {name: FrameBuffer() for name, declared in self.type.inputs.items() if isinstance(declared, Frames)}
        self._param_server = ParamServer(self.service)
        self.n = 1

    def reads(self) -> Iterator[tuple[str, Input, str]]:
        """Each declared input with the owner whose messages it takes; ``*`` = of every vehicle."""
        for name, declared in self.type.declared_inputs().items():
            yield name, declared, "*" if declared.each_vehicle else (self.host.roles or {}).get(declared.role or "", self.owner)

    def _subscribe(self) -> None:
        for name, declared, owner in self.reads():
            wide = declared.every or declared.each_vehicle or declared.topic.qos in (Qos.LATCHED, Qos.EVENT)
            depth = EVERY_DEPTH if wide else LATEST_DEPTH
            self._bus.subscribe(declared.topic.at(owner), declared.topic.qos, lambda s, n=name: self._boxes[n].push(s), depth)  # type: ignore[misc]
        everyone = "*" if self.type.scope == "world" else self.owner
        for name, request in self.type.requests.items():
            self._bus.serve(request.at(everyone), lambda query, n=name: self._queue(n, query))  # type: ignore[misc]
        self._bus.serve(self._param_server.key(self.owner), self._queue_param)

    def _queue(self, name: str, query: Query) -> None:
        if len(self._queries[name]) >= QUERIES_MOST:
            query.refuse(f"{self.type.name}: {QUERIES_MOST} requests wait already")
        else:
            self._queries[name].append(query)

    def _queue_param(self, query: Query) -> None:
        if self._param_server.waiting >= QUERIES_MOST:
            query.refuse(f"{self.type.name}: {QUERIES_MOST} requests wait already")
        else:
            self._param_server.queue(query)

    @property
    def n(self) -> int:
        """The number of the next step, from 1."""
        return self._n

    @n.setter
    def n(self, n: int) -> None:
        self._n = n
        self.due_ns = step_time(n, self.type.hz)
        """When it is due [ns]; asked far more often than it changes."""

    def skip_to(self, t_ns: int, count: bool = True) -> None:
        """Leaves out the steps due before the newest one that is due at ``t_ns``, and counts them as skipped."""
        newest = first_step_after(t_ns, self.type.hz) - 1
        if newest > self.n:
            self.counters.skipped += (newest - self.n) * count
            self.n = newest

    def advance(self) -> None:
        """One step at the due time: fresh inputs in, outputs published, requests answered."""
        t_ns = self.due_ns
        self.n += 1
        for query, reply in self._param_server.answer(lambda stamp: self._is_due(stamp, t_ns)):
            self._answer(query, PARAM, reply, t_ns)
        for box in self._boxes.values():
            box.take(t_ns)
            for line in box.malformed():
                self.counters.malformed += 1
                self._tell_once(line)
        self._feed_frames(t_ns)
        missing = tuple(name for name, box in self._boxes.items() if box.is_missing(t_ns))
        self.counters.missing = missing
        if missing:
            self.counters.stale += 1
            self._publish(self.service.stale(t_ns / NS, missing), t_ns)
            self._refuse_requests(missing, t_ns)
            return
        self.counters.steps += 1
        queries, requests = self._take_requests(t_ns)
        values = {name: self._boxes[name].value(t_ns) for name in self._valued}
        outputs = self.service.step(t_ns / NS, **values, **self._frames, **requests, **self._take_answers(t_ns))
        self._publish(outputs, t_ns)
        for name in self.type.requests:
            self._reply(name, queries.get(name, []), outputs.get(name, ()), t_ns)
        self._end_open(t_ns)

    def _is_due(self, stamp_ns: int, t_ns: int) -> bool:
        """Whether a request counts at ``t_ns``: one from a clock of its own would else wait for ever, it is taken as it comes."""
        return self._is_readable(stamp_ns, t_ns) or stamp_ns > t_ns + AHEAD_MOST

    def _tell_once(self, line: str) -> None:
        """A broken sender is told of, but not at each of its messages: these are counted."""
        if line not in self._told and len(self._told) < TOLD_MOST:
            self._told.add(line)
            self._warn(f"{self.type.name}: {line}")

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

    def _take_answers(self, t_ns: int) -> dict[str, list[Answer[Any, Any]]]:
        taken: dict[str, list[Answer[Any, Any]]] = {}
        for name, waiting in self._answers.items():
            if not waiting:
                taken[name] = []
                continue
            taken[name] = [answer for stamp, answer in waiting if self._is_readable(stamp, t_ns)]
            self._answers[name] = deque(x for x in waiting if not self._is_readable(x[0], t_ns))
        return taken

    def _take_requests(self, t_ns: int) -> tuple[dict[str, list[Query]], dict[str, Any]]:
        """The queries that may be read at ``t_ns`` and, decoded, what ``step`` sees of them."""
        queries: dict[str, list[Query]] = {}
        requests: dict[str, Any] = {}
        for name, request in self.type.requests.items():
            by_owner = self.type.scope == "world" and request.per_vehicle
            if not self._queries[name]:
                requests[name] = {} if by_owner else []
                continue
            queries[name] = self._decodable(name, request, t_ns)
            decoded = [(q.key.split("/")[1], request.message.FromString(q.payload)) for q in queries[name]]
            if by_owner:
                by_vehicle: dict[str, list[Message]] = {}
                for owner, message in decoded:
                    by_vehicle.setdefault(owner, []).append(message)
                queries[name].sort(key=lambda q: q.key.split("/")[1])
                requests[name] = dict(sorted(by_vehicle.items()))
            else:
                requests[name] = [message for _, message in decoded]
        return queries, requests

    def _decodable(self, name: str, request: Request[Any, Any], t_ns: int) -> list[Query]:
        waiting, good = list(self._queries[name]), []
        self._queries[name] = deque(q for q in waiting if not self._is_due(q.stamp_ns, t_ns))
        for query in waiting:
            if not self._is_due(query.stamp_ns, t_ns):
                continue
            try:
                decode(query.key, query.payload, request.message)
                good.append(query)
            except Malformed as error:
                self.counters.malformed += 1
                self._tell_once(str(error))
                reply = request.reply(accepted=False, reason=str(error))
                query.answer(reply.SerializeToString(deterministic=True), query.stamp_ns)
        return good

    def _reply(self, name: str, queries: list[Query], replies: Any, t_ns: int) -> None:
        if not queries and not replies:
            return
        flat = [r for owner in sorted(replies) for r in replies[owner]] if isinstance(replies, Mapping) else list(replies)
        if len(flat) != len(queries):
            raise ContractError(f"{self.type.name}: {len(queries)} requests '{name}' but {len(flat)} replies")
        for query, reply in zip(queries, flat, strict=True):
            if isinstance(reply, Later):
                self._open.append((query, self.type.requests[name], reply))
            else:
                self._answer(query, self.type.requests[name], reply, t_ns)

    def _end_open(self, t_ns: int) -> None:
        """Answers what has waited for this step."""
        still = []
        for query, request, later in self._open:
            if later.reply is None:
                still.append((query, request, later))
            else:
                self._answer(query, request, later.reply, t_ns)
        self._open = still

    def _answer(self, query: Query, request: Request[Any, Any], reply: Message, t_ns: int) -> None:
        """Sends the reply, and both halves as messages of their own, so that logs hold them."""
        payload = reply.SerializeToString(deterministic=True)
        query.answer(payload, t_ns)
        self._put(f"{query.key}/request", request.message, Qos.EVENT, query.payload, t_ns)
        self._put(f"{query.key}/reply", request.reply, Qos.EVENT, payload, t_ns)

    def _refuse_requests(self, missing: tuple[str, ...], t_ns: int) -> None:
        for name, request in self.type.requests.items():
            for query in self._decodable(name, request, t_ns):
                reply = request.reply(accepted=False, reason=f"{self.type.name} waits for {', '.join(missing)}")
                self._answer(query, self.type.requests[name], reply, t_ns)

    def _publish(self, outputs: Outputs, t_ns: int) -> None:
        now = t_ns if self.type.clock == "sim" else self.sim_ns
        stamp = now + round(self.type.latency * NS)
        for name, value in outputs.items():
            if name in self.type.requests:
                continue
            topic = self.type.outputs.get(name) or self.type.calls.get(name)
            if topic is None:
                raise ContractError(f"{self.type.name}: step returned '{name}', which is not declared")
            by_owner = value if isinstance(value, dict) else {self.owner: value}
            for owner, messages in by_owner.items():
                for message in messages if isinstance(messages, (list, tuple)) else (messages,):
                    self._send(name, topic, owner, message, stamp)

    def _send(self, name: str, topic: Topic[Any] | Request[Any, Any], owner: str, message: Message, stamp: int) -> None:
        if not isinstance(message, topic.message):
            raise ContractError(f"{self.type.name}: '{name}' is {type(message).__name__}, declared {topic.message.__name__}")
        key = topic.at(owner)
        payload = message.SerializeToString(deterministic=True)
        if isinstance(topic, Request):
            self._call(name, topic, owner, message, payload, stamp)
            return
        self._put(key, topic.message, topic.qos, payload, stamp)

    def _put(self, key: str, message: type[Message], qos: Qos, payload: bytes, stamp: int) -> None:
        if key not in self._publishers:
            self._publishers[key] = self._bus.publisher(key, message.DESCRIPTOR.full_name, qos)
        self.counters.published[key] = self._publishers[key].put(payload, stamp)

    def _call(self, name: str, request: Request[Any, Any], owner: str, message: Message, payload: bytes, stamp: int) -> None:
        asked_in = self.epoch

        def on_reply(reply: bytes | None, reason: str, at_ns: int) -> None:
            if asked_in != self.epoch:
                return
            try:
                decoded = decode(request.at(owner), reply, request.reply) if reply is not None else None
            except Malformed as error:
                decoded, reason = None, str(error)
            self._answers[name].append((at_ns, Answer(owner, message, decoded, reason)))

        self._bus.call(request.at(owner), payload, stamp, on_reply)
