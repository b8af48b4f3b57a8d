"""Runs the services of one process on the clock of the bus: in real time, scaled, paused or in lockstep."""

import time
from collections.abc import Callable, Sequence
from threading import Event

from schemas import topics
from schemas.messages import Clock, Done
from uvf.runtime.bus.wire import guarded
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner, Warn
from uvf.runtime.messages.refusals import Refusals
from uvf.runtime.messages.step_times import NS
from uvf.runtime.process.watchdog import Watchdog
from uvf.runtime.time.health import HealthReport

IDLE = 0.05  # s, the longest wait: how fast a process sees that it shall stop
READY_PERIOD = 0.2  # s, how often a process says where it stands while no clock is heard
LATE_START = 10  # ticks: who first sees a later one has been started again
LOCKSTEP_LOOK = 0.0002  # s, between two looks for messages that are announced but not here yet
LOCKSTEP_PATIENCE = 5.0  # s, after which the message that is waited for is named


class Live:
    """One process: its services, its place in the clock's barrier, its sign of life."""

    def __init__(self, name: str, hosts: Sequence[ServiceInstance], bus: ZenohBus, warn: Warn, watchdog: Watchdog | None = None) -> None:
        self._name = name
        self._bus = bus
        self._warn = warn
        self._shells = shells = [ServiceRunner(host, bus, warn, True, watchdog) for host in hosts]
        self._sim = [s for s in shells if s.type.clock == "sim"]
        self._wall = [s for s in shells if s.type.clock == "wall"]
        self._takes_part = bool(self._sim) or not self._wall
        """In the barrier: also a process that has nothing to do in this mission, or time would wait for it for ever."""
        self._simulator = any(s.type.simulator for s in self._sim)
        self._ticks: list[Clock] = []
        self._epoch = 0
        self._given_up = 0
        """The epoch that another instance of this simulator has begun; 0 = none."""
        self._tick = 0
        self._told_rivals: set[str] = set()
        self._done = bus.publisher(topics.DONE.by(name).at("sys"), Done.DESCRIPTOR.full_name, topics.DONE.qos)
        refusals = Refusals(lambda line: warn(f"{name}: {line}"))
        self._health = HealthReport(name, shells, bus, refusals)
        self._last_heard = 0.0
        self._t_ns = 0
        on_clock = guarded(topics.CLOCK, lambda clock, _: self._ticks.append(clock), refusals.refuse)
        bus.subscribe(topics.CLOCK.at("sys"), topics.CLOCK.qos, on_clock, depth=64, wake=self._takes_part)
        for shell in shells:
            _declare_tokens(shell, bus)

    def join(self, host: ServiceInstance) -> None:
        """Adds an instance on wall time, from now on."""
        shell = ServiceRunner(host, self._bus, self._warn, contains=True)
        shell.join(self._epoch)
        shell.sim_ns = self._t_ns
        self._wall.append(shell)
        self._shells.append(shell)
        _declare_tokens(shell, self._bus)

    def run(self, stop: Event, until: Callable[[], bool] = lambda: False) -> None:
        """Runs until ``stop`` is set or ``until()`` is true; closes the services in every case."""
        start = time.monotonic()
        try:
            while not stop.is_set() and not until():
                self._bus.wait(self._patience(time.monotonic() - start))
                self._bus.poll()
                wall = time.monotonic() - start
                self._follow_clock(wall, stop)
                self._run_wall(wall)
                self._health.publish_when_due(wall, self._t_ns)
                self._tell_rivals()
        finally:
            for shell in (*self._sim, *self._wall):
                shell.service.close()

    def _tell_rivals(self) -> None:
        for key in self._bus.counter.rivals - self._told_rivals:
            self._told_rivals.add(key)
            self._warn(f"{self._name}: two processes write {key}: end one of them")

    def _patience(self, wall: float) -> float:
        due = min((s.due_ns / NS - wall for s in self._wall), default=IDLE)
        return min(max(due, 0.0), IDLE)

    def _follow_clock(self, wall: float, stop: Event) -> None:
        ticks, self._ticks = [clock for clock in self._ticks if not self._came_too_late(clock)], []
        if ticks:
            self._last_heard = wall
        elif self._takes_part and wall - self._last_heard > READY_PERIOD:
            self._last_heard = wall
            self._report({})
        for clock in ticks:
            if clock.epoch != self._epoch:
                self._begin_epoch(clock)
            if clock.lockstep:
                self._await_announced(clock, stop)
        if ticks and not stop.is_set():
            self._advance_to(ticks[-1])

    def _came_too_late(self, clock: Clock) -> bool:
        """A simulator that is started again cannot go on where the one before has been: it waits for a new epoch."""
        if self._simulator and self._epoch == 0 and clock.tick > LATE_START:
            self._given_up = clock.epoch
        return clock.epoch == self._given_up

    def _begin_epoch(self, clock: Clock) -> None:
        """The first clock seen places the steps; a later change of epoch starts every service afresh."""
        first = self._epoch == 0
        self._epoch = self._bus.epoch = clock.epoch
        for shell in self._wall:
            shell.join(clock.epoch)
        for shell in self._sim:
            if not first:
                shell.restart(clock.epoch)
            else:
                shell.join(clock.epoch)
            if first and clock.tick > LATE_START:
                shell.recall(self._bus.recall)
            shell.skip_to(clock.t_ns, count=False)

    def _await_announced(self, clock: Clock, stop: Event) -> None:
        """Lockstep: everything published in the ticks before has arrived before anybody steps on."""
        begun = time.monotonic()
        while (key := self._bus.behind(clock.published)) and not stop.is_set():
            time.sleep(LOCKSTEP_LOOK)
            self._bus.poll()
            if time.monotonic() - begun > LOCKSTEP_PATIENCE:
                self._warn(f"{self._name}: still waits for message {clock.published[key]} on {key}")
                begun = time.monotonic()

    def _advance_to(self, clock: Clock) -> None:
        published: dict[str, int] = {}
        while True:
            shell = min(self._sim, key=lambda s: s.due_ns, default=None)
            if shell is None or shell.due_ns > clock.t_ns:
                break
            self._health.begun(shell, self._lateness(clock, shell))
            if not (clock.lockstep or shell.type.simulator):
                shell.skip_to(clock.t_ns)
            shell.advance()
            published.update(shell.counters.published)
            self._bus.poll()
        for shell in self._wall:
            shell.sim_ns = clock.t_ns
        self._tick, self._t_ns = clock.tick, clock.t_ns
        if self._takes_part and (self._simulator or clock.lockstep):
            self._report(published)

    def _lateness(self, clock: Clock, shell: ServiceRunner) -> float:
        """How long ago [s, wall] the step about to begin was due; the conductor's clock is this host's too."""
        if clock.lockstep or clock.due_wall == 0 or clock.rate_wanted == 0:
            return 0.0
        return time.monotonic() - clock.due_wall + (clock.t_ns - shell.due_ns) / NS / clock.rate_wanted

    def _report(self, published: dict[str, int]) -> None:
        done = Done(participant=self._name, tick=self._tick, t_ns=self._t_ns, epoch=self._epoch, published=published)
        self._done.put(done.SerializeToString(deterministic=True), self._t_ns)

    def _run_wall(self, wall: float) -> None:
        for shell in self._wall:
            if shell.due_ns <= wall * NS:
                self._health.begun(shell, wall - shell.due_ns / NS)
                shell.skip_to(round(wall * NS))
                shell.advance()


def _declare_tokens(shell: ServiceRunner, bus: ZenohBus) -> None:
    """The instance and each of its endpoints, for the graph of the running system: pub, sub, or need for what holds its step back."""
    bus.token(f"@node/{shell.owner}/{shell.type.name}/{bus.boot:x}")
    everyone = "*" if shell.type.scope == "world" else shell.owner
    ends = [("pub", topic, everyone) for topic in shell.type.outputs.values()]
    ends += [("need" if declared.required else "sub", declared.topic, owner) for _, declared, owner in shell.reads()]
    for way, topic, owner in ends:
        key = topic.at(owner).replace("/", "%").replace("*", "+")
        bus.token(f"@ep/{shell.owner}/{shell.type.name}/{way}/{key}/{topic.message.DESCRIPTOR.full_name}")
