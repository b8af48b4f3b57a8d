"""Processes on one LocalBus, turned by hand as ``Live`` turns its own: with a conductor, deaths and restarts, and no waiting."""

from schemas import topics
from schemas.messages import Clock, Done
from tests.runtime.outcome import Outcome, ask
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.bus.zenoh_bus import kept_key
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.log.state_store import StateStore
from uvf.runtime.time.conductor import Conductor
from uvf.runtime.time.live import LATE_START

TICK = 0.01  # s
BUSY = (4, 5, 6)  # of ten ticks: live, everybody but the simulators hears of these late


class Process:
    def __init__(self, name, hosts, run):
        self.name = name
        self.shells = [ServiceRunner(host, run.bus) for host in hosts]
        self.epoch = 0
        self.boot = run.boots
        self.given_up = 0


class InProcess:
    """The same methods as ``modes.Distributed``. Wall time is counted: live, steps are skipped as on a busy machine."""

    def __init__(self, lockstep, cast):
        self.lockstep = lockstep
        self.toys = cast
        self.samples = []
        self.warnings = []
        self.bus = LocalBus()
        self.boots = 0
        self._hosts = cast.processes()
        others = [name for name in self._hosts if name not in cast.simulators]
        self.conductor = Conductor(cast.simulators, others, 1.0, lockstep)
        self._keeper = StateStore(self.bus, print)
        self._clock = self.bus.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
        self._processes = {}
        self._wall = 0.0

    def __enter__(self):
        self.bus.subscribe("uvf/**", topics.Qos.SENSOR, self.samples.append)
        for name in self._hosts:
            self.start(name)
        return self

    def start(self, name):
        self.boots += 1
        self._processes[name] = Process(name, self._hosts[name], self)
        self._report(self._processes[name], Clock())

    def end(self, name):
        """The process is gone; what it has said is not."""
        del self._processes[name]

    def turn(self):
        """Nothing is ever on its way."""

    def run(self, until):
        """Lets time run to ``until`` [s, simulation]."""
        while self.conductor.t_ns < until * 1e9 or self.conductor.waiting_for():
            self._wall += TICK
            clock = self.conductor.advance(self._wall) if self.conductor.t_ns < until * 1e9 else None
            clock = clock or self.conductor.clock(self._wall)
            self._clock.put(clock.SerializeToString(deterministic=True), clock.t_ns)
            last = clock.t_ns >= until * 1e9
            for process in self._processes.values():
                if self.lockstep or last or process.name in self.toys.simulators or clock.tick % 10 not in BUSY:
                    self._follow(process, clock)

    def run_on(self, seconds):
        self.run(self.conductor.t_ns / 1e9 + seconds)

    def _follow(self, process, clock):
        is_simulator = process.name in self.toys.simulators
        if is_simulator and process.epoch == 0 and clock.tick > LATE_START:
            process.given_up = clock.epoch
        if clock.epoch == process.given_up:
            self._report(process, Clock())
            return
        if clock.epoch != process.epoch:
            self._begin_epoch(process, clock)
        while (shell := min(process.shells, key=lambda s: s.due_ns)).due_ns <= clock.t_ns:
            if not (self.lockstep or is_simulator):
                shell.skip_to(clock.t_ns)
            shell.advance()
        self._report(process, clock)

    def _begin_epoch(self, process, clock):
        first, process.epoch = process.epoch == 0, clock.epoch
        for shell in process.shells:
            if first:
                shell.join(clock.epoch)
            else:
                shell.restart(clock.epoch)
            if first and clock.tick > LATE_START:
                shell.recall(self._kept)
            shell.skip_to(clock.t_ns, count=False)

    def _kept(self, key):
        got = []
        self.bus.call(kept_key(key), b"", 0, lambda reply, *_: got.append(reply))
        return got[0]

    def _report(self, process, clock):
        done = Done(participant=process.name, tick=clock.tick, t_ns=clock.t_ns, epoch=clock.epoch)
        self.conductor.done(done, process.boot)

    def ask(self, request, owner, message, stamp):
        return ask(self.bus, request, owner, message, stamp)

    def outcome(self):
        return Outcome(self.toys, self.samples)

    def __exit__(self, *_):
        for process in self._processes.values():
            for shell in process.shells:
                shell.service.close()
