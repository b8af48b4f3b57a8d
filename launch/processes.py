"""The bodies of the processes of a run: router, conductor, and one for any service."""

import time
from collections.abc import Callable
from contextlib import closing
from typing import Any

from launch import catalogue, settings
from launch.running_mission import announce
from launch.worker import Worker, freeze_gc, lower_priority, worker
from schemas import topics
from schemas.messages import Clock, ClockRequest, Done, Event, Reply
from uvf.models.scenario import load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.interface import Query, Sample, Sink
from uvf.runtime.bus.wire import Malformed, decode, guarded
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router
from uvf.runtime.log.state_store import StateStore
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.messages.refusals import Refusals
from uvf.runtime.process.watchdog import Watchdog
from uvf.runtime.time.conductor import Conductor
from uvf.runtime.time.live import Live

HELD_PERIOD = 0.5  # s, how often the clock is told again while it is held back or paused
LOOK = 0.05  # s
CONNECT_PATIENCE = 2.0  # s, one attempt
PATIENCE = 3.0  # s, after which a clock that is held back says by whom


def run_router(listen: str) -> None:
    """Runs the router and the state store beside it until told to stop."""
    with worker("router") as life:
        session = open_router(listen)
        try:
            with ZenohBus(listen.replace("0.0.0.0", "127.0.0.1"), timeout=CONNECT_PATIENCE) as bus:
                keeper = StateStore(bus, life.warn)
                freeze_gc()
                while not life.stop.wait(LOOK) and life.goes_on():
                    keeper.poll()
        finally:
            session.close()  # type: ignore[no-untyped-call]


def open_bus(life: Worker, blocking: bool = False) -> ZenohBus:
    """Connects to the router; waits for it until told to stop, and reports the wait once."""
    endpoint, said = router_from(), False
    while not life.stop.is_set() and not life.orphaned():
        try:
            return ZenohBus(endpoint, blocking, CONNECT_PATIENCE)
        except BadInput as error:
            if not said:
                life.warn(f"waiting: {error}")
            said = True
    raise SystemExit(0)


def run_service(name: str, mission: str, vehicle: str | None, lockstep: bool = False) -> None:
    """Runs one kind of service for all its vehicles, or for one."""
    with worker(name) as life:
        kind = catalogue.kind(name)
        lower_priority(kind.nice)
        site = load_scenario(settings.mission_path(mission))
        hosts = catalogue.hosts(site, [kind], vehicle)
        with open_bus(life, lockstep) as bus, closing(Watchdog()) as watchdog:
            live = Live(name if vehicle is None else f"{name}.{vehicle}", hosts, bus, life.warn, watchdog)
            freeze_gc()
            live.run(life.stop, lambda: not life.goes_on())


def run_conductor(mission: str, rate: float, lockstep: bool = False, without: tuple[str, ...] = ()) -> None:
    """Publishes the clock for a mission's participants at real-time factor ``rate`` [-]; 0 = as fast as possible."""
    with worker("conductor") as life:
        site = load_scenario(settings.mission_path(mission))
        kinds = [k for k in catalogue.needed(site) if k.clock == "sim" and k.name not in without]
        simulators = [k.name for k in kinds if k.simulator]
        conductor = Conductor(simulators, [k.name for k in kinds if not k.simulator], rate, lockstep, site.members)
        with open_bus(life, lockstep) as bus:
            loop = ConductorLoop(conductor, bus, life)
            announce(bus, mission)
            freeze_gc()
            loop.run()


class ConductorLoop:
    """Runs the conductor's state machine on the bus and on wall time."""

    def __init__(self, conductor: Conductor, bus: ZenohBus, life: Worker) -> None:
        self._conductor = conductor
        self._bus = bus
        self._life = life
        self._refusals = Refusals(life.warn)
        self._clock = bus.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
        events = topics.SYSTEM_EVENTS.by("conductor")
        self._events = bus.publisher(events.at("sys"), Event.DESCRIPTOR.full_name, events.qos)
        self._told = 0.0
        self._held_since = time.monotonic()
        self._complained = ""
        bus.subscribe(topics.DONE.by("*").at("sys"), topics.DONE.qos, self._guard(topics.DONE, self._on_done), depth=256, wake=True)
        bus.serve(topics.CLOCK_REQUEST.at("sys"), self._on_request)
        bus.token(f"@node/sys/conductor/{bus.boot:x}")
        left = bus.recall(topics.CLOCK.at("sys"))
        if left is not None:
            conductor.take_up(decode("clock", left, Clock))

    def _guard(self, topic: topics.Topic[Any], heard: Callable[[Any, Sample], None]) -> Sink:
        return guarded(topic, heard, self._refusals.refuse)

    def _on_done(self, message: Done, sample: Sample) -> None:
        if sample.key.rpartition("/")[2] != message.participant:
            self._refusals.refuse(f"{sample.key}: speaks for another process")
            return
        line = self._conductor.done(message, sample.boot)
        if line:
            self._say(line, Event.WARNING)

    def _on_request(self, query: Query) -> None:
        try:
            reply = self._conductor.request(decode(query.key, query.payload, ClockRequest))
        except Malformed as error:
            reply = Reply(accepted=False, reason=str(error))
        query.answer(reply.SerializeToString(deterministic=True), self._conductor.t_ns)

    def _say(self, line: str, severity: Event.Severity) -> None:
        self._life.warn(line)
        event = Event(timestamp=stamp_ns(self._conductor.t_ns), severity=severity, text=line, source="conductor")
        self._events.put(event.SerializeToString(deterministic=True), self._conductor.t_ns)

    def run(self) -> None:
        """Advances the clock until told to stop or orphaned."""
        while not self._life.stop.is_set() and self._life.goes_on():
            self._bus.wait(self._conductor.patience)
            self._bus.poll()
            wall = time.monotonic()
            tick = self._conductor.advance(wall)
            while tick is not None:
                self._tell(tick, wall)
                tick = self._conductor.advance(wall)
            if wall - self._told > HELD_PERIOD:
                self._tell_held(wall)

    def _tell(self, clock: Clock, wall: float) -> None:
        self._told = self._held_since = wall
        self._complained = ""
        self._bus.epoch = clock.epoch
        self._clock.put(clock.SerializeToString(deterministic=True), clock.t_ns)

    def _tell_held(self, wall: float) -> None:
        """While nothing moves: the clock as it stands, and once a line about whom it waits for."""
        self._told = wall
        waited = self._conductor.waiting_for()
        if self._conductor.started:
            clock = self._conductor.clock(wall, waited)
            self._clock.put(clock.SerializeToString(deterministic=True), clock.t_ns)
        if waited and waited != self._complained and wall - self._held_since > PATIENCE:
            self._complained = waited
            names = ", ".join(self._conductor.missing()) or waited
            if self._conductor.t_ns == 0:
                self._say(f"starting: waiting for {names} (the first start compiles, about a minute)", Event.INFO)
            else:
                self._say(f"simulation clock held at {self._conductor.t_ns / 1e9:.2f} s: waiting for {names}", Event.WARNING)
